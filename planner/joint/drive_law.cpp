#include "planner/joint/drive_law.hpp"

#include <algorithm>
#include <cmath>

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

/// Of a quantity of a wheel: double value(const WheelState<double>&).
template <class Value>
WheelForm form_of(const Probe& at, Side side, const Value& value) {
  const auto with = [&](const BodyMotion<double>& motion) { return value(at(motion)[side]); };
  const double forward = value(at({}, 1)[side]), backward = value(at({}, -1)[side]), none = with({}),
               speed = with({.speed_m_s = 1}), left = with({.yaw_rate_rad_s = 1}),
               right = with({.yaw_rate_rad_s = -1});
  return {.constant = 0.5 * (forward + backward),
          .sign = 0.5 * (forward - backward),
          .speed = speed - none,
          .yaw_rate = 0.5 * (left - right),
          .yaw_rate_squared = 0.5 * (left + right) - none,
          .speed_by_yaw_rate = with({.speed_m_s = 1, .yaw_rate_rad_s = 1}) - speed - left + none,
          .acceleration = with({.acceleration_m_s2 = 1}) - none,
          .yaw_acceleration = with({.yaw_acceleration_rad_s2 = 1}) - none};
}

WheelLaw wheel_law(const Probe& at, Side side) {
  const auto forward = at({}, 1)[side], backward = at({}, -1)[side];
  const auto rest = at({})[side];
  WheelLaw law{.current_A = form_of(at, side, [](const auto& wheel) { return wheel.current_A; })};
  const auto pushed = at({.acceleration_m_s2 = 1})[side];
  law.resistance = (pushed.voltage_V - rest.voltage_V) / (pushed.current_A - rest.current_A);
  const auto emf_V = [&](const WheelState<double>& x) { return x.voltage_V - law.resistance * x.current_A; };
  law.emf = 0.5 * (emf_V(forward) + emf_V(backward));
  law.emf_sign = 0.5 * (emf_V(forward) - emf_V(backward));
  law.emf_speed = emf_V(at({.speed_m_s = 1})[side]) - emf_V(rest);
  law.emf_yaw_rate = emf_V(at({.yaw_rate_rad_s = 1})[side]) - emf_V(rest);
  return law;
}

/// The largest magnitude of a form within the limits of the body's motion; infinite where one of them is
/// absent that would bound it.
double most_within(const WheelForm& form, const Limits& most) {
  const auto up_to = [](double weight, double limit) { return weight == 0 ? 0.0 : std::abs(weight) * limit; };
  const double rate = most.yaw_rate_rad_s, gain = std::max(most.acceleration_m_s2, most.deceleration_m_s2);
  return std::abs(form.constant) + std::abs(form.sign) + up_to(form.speed, most.speed_m_s) +
         up_to(form.yaw_rate, rate) + up_to(form.yaw_rate_squared, rate * rate) +
         up_to(form.speed_by_yaw_rate, most.lateral_acceleration_m_s2) + up_to(form.acceleration, gain) +
         up_to(form.yaw_acceleration, most.yaw_acceleration_rad_s2);
}

std::vector<WheelLimit> wheel_limits(const Plant& plant, const Limits& limits, double payload_kg,
                                     const Probe& at, const Sided<WheelLaw>& wheel) {
  const Robot& robot = plant.robot;
  const double load_N = 0.5 * robot.total_mass_kg(plant.payload_kg(payload_kg)) * kGravity_m_s2;
  std::vector<WheelLimit> all;
  for (const Side side : kSides) {
    const auto add = [&](double most, const WheelForm& form) {
      if (most > 0 && most_within(form, limits) > most) all.push_back({side, form, most});
    };
    const Motor& motor = robot.motor[side];
    const double radius_m = robot.geometry.wheel_radius_m[side];
    add(motor.max_current_A, wheel[side].current_A);
    add(std::min(motor.max_voltage_V, limits.battery_voltage_V),
        form_of(at, side, [](const auto& state) { return state.voltage_V; }));
    add(limits.traction_coefficient * load_N,
        form_of(at, side, [](const auto& state) { return state.contact_force_N; }));
    add(limits.wheel_acceleration_rad_s2,
        {.acceleration = 1 / radius_m,
         .yaw_acceleration = side_sign(side) * robot.geometry.half_track_m / radius_m});
  }
  return all;
}

/// max(P, eta P) is the larger of two, so a limit holds for both motors recovering or not.
std::vector<PowerLimit> power_limits(const PowerSupply& power, const Limits& limits) {
  std::vector<PowerLimit> all;
  const auto add = [&](double most_W, const Sided<double>& share) {
    if (most_W > 0 && std::isfinite(most_W)) all.push_back({share, most_W});
  };
  for (const double sign : {1.0, -1.0}) {
    add(limits.motor_power_W, {sign, 0});
    add(limits.motor_power_W, {0, sign});
  }
  const double kept = power.regeneration_efficiency, at_battery_W = limits.battery_power_W - power.standby_W;
  add(at_battery_W, {1, 1});
  if (power.sharing != PowerSharing::bus && kept < 1) {
    add(at_battery_W, {1, kept});
    add(at_battery_W, {kept, 1});
  }
  if (kept > 0) add(limits.charge_power_W + power.standby_W, {-kept, -kept});
  return all;
}

}  // namespace

DriveLaw drive_law(const Plant& plant, const Limits& limits, double payload_kg, const Pose& place,
                   double price_W, int direction) {
  const Probe at(plant, payload_kg, place, direction);
  const PowerSupply& power = plant.robot.power;
  const Sided<WheelLaw> wheel{wheel_law(at, Side::left), wheel_law(at, Side::right)};
  return {.wheel = wheel,
          .limits = limits,
          .half_track_m = plant.robot.geometry.half_track_m,
          .price_W = price_W + power.standby_W,
          .efficiency = std::min(kMostEfficiency, power.regeneration_efficiency),
          .shared_bus = power.sharing == PowerSharing::bus,
          .wheel_limits = wheel_limits(plant, limits, payload_kg, at, wheel),
          .power_limits = power_limits(power, limits)};
}

}  // namespace joulepath::joint
