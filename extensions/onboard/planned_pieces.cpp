#include "extensions/onboard/planned_pieces.hpp"

#include <cmath>
#include <numbers>

#include "extensions/onboard/planned_trajectory.hpp"
#include "planner/legs/stretch.hpp"
#include "scenarios/mission_files/plan_robot.hpp"

namespace joulepath {
namespace {

constexpr double kNoWay_m = 1e-7, kNoTurn_rad = 1e-6;
constexpr double kSlow_m_s = 0.03;  ///< where a leg ends: a stop between two samples
constexpr double kCurvatureError_per_m = 5e-4;
constexpr std::size_t kMostSamples = 400;  ///< of one line of curvature

const std::vector<std::string> kPieceColumns{"time_s",       "linear_speed_m_s", "angular_speed_rad_s",
                                             "position_x_m", "position_y_m",     "heading_rad",
                                             "payload_kg",   "arc_length_m",     "curvature_per_m"};

/// The samples of a plan's trajectory.
class Samples {
 public:
  explicit Samples(const Trajectory& planned) : t_(planned), heading_rad_(planned.heading_rad) {
    for (std::size_t i = 1; i < heading_rad_.size(); ++i)
      heading_rad_[i] = heading_rad_[i - 1] + wrapped_angle_rad(heading_rad_[i] - heading_rad_[i - 1]);
  }
  double time_s(std::size_t i) const { return t_.time_s[i]; }
  double speed(std::size_t i) const { return t_.linear_speed_m_s[i]; }
  double yaw_rate(std::size_t i) const { return t_.angular_speed_rad_s[i]; }
  Pose pose(std::size_t i) const { return {t_.position_x_m[i], t_.position_y_m[i], heading_rad_[i]}; }
  double payload_kg(std::size_t i) const { return t_.payload_kg[i]; }
  double arc_m(std::size_t i) const { return t_.arc_length_m[i]; }
  double curvature(std::size_t i) const { return t_.curvature_per_m[i]; }
  double leg_of(std::size_t i) const { return t_.leg.empty() ? 0.0 : t_.leg[i]; }
  std::size_t size() const { return t_.size(); }

 private:
  const Trajectory& t_;
  std::vector<double> heading_rad_;  ///< without the jumps of a full turn
};

/// What happens between sample i and the next: 0 rest, +-1 a curve, +-2 a turn in place.
int kind_of(const Samples& t, std::size_t i) {
  if (t.arc_m(i + 1) - t.arc_m(i) > kNoWay_m) return t.speed(i) + t.speed(i + 1) >= 0 ? 1 : -1;
  const double turned = t.pose(i + 1).heading_rad - t.pose(i).heading_rad;
  if (std::abs(turned) > kNoTurn_rad) return turned > 0 ? 2 : -2;
  return 0;
}

/// Whether the robot stands at sample i between two motions of one kind.
bool stops_at(const Samples& t, std::size_t i, int kind) {
  const bool new_leg = t.leg_of(i) != t.leg_of(i - 1);
  if (kind == 0) return false;
  if (std::abs(kind) == 2) return new_leg || std::abs(t.yaw_rate(i)) < kNoTurn_rad;
  return std::abs(t.speed(i)) < (new_leg ? kSlow_m_s : 1e-9);
}

/// The end of the longest run of samples from `from` along which curvature is linear in the arc length.
std::size_t linear_until(const Samples& t, std::size_t from, std::size_t last) {
  std::size_t end = from + 1;
  for (std::size_t to = from + 2; to <= last && to - from <= kMostSamples; ++to) {
    const double length = t.arc_m(to) - t.arc_m(from);
    if (!(length > 0)) continue;
    const double slope = (t.curvature(to) - t.curvature(from)) / length;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double line = t.curvature(from) + slope * (t.arc_m(i) - t.arc_m(from));
      if (std::abs(line - t.curvature(i)) > kCurvatureError_per_m) return end;
    }
    end = to;
  }
  return end;
}

PathPiece curve_of(const Samples& t, std::size_t first, std::size_t last, bool reverse) {
  std::vector<CurveSegment> segments;
  Pose pose = t.pose(first);
  if (reverse) pose.heading_rad += std::numbers::pi;
  for (std::size_t from = first; from < last;) {
    const std::size_t to = linear_until(t, from, last);
    const double length = t.arc_m(to) - t.arc_m(from);
    if (length > kNoWay_m) {
      const double slope = (t.curvature(to) - t.curvature(from)) / length;
      segments.emplace_back(LinearCurvature(pose, length, t.curvature(from), slope));
      pose = std::get<LinearCurvature>(segments.back()).at(length).pose;
    }
    from = to;
  }
  return Curve(std::move(segments), reverse ? Direction::reverse : Direction::forward);
}

Profile profile_of(const Samples& t, std::size_t first, std::size_t last, bool turn) {
  std::vector<double> s, squares;
  for (std::size_t i = first; i <= last; ++i) {
    const double place =
        turn ? std::abs(t.pose(i).heading_rad - t.pose(first).heading_rad) : t.arc_m(i) - t.arc_m(first);
    const double rate = turn ? t.yaw_rate(i) : t.speed(i);
    if (!s.empty() && place <= s.back() + 1e-9) continue;
    s.push_back(place);
    squares.push_back(rate * rate);
  }
  squares.front() = squares.back() = 0;
  return profile_from_squares(s, squares);
}

PlannedDrive drive_of(const Samples& t, std::size_t first, std::size_t last, int kind, const Robot& robot) {
  const bool turn = std::abs(kind) == 2;
  const double payload_kg = t.payload_kg(first), to_kg = t.payload_kg(last);
  const double angle = t.pose(last).heading_rad - t.pose(first).heading_rad;
  PlannedDrive drive{.request = {.piece = turn ? PathPiece(TurnInPlace{t.pose(first), angle})
                                               : curve_of(t, first, last, kind < 0),
                                 .plant = make_plant(robot),
                                 .limits = limits_along(robot, {payload_kg, to_kg}),
                                 .payload = {payload_kg, to_kg},
                                 .time_of_day_s = t.time_s(first)},
                     .plan = profile_of(t, first, last, turn),
                     .start_s = t.time_s(first),
                     .end_s = t.time_s(last),
                     .leg = static_cast<std::size_t>(t.leg_of(first))};
  drive.request.time = {.mode = TimeMode::time_budget, .duration_s = drive.end_s - drive.start_s};
  return drive;
}

}  // namespace

PlannedDrives planned_drives(const Trajectory& planned, const Robot& robot) {
  const Samples t(planned);
  PlannedDrives plan{.start = t.pose(0),
                     .duration_s = t.time_s(t.size() - 1),
                     .energy_J = planned.energy_J.empty() ? 0.0 : planned.energy_J.back()};
  std::size_t first = 0;
  for (std::size_t i = 0; i + 1 < t.size();) {
    const int kind = kind_of(t, i);
    first = i++;
    while (i + 1 < t.size() && kind_of(t, i) == kind && !stops_at(t, i, kind)) ++i;
    const bool longer = kind != 0 && i - first >= 2;
    if (longer) plan.drives.push_back(drive_of(t, first, i, kind, robot));
  }
  return plan;
}

PlannedDrives read_planned_drives(const std::string& directory, const Robot& robot) {
  check_plan_robot(directory, robot);
  return planned_drives(read_planned_trajectory(directory, kPieceColumns), robot);
}

}  // namespace joulepath
