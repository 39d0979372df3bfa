#include "scenarios/mission_files/mission_list.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>

#include "model/printable.hpp"

namespace joulepath {
namespace {

bool is_yaml_name(const std::filesystem::path& file) {
  return file.extension() == ".yaml" || file.extension() == ".yml";
}

std::vector<MissionItem> items_of_directory(const std::filesystem::path& directory) {
  std::vector<MissionItem> items;
  for (const auto& entry : std::filesystem::directory_iterator(directory))
    if (entry.is_regular_file() && is_yaml_name(entry.path()))
      items.push_back({.name = printable(entry.path().stem().string()), .file = entry.path().string()});
  std::sort(items.begin(), items.end(),
            [](const MissionItem& a, const MissionItem& b) { return a.file < b.file; });
  return items;
}

std::vector<MissionItem> items_of_lines(const std::string& file, const NamedBy& named_by) {
  std::vector<MissionItem> items;
  std::istringstream lines(read_text_file(file, named_by));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      items.push_back(
          {.name = "line_" + std::to_string(number), .file = file, .text = line, .first_line = number});
  return items;
}

}  // namespace

Document document_of(const MissionItem& item) {
  return item.text.empty() ? Document::load(item.file)
                           : Document::parse(item.text, item.file, item.first_line);
}

std::vector<MissionItem> mission_items(const std::string& source, const NamedBy& named_by) {
  std::vector<MissionItem> items;
  if (std::filesystem::is_directory(source))
    items = items_of_directory(source);
  else if (is_yaml_name(source))
    items = {{.name = printable(std::filesystem::path(source).stem().string()), .file = source}};
  else
    items = items_of_lines(source, named_by);
  if (items.empty())
    throw named_by.error(source, "no missions", "a directory with *.yaml missions, or a file of JSON lines");
  return items;
}

std::vector<MissionItem> mission_items(const std::vector<std::string>& sources) {
  std::vector<MissionItem> all;
  std::map<std::string, int> uses;
  for (const std::string& source : sources) {
    std::vector<MissionItem> items = mission_items(source);
    for (const MissionItem& item : items) ++uses[item.name];
    std::ranges::move(items, std::back_inserter(all));
  }
  for (MissionItem& item : all) {
    if (uses[item.name] < 2) continue;
    const std::filesystem::path file(item.file);
    item.name =
        printable((file.parent_path() / file.stem()).string()) + (item.text.empty() ? "" : "/" + item.name);
  }
  return all;
}

}  // namespace joulepath
