#include "diagnosis/evidence/another_robot.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "diagnosis/checks/foreign_robot.hpp"
#include "diagnosis/checks/pose_geometry.hpp"
#include "diagnosis/evidence/delay_search.hpp"

namespace joulepath {
namespace {

/// Whether the checks found a fault of the drive's channels that is an excuse for other constants. A dead
/// channel is none: its readings determined the constants.
bool has_excuse(const std::vector<DataCheck>& checks) {
  return std::ranges::any_of(checks, [](const DataCheck& check) {
    return check.kind != "dead" && !check.channel.starts_with("battery_");
  });
}

/// Whether the checks found a fault of what tells the geometry.
bool has_faulty_motion(const std::vector<DataCheck>& checks) {
  return std::ranges::any_of(checks, [](const DataCheck& check) {
    return std::ranges::any_of(std::to_array({"wheel_speed_", "position_", "heading_", "time_s"}),
                               [&](const char* of) { return check.channel.find(of) != std::string::npos; });
  });
}

/// By what the motors draw.
std::vector<ForeignConstant> constants_by_motors(const Robot& robot, const RunsByUse& runs,
                                                 const std::vector<DataCheck>& checks) {
  std::set<std::size_t> faulty;
  for (const DataCheck& check : checks)
    if (!check.run.empty()) faulty.insert(check.runs.begin(), check.runs.end());
  std::vector<RunSignals> sound;
  std::ranges::copy_if(runs.signals, std::back_inserter(sound),
                       [&](const RunSignals& run) { return !faulty.contains(run.run_index); });
  const bool excused = has_excuse(checks);
  if (!faulty.empty() && !sound.empty() && foreign_constants(robot, sound, excused).empty()) return {};
  const std::vector<ForeignConstant> constants = foreign_constants(robot, runs.signals, excused);
  const double delay_s = constants.empty() ? 0.0 : rough_channel_delay_s(runs.diagnosis);
  return delay_s == 0 ? constants : foreign_constants(robot, read_signals(runs.diagnosis, delay_s), excused);
}

}  // namespace

AnotherRobot another_robot(const Dataset& dataset, const RunsByUse& runs,
                           const std::vector<DataCheck>& checks) {
  const PoseGeometry geometry =
      has_faulty_motion(checks) ? PoseGeometry{} : geometry_by_pose(dataset, runs.signals);
  AnotherRobot another{foreign_geometry(dataset.robot, geometry), geometry_notes(dataset.robot, geometry)};
  std::ranges::move(constants_by_motors(with_geometry(dataset.robot, geometry), runs, checks),
                    std::back_inserter(another.constants));
  return another;
}

}  // namespace joulepath
