#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace joulepath {

/// The shapes of motion that are prescribed rather than optimized.
///
/// | profile        | motion                                                                           |
/// |----------------|----------------------------------------------------------------------------------|
/// | constant_ramp  | accelerate for `ramp_s` (until `distance_m`), brake to rest; `repeat` times      |
/// | constant_speed | move at `speed_m_s` from the start, for `distance_m` or `duration_s`             |
/// | trapezoid      | accelerate, cruise at `speed_m_s`, decelerate within `distance_m`                |
/// | stand          | at rest for `duration_s`                                                         |
/// | spin           | turn in place by `angle_rad`, or at `yaw_rate_rad_s` for `duration_s`            |
/// | arc            | circle of `radius_m` by `angle_rad` (positive = to the left), trapezoid in speed |
/// | coast          | from `speed_m_s` without motor torque, until rest or for `duration_s`            |
enum class MotionProfile { constant_ramp, constant_speed, trapezoid, stand, spin, arc, coast };

inline constexpr std::array<std::string_view, 7> kMotionProfileNames{
    "constant_ramp", "constant_speed", "trapezoid", "stand", "spin", "arc", "coast"};

/// A cubic Bezier curve: four control points (x, y) in metres [P1, Eq. (34)].
using BezierPoints = std::array<std::array<double, 2>, 4>;

/// `motion:` of a mission leg or of an energy-only run; an absent value takes the executor's default.
struct PrescribedMotion {
  MotionProfile profile{MotionProfile::trapezoid};
  std::optional<double> acceleration_m_s2{};
  std::optional<double> deceleration_m_s2{};  ///< absent: as acceleration
  std::optional<double> speed_m_s{};
  std::optional<double> start_speed_m_s{};
  std::optional<double> ramp_s{};
  std::optional<double> distance_m{};
  std::optional<double> duration_s{};
  std::optional<double> radius_m{};
  std::optional<double> angle_rad{};  ///< positive = counter-clockwise
  std::optional<double> yaw_rate_rad_s{};
  std::optional<double> yaw_acceleration_rad_s2{};
  int repeat{1};
  bool reverse{};  ///< `direction: reverse`
  std::vector<BezierPoints>
      bezier_m{};  ///< followed instead of a straight line, in the robot's frame at the start
};

}  // namespace joulepath
