#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/config_error.hpp"
#include "model/prescribed_motion.hpp"
#include "model/robot.hpp"
#include "planner/path/floor/occupancy_grid.hpp"
#include "planner/path/geometry/path.hpp"
#include "planner/path/search/route_graph.hpp"

namespace joulepath {

/// The place of an item in its file, and of each of its keys, for later error messages.
struct ItemMarks {
  std::string path{};  ///< dotted: `legs[2]`
  SourceMark item{};
  std::map<std::string, SourceMark> keys{};

  [[nodiscard]] const SourceMark& at(const std::string& key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? item : found->second;
  }
  [[nodiscard]] std::string key_path(const std::string& key) const {
    return path.empty() ? key : path + "." + key;
  }
};

/// A named place; without a heading, any heading is accepted.
struct Station {
  double x_m{};
  double y_m{};
  std::optional<double> heading_rad{};
  double charger_W{};  ///< 0 = no charger here
  ItemMarks marks{};
};

/// Payload during a leg, linear in arc length (equal ends: constant).
struct PayloadAlongLeg {
  double from_kg{};
  double to_kg{};
};

/// A named part of a path, in its arc length.
struct PathPart {
  std::string name{};
  double from_m{};
  double to_m{};
};

/// A path given in the mission: a chain of cubic Bezier curves, or a path that is ready to be driven.
struct PathRequest {
  enum class Frame { start, map };  ///< start: in the robot's frame where the leg begins
  std::vector<BezierPoints> bezier_m{};
  Frame frame{Frame::start};
  std::optional<Path> ready{};
};

/// One leg: exactly one of `to`, `path`, `motion` (with a path, `to` is the name of its end).
/// How a search may drive a leg; `any`: also backward, where the robot states a speed for it.
enum class LegDirection { any, forward, reverse };

struct LegRequest {
  std::string to{};
  std::optional<PathRequest> path{};
  std::optional<PrescribedMotion> motion{};
  PayloadAlongLeg payload{};
  double dwell_s{};                    ///< after arrival
  std::optional<double> deadline_s{};  ///< arrival, counted from the mission's start
  std::optional<double> earliest_s{};  ///< arrival; the robot waits at the stop (time windows of `visit`)
  std::optional<double> duration_s{};  ///< of this leg alone, without dwell
  LegDirection direction{};
  double start_speed_m_s{};
  double end_speed_m_s{};
  std::optional<double> yaw_rate_rad_s{};  ///< cap on this leg, beside the robot's own
  std::vector<PathPart> parts{};           ///< of a path: edges of an order
  bool charges{};                          ///< inserted by the planner: its dwell is at a charger
  ItemMarks marks{};
};

/// One entry of `visit:` (the planner chooses the order).
struct VisitRequest {
  enum class Kind { pick, drop, pass };  ///< pass (`go:`): no change of payload
  Kind kind{Kind::pick};
  std::string station{};
  double payload_kg{};  ///< picked up here; a drop unloads all, or this much when given
  bool payload_given{};
  std::optional<std::pair<double, double>> window_s{};  ///< earliest and latest arrival
  double dwell_s{};
  ItemMarks marks{};
};

/// The confidences that a mission may ask for: a sample of draws shows at most the greatest one.
inline constexpr double kLeastConfidence = 0.51, kGreatestConfidence = 0.9999;

struct Objective {
  enum class Minimize { energy, time, energy_and_time };
  Minimize minimize{Minimize::energy};
  std::optional<double> deadline_s{};
  double time_value_W{};  ///< energy_and_time: the price of a second, in watts
  std::optional<double>
      confidence{};  ///< probability with which all promises are kept together; none: not asked
  ItemMarks marks{};
};

/// Speed cap on an interval of arc length within one leg.
struct SpeedZone {
  std::size_t leg{};
  double from_m{};
  double to_m{};
  double speed_m_s{};
  ItemMarks marks{};
};

/// Where the planner may insert a stop at a charger if the battery would otherwise fall below its reserve.
struct ChargingRequest {
  std::vector<std::string> stations{};  ///< each with a charger
  double to_fraction{0.8};              ///< state of charge at which the robot leaves
  ItemMarks marks{};
};

struct StartRequest {
  std::string station{};  ///< empty: the pose below
  Pose pose{};            ///< filled from the station if one is named and has a heading
  bool heading_given{true};
  std::optional<double> battery_fraction{};
  ItemMarks marks{};
};

struct SpeedMaskRequest {
  std::string file{};
  SpeedMask::Kind kind{SpeedMask::Kind::percent};
  double base{100.0};
  double multiplier{-1.0};
};

/// The content of a mission file. The names of its files are resolved; the files are not read yet
/// (MissionWorld).
struct MissionRequest {
  std::string file{};
  std::string name{};  ///< file name without extension, or `name:`
  std::string robot_file{};
  std::string map_file{};      ///< empty: none
  bool unknown_is_floor{};     ///< whether unknown cells of the map are floor; else obstacles
  std::string keepout_file{};  ///< empty: none
  std::string route_graph_file{};
  std::optional<SpeedMaskRequest> speed_mask{};
  double clearance_m{};
  std::map<std::string, Station> stations{};
  StartRequest start{};
  std::vector<LegRequest> legs{};
  std::vector<VisitRequest> visit{};
  std::vector<SpeedZone> speed_zones{};
  Objective objective{};
  std::optional<ChargingRequest> charging{};
  std::string order_file{};                           ///< VDA 5050 order instead of legs
  std::map<std::string, double> payload_by_action{};  ///< with an order: kg that an action loads
  std::map<std::string, double> dwell_by_action_s{};  ///< with an order: how long an action takes
  ItemMarks marks{};
};

/// The files that a mission names, read.
struct MissionWorld {
  Robot robot{};
  std::optional<OccupancyGrid> map{};
  std::optional<OccupancyGrid> keepout{};
  std::optional<SpeedMask> speed_mask{};
  std::optional<RouteGraph> route_graph{};
};

}  // namespace joulepath
