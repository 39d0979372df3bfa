#include "scenarios/robot_files/robot_sources.hpp"

#include <filesystem>

#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/robot_files/motor_sheet_file.hpp"

namespace joulepath {
namespace {

RobotDraft read_sheet(const std::string& file, const std::vector<std::string>&) {
  return read_motor_sheet(Document::load(file));
}

bool is_sheet(const Document& document) { return inferred_kind(document.root()) == "motor_sheet"; }

const std::vector<RobotSource>& all_sources() {
  static const std::vector<RobotSource> sources = [] {
    std::vector<RobotSource> all = registry().robots;
    all.push_back({.says = "a motor data sheet", .recognizes_document = is_sheet, .read = read_sheet});
    return all;
  }();
  return sources;
}

RobotDraft read_draft(const std::string& file, const std::vector<std::string>& wheels) {
  const RobotSource* source = robot_source_of(file);
  if (source == nullptr) {
    refuse_absent_file(file);
    const Document document = Document::load(file);
    source = robot_source_of(document);
    const std::string kind = inferred_kind(document.root());
    if (source == nullptr)
      document.root().fail_found(kind.empty() ? "a file of unknown kind" : "a file of kind " + kind,
                                 robot_source_names());
  }
  return source->read(file, wheels);
}

}  // namespace

const RobotSource* robot_source_of(const std::string& file) {
  for (const RobotSource& source : all_sources())
    if (source.recognizes_file && source.recognizes_file(file)) return &source;
  return nullptr;
}

const RobotSource* robot_source_of(const Document& document) {
  for (const RobotSource& source : all_sources())
    if (source.recognizes_document && source.recognizes_document(document)) return &source;
  return nullptr;
}

std::string robot_source_names() { return text_of_list(all_sources(), &RobotSource::says); }

RobotDraft draft_from(const std::vector<std::string>& files, const std::vector<std::string>& wheels) {
  if (!wheels.empty() && wheels.size() != 2)
    throw ConfigError(
        {{"--wheels", 0, 0}, "", std::to_string(wheels.size()) + " names", "two: LEFT,RIGHT", ""});
  RobotDraft draft;
  for (const std::string& file : files) add_draft(draft, read_draft(file, wheels));
  if (draft.name.empty()) draft.name = std::filesystem::path(files.front()).stem().string();
  return draft;
}

}  // namespace joulepath
