#include "scenarios/log_files/dataset_text.hpp"

#include <filesystem>

#include "model/number_text.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/log_files/log_tables.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/quoted.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

/// A value in YAML's flow style.
std::string flow_text(const Value& value) {
  std::string text;
  switch (value.kind) {
    case Value::Kind::null:
      return "null";
    case Value::Kind::scalar: {
      const bool word = value.text == "true" || value.text == "false";
      return !value.quoted && (word || parse_number(value.text)) ? value.text : quoted(value.text);
    }
    case Value::Kind::list:
      return "[" + text_of_list(value.items, flow_text) + "]";
    case Value::Kind::map:
      return "{" +
             text_of_list(
                 value.entries,
                 [](const Value::Entry& entry) { return entry.key + ": " + flow_text(entry.value); }) +
             "}";
  }
  return "";
}

/// Converts file names relative to the dataset's folder to names relative to another folder.
class Relocation {
 public:
  Relocation(const std::string& dataset_file, const std::string& directory)
      : from_(fs::absolute(dataset_file).parent_path()), to_(fs::absolute(directory)) {}

  void move(Value& name) const {
    for (Value& item : name.items) move(item);
    if (name.kind != Value::Kind::scalar || name.text.starts_with("$") || fs::path(name.text).is_absolute())
      return;
    name.text = (from_ / name.text).lexically_normal().lexically_proximate(to_.lexically_normal()).string();
    name.quoted = true;
  }

 private:
  fs::path from_, to_;
};

std::string source_text(const std::string& column, const ColumnSource& source) {
  std::string text;
  const auto add = [&](const std::string& key, const std::string& value) {
    append_item(text, key + ": " + value);
  };
  const std::string names = text_of_list(source.from, quoted);
  if (source.from.size() > 1) add("from", "[" + names + "]");
  if (source.from.size() == 1 && source.from.front() != column) add("from", names);
  if (source.is_absent) add("absent", "true");
  if (source.scale != 1) add("scale", number_text(source.scale));
  if (source.offset != 0) add("offset", number_text(source.offset));
  if (source.is_unsigned) add("unsigned", "true");
  if (source.wraps_at) add("wraps_at", number_text(*source.wraps_at));
  if (source.derivative) add("derivative", "true");
  if (source.delay_s != 0) add("delay_s", number_text(source.delay_s));
  return "{" + text + "}";
}

void relocate_run(Value& run, const Relocation& relocation) {
  for (Value::Entry& entry : run.entries)
    if (entry.key == "file" || entry.key == "files" || entry.key == "predicted") relocation.move(entry.value);
}

/// A run's entry: relocated, with its own columns.
std::string run_text(const Node& run, const Relocation& relocation, const ColumnSources& columns) {
  Value value = run.value();
  relocate_run(value, relocation);
  std::erase_if(value.entries, [](const Value::Entry& entry) { return entry.key == "columns"; });
  std::string text = flow_text(value);
  if (columns.empty()) return text;
  text.pop_back();
  return text + ", columns: " + columns_text(columns) + "}";
}

}  // namespace

Document document_of(const Dataset& dataset) {
  if (!is_log_file(dataset.file)) return Document::load(dataset.file);
  const std::string log = fs::absolute(dataset.file).lexically_normal().string();
  return Document::parse("{\"runs\": [{\"file\": " + quoted(log) + "}]}", dataset.file);
}

std::string columns_text(const ColumnSources& sources) {
  return "{" +
         text_of_list(
             sources,
             [](const auto& entry) { return entry.first + ": " + source_text(entry.first, entry.second); }) +
         "}";
}

std::string dataset_text(const Dataset& dataset, const DatasetEdit& edit, const std::string& directory) {
  const Document document = document_of(dataset);
  std::string text = "schema: joulepath/dataset/1\n" + edit.comment;
  const Relocation relocation(dataset.file, directory);
  const fs::path robot = fs::absolute(dataset.robot_file)
                             .lexically_normal()
                             .lexically_proximate(fs::absolute(directory).lexically_normal());
  text += "robot: " + quoted(robot.string()) + "\n";
  if (!edit.columns.empty()) text += "columns:\n";
  for (const auto& [column, source] : edit.columns)
    text += "  " + column + ": " + source_text(column, source) + "\n";
  text += "runs:\n";
  const std::vector<Node> runs = document.root()["runs"].items();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (edit.left_out.contains(r)) continue;
    const auto columns = edit.run_columns.find(r);
    text +=
        "  - " +
        run_text(runs[r], relocation, columns == edit.run_columns.end() ? ColumnSources{} : columns->second) +
        "\n";
  }
  return text;
}

}  // namespace joulepath
