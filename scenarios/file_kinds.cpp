#include "scenarios/file_kinds.hpp"

#include <algorithm>
#include <iterator>

#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/mission_files/map_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/path_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/result_files/output_schemas.hpp"
#include "scenarios/robot_files/motor_sheet_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {

const std::vector<FileKind>& file_kinds() {
  static const std::vector<FileKind> kinds = [] {
    std::vector<FileKind> all{
        {"robot", robot_schema, "parameters, limits and uncertainty of a differential-drive robot"},
        {"motor_sheet", motor_sheet_schema, "data sheet of a motor, for init --from"},
        {"map", map_schema, "Nav2 occupancy map, keep-out mask or speed mask"},
        {"dataset", dataset_schema, "run logs, their sensors, and the mapping of their columns"},
        {"mission", mission_schema, "stops or legs of a robot, with payloads and deadlines"},
        {"path", path_schema, "a path on its own, for plan, compare, front and export with --robot"},
        {"plan", [] { return result_schema("plan"); }, "result of plan: plan.json"},
        {"diagnosis", [] { return result_schema("diagnosis"); }, "result of diagnose: diagnosis.json"},
        {"after", [] { return result_schema("after"); }, "result of diagnose --after: after.json"},
        {"edges", [] { return result_schema("edges"); }, "result of export --to edges as JSON"},
        {"loss", [] { return result_schema("loss"); }, "energy lost by the settings of an export"},
    };
    std::ranges::copy(registry().kinds, std::back_inserter(all));
    return all;
  }();
  return kinds;
}

}  // namespace joulepath
