#include <filesystem>
#include <map>
#include <set>

#include "extensions/studies/study_file.hpp"
#include "model/number_text.hpp"
#include "model/printable.hpp"

namespace joulepath {
namespace {

/// The values of a parameter that are checked: the ends of a range, every entry of a list.
std::vector<std::string> values_to_check(const SweepParameter& parameter) {
  if (parameter.has_ends()) return {number_text(parameter.from), number_text(parameter.to)};
  return parameter.levels;
}

/// The missions that one entry of `missions` names.
std::vector<MissionItem> items_of_entry(const std::string& source, const NamedBy& named_by) {
  std::error_code absent;
  if (!std::filesystem::exists(source, absent))
    throw named_by.error(source, "which does not exist",
                         "a mission, a folder of missions, or a list of missions as JSON lines",
                         "relative paths are relative to the file that names them");
  return mission_items(source, named_by);
}

}  // namespace

std::vector<MissionItem> study_missions(const Study& study) {
  std::vector<MissionItem> missions;
  std::set<std::pair<std::string, int>> known;  // files and lines
  std::map<std::string, int> missions_of_name;
  for (std::size_t i = 0; i < study.missions.size(); ++i)
    for (MissionItem& item : items_of_entry(study.missions[i], study.missions_named_by[i])) {
      if (!known.emplace(std::filesystem::weakly_canonical(item.file).string(), item.first_line).second)
        throw study.missions_named_by[i].error(item.file, "a mission that the study has already",
                                               "each mission once");
      ++missions_of_name[item.name];
      missions.push_back(std::move(item));
    }
  for (MissionItem& item : missions)
    if (missions_of_name.at(item.name) > 1)
      item.name = printable(item.file) + (item.text.empty() ? "" : ":" + std::to_string(item.first_line));
  return missions;
}

void check_designs(const Study& study, const Document& mission, const ReadOptions& options) {
  const auto check = [&](const std::vector<std::string>& design) {
    const MissionRequest request = mission_of_design(study, mission, design, options);
    const std::string& robot_file = study.robot_file.empty() ? request.robot_file : study.robot_file;
    static_cast<void>(robot_of_design(study, Document::load(robot_file, study.robot_named_by), design));
  };
  check(study.designs.at(0));
  check(study.designs.at(study.designs.size() - 1));
  for (std::size_t p = 0; p < study.targets.size(); ++p)
    for (const std::string& value : values_to_check(study.designs.parameters()[p])) {
      std::vector<std::string> design = study.designs.at(0);
      design[p] = value;
      try {
        check(design);
      } catch (const ConfigError& error) {
        // An error elsewhere is one of this design: its row has the reason.
        if (error.detail().mark.file == study.file) throw;
      }
    }
}

}  // namespace joulepath
