#include "model/number_text.hpp"
#include "scenarios/study_file.hpp"

namespace joulepath {
namespace {

/// The values of a parameter that are checked: the ends of a range, every entry of a list.
std::vector<std::string> values_to_check(const SweepParameter& parameter) {
  if (parameter.has_ends()) return {number_text(parameter.from), number_text(parameter.to)};
  return parameter.levels;
}

}  // namespace

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
