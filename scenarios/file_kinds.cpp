#include "scenarios/dataset_file.hpp"
#include "scenarios/fleet_file.hpp"
#include "scenarios/map_file.hpp"
#include "scenarios/mission_file.hpp"
#include "scenarios/output_schemas.hpp"
#include "scenarios/path_file.hpp"
#include "scenarios/robot_file.hpp"
#include "scenarios/study_file.hpp"

namespace joulepath {

const std::vector<FileKind>& file_kinds() {
  static const std::vector<FileKind> kinds{
      {"robot", robot_schema, "parameters, limits and uncertainty of a differential-drive robot"},
      {"map", map_schema, "Nav2 occupancy map, keep-out mask or speed mask"},
      {"dataset", dataset_schema, "run logs, their sensors, and the mapping of their columns"},
      {"mission", mission_schema, "stops or legs of a robot, with payloads and deadlines"},
      {"path", path_schema, "a path on its own, for plan, compare, front and export with --robot"},
      {"fleet", fleet_schema, "robots, chargers and missions of a fleet"},
      {"study", study_schema, "designs of a robot or a mission to compare: joulepath sweep"},
      {"plan", plan_schema, "result of plan: plan.json"},
      {"diagnosis", diagnosis_schema, "result of diagnose: diagnosis.json"},
      {"sweep", sweep_schema, "result of sweep: sweep.json"},
      {"shard", shard_schema, "shard.json: data of one part of a batch or a sweep for merge"},
      {"controller", controller_schema, "result of export --to controller"},
      {"edges", edges_schema, "result of export --to edges as JSON"},
      {"loss", loss_schema, "energy lost by the settings of an export"},
      {"drift", drift_schema, "result of drift --json"},
  };
  return kinds;
}

}  // namespace joulepath
