#include "extensions/studio/answer/asked.hpp"

#include <nlohmann/json.hpp>

#include "extensions/studio/answer/moved_path.hpp"
#include "extensions/studio/answer/path_json.hpp"
#include "planner/legs/prescribed_leg.hpp"
#include "planner/path/shape/bezier_chain.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_check.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath::studio {
namespace {

using nlohmann::json;

/// The pose of the robot after a leg; the start where the leg's path cannot be driven (planning reports the
/// reason).
LegStart after(const LegRequest& leg, const LegStart& start, const Plant& plant) {
  if (leg.motion) {
    const Trajectory motion = *prescribed_leg(leg, plant, start.pose).prescribed;
    return {.pose = end_pose(motion)};
  }
  if (leg.path->ready) return leg.path->ready->pieces.empty() ? start : LegStart{leg.path->ready->end()};
  const BezierFrame frame =
      leg.path->frame == PathRequest::Frame::start ? BezierFrame::start : BezierFrame::map;
  const BezierChainResult chain = bezier_chain(leg.path->bezier_m, start.pose, frame);
  return chain.ok() && !chain.path.pieces.empty() ? LegStart{chain.path.end()} : start;
}

}  // namespace

Asked asked_from(const json& question, const std::string& folder) {
  const std::string name = question.value("name", "mission");
  const Document mission = Document::parse(question.at("mission").dump(), folder + "/" + name + ".json");
  const Document robot = Document::parse(question.at("robot").dump(), folder + "/robot.json");
  Asked asked{mission_from(mission), robot_from(robot)};
  if (!has_footprint(asked.robot) && !asked.mission.map_file.empty())
    throw ConfigError(
        {{}, "footprint", "nothing, although the robot drives on a map", "radius_m or polygon_m", ""});
  return asked;
}

void follow_paths(MissionRequest& mission, const json& paths, const Plant& plant) {
  LegStart here{.pose = mission.start.pose, .heading_free = !mission.start.heading_given};
  for (std::size_t k = 0; k < mission.legs.size(); ++k) {
    LegRequest& leg = mission.legs[k];
    if (!leg.path && !leg.motion) {
      const bool known = paths.is_array() && k < paths.size() && paths[k].is_array();
      const std::optional<Path> way =
          known ? moved_path(path_from(paths[k]), here, mission.stations.at(leg.to)) : std::nullopt;
      if (!way)
        throw ConfigError({{},
                           leg.marks.key_path("to"),
                           "a leg whose way was not searched yet",
                           "a plan by the program",
                           "this page cannot search routes"});
      leg.path = PathRequest{.frame = PathRequest::Frame::map, .ready = *way};
    }
    here = after(leg, here, plant);
  }
}

}  // namespace joulepath::studio
