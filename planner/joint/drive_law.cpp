#include "planner/joint/drive_law.hpp"

#include <algorithm>

#include "model/operating_point.hpp"

namespace joulepath::joint {
namespace {

using States = Sided<WheelState<double>>;
/// The split of power at zero needs a loss, however small: the profile solver counts the exact efficiency.
constexpr double kMostEfficiency = 0.99;

/// States of the wheels at a motion, with both wheels turning forward or backward.
class Probe {
 public:
  Probe(const Plant& plant, double payload_kg, const Pose& place, int direction)
      : plant_(plant), site_{.pose = place, .payload_kg = payload_kg} {
    site_.travel_direction = direction;
    site_.wheel_direction = {static_cast<double>(direction), static_cast<double>(direction)};
  }
  States operator()(const BodyMotion<double>& motion, double wheels = 0) const {
    Site site = site_;
    if (wheels != 0) site.wheel_direction = {wheels, wheels};
    return operating_point(plant_, motion, site);
  }

 private:
  const Plant& plant_;
  Site site_{};
};

WheelLaw wheel_law(const Probe& at, Side side) {
  const auto forward = at({}, 1)[side], backward = at({}, -1)[side];
  const auto rest = at({})[side];
  const auto current = [&](const BodyMotion<double>& motion) { return at(motion)[side].current_A; };
  const double none = rest.current_A, speed = current({.speed_m_s = 1}),
               left = current({.yaw_rate_rad_s = 1}), right = current({.yaw_rate_rad_s = -1});
  WheelLaw law{.constant = 0.5 * (forward.current_A + backward.current_A),
               .sign = 0.5 * (forward.current_A - backward.current_A),
               .speed = speed - none,
               .yaw_rate = 0.5 * (left - right),
               .yaw_rate_squared = 0.5 * (left + right) - none,
               .speed_by_yaw_rate = current({.speed_m_s = 1, .yaw_rate_rad_s = 1}) - speed - left + none,
               .acceleration = current({.acceleration_m_s2 = 1}) - none,
               .yaw_acceleration = current({.yaw_acceleration_rad_s2 = 1}) - none};
  const auto pushed = at({.acceleration_m_s2 = 1})[side];
  law.resistance = (pushed.voltage_V - rest.voltage_V) / (pushed.current_A - rest.current_A);
  const auto emf_V = [&](const WheelState<double>& x) { return x.voltage_V - law.resistance * x.current_A; };
  law.emf = 0.5 * (emf_V(forward) + emf_V(backward));
  law.emf_sign = 0.5 * (emf_V(forward) - emf_V(backward));
  law.emf_speed = emf_V(at({.speed_m_s = 1})[side]) - emf_V(rest);
  law.emf_yaw_rate = emf_V(at({.yaw_rate_rad_s = 1})[side]) - emf_V(rest);
  return law;
}

}  // namespace

DriveLaw drive_law(const Plant& plant, const Limits& limits, double payload_kg, const Pose& place,
                   double price_W, int direction) {
  const Probe at(plant, payload_kg, place, direction);
  const PowerSupply& power = plant.robot.power;
  return {.wheel = {wheel_law(at, Side::left), wheel_law(at, Side::right)},
          .limits = limits,
          .half_track_m = plant.robot.geometry.half_track_m,
          .price_W = price_W + power.standby_W,
          .efficiency = std::min(kMostEfficiency, power.regeneration_efficiency),
          .shared_bus = power.sharing == PowerSharing::bus};
}

}  // namespace joulepath::joint
