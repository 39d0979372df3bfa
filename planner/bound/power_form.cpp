#include "planner/bound/power_form.hpp"

#include <algorithm>
#include <cmath>

#include "model/operating_point.hpp"
#include "model/power.hpp"

namespace joulepath {
namespace {

constexpr double kHot_s = 1e9;       ///< every winding has its final temperature
constexpr double kSameForm = 1e-11;  ///< A
constexpr double kSamePower = 1e-7;  ///< relative

/// The model at motions of one sector, by its coordinates.
class SectorModel {
 public:
  SectorModel(const Plant& plant, const Sector& sector, double payload_kg)
      : plant_(plant), sector_(sector), payload_kg_(payload_kg) {
    const double cold = plant.resistance_factor(0.0), hot = plant.resistance_factor(kHot_s);
    time_s_ = cold <= hot ? 0.0 : kHot_s;
  }

  Sided<WheelState<double>> at(double m, double x, double a, double alpha, const Site& elsewhere = {}) const {
    const double l = plant_.robot.geometry.half_track_m, way = sector_.travel < 0 ? -1 : 1;
    const double v = sector_.turning ? m * x : m, lw = sector_.turning ? m : m * x;
    const BodyMotion<double> motion{way * v, way * a, sector_.turn * lw / l, alpha};
    Site site = elsewhere;
    site.time_of_day_s = time_s_;
    site.payload_kg = payload_kg_;
    site.travel_direction = sector_.travel;
    site.turn_direction = sector_.turn;
    site.wheel_direction = directions();
    site.course = course_of(plant_.robot.geometry, way * (sector_.turning ? x : 1),
                            sector_.turn * (sector_.turning ? 1 : x) / l);
    return operating_point(plant_, motion, site);
  }
  double resistance_factor() const { return plant_.resistance_factor(time_s_); }

 private:
  /// Of the wheels; a line at which a wheel stands still has none there.
  Sided<double> directions() const {
    const double middle = 0.5 * (sector_.x_low + sector_.x_high);
    const double v = sector_.travel * (sector_.turning ? middle : 1),
                 lw = sector_.turn * (sector_.turning ? 1 : middle);
    return {sign_of(v - lw), sign_of(v + lw)};
  }

  const Plant& plant_;
  const Sector& sector_;
  double payload_kg_{}, time_s_{};
};

WheelForm fitted(const SectorModel& model, const Motor& motor, Side side) {
  const auto current = [&](double m, double x, double a = 0, double alpha = 0) {
    return model.at(m, x, a, alpha)[side].current_A;
  };
  const auto speed = [&](double x) { return model.at(1, x, 0, 0)[side].speed_rad_s; };
  WheelForm form{.resistance_ohm = model.resistance_factor() * motor.resistance_ohm,
                 .volts_per_speed = motor.volts_per_speed_V_s_rad()};
  form.i0 = current(0, 0);
  form.of_a = current(0, 0, 1) - form.i0;
  form.of_alpha = current(0, 0, 0, 1) - form.i0;
  std::array<double, 3> linear{}, square{};  // at x = 0, 1/2, 1
  for (std::size_t j = 0; j < 3; ++j) {
    const double one = current(1, 0.5 * static_cast<double>(j)) - form.i0,
                 two = current(2, 0.5 * static_cast<double>(j)) - form.i0;
    linear[j] = 2 * one - 0.5 * two;
    square[j] = 0.5 * two - one;
  }
  form.b0 = linear[0], form.b1 = linear[2] - linear[0];
  form.d0 = square[0], form.d2 = 2 * (square[0] + square[2] - 2 * square[1]);
  form.d1 = square[2] - square[0] - form.d2;
  form.s0 = speed(0), form.s1 = speed(1) - form.s0;
  return form;
}

double power_W(const WheelForm& form, double m, double x, double a, double alpha) {
  const double i = form.i0 + m * (form.b0 + form.b1 * x) + m * m * (form.d0 + x * (form.d1 + x * form.d2)) +
                   form.of_a * a + form.of_alpha * alpha;
  return i * (form.resistance_ohm * i + form.volts_per_speed * m * (form.s0 + form.s1 * x));
}

/// Whether the form is the model's power at motions, places and memories that the fit has not seen.
bool holds(const SectorModel& model, const Sector& sector) {
  for (int n = 0; n < 24; ++n) {
    const auto draw = [&](int k) {
      return std::fmod(0.137 + 0.618034 * (n + 1) * (k + 1) + 0.2371 * k * k, 1.0);
    };
    const double m = 1.7 * draw(0), x = sector.x_low + draw(1) * (sector.x_high - sector.x_low);
    const double a = 2 * draw(2) - 1, alpha = 4 * draw(3) - 2;
    Site elsewhere;
    elsewhere.pose = {40 * draw(4) - 20, 40 * draw(5) - 20, 6.3 * draw(6)};
    elsewhere.memory = {2 * draw(7) - 1, 2 * draw(8) - 1};
    const Sided<WheelState<double>> wheels = model.at(m, x, a, alpha, elsewhere);
    for (Side side : kSides) {
      const double true_W = wheels[side].power_W;
      if (!(std::abs(power_W(sector.wheel[side], m, x, a, alpha) - true_W) <=
            kSamePower * (1 + std::abs(true_W))))
        return false;
    }
  }
  return true;
}

std::vector<Sector> all_sectors() {
  std::vector<Sector> sectors;
  for (double turn : {1.0, -1.0})
    sectors.push_back({.turning = true, .travel = 0, .turn = turn, .x_low = 0, .x_high = 0});
  for (double travel : {1.0, -1.0}) {
    sectors.push_back({.travel = travel, .turn = 0, .x_low = 0, .x_high = 0});
    for (double turn : {1.0, -1.0}) {
      sectors.push_back({.travel = travel, .turn = turn});
      sectors.push_back({.travel = travel, .turn = turn, .x_low = 1, .x_high = 1});
      sectors.push_back({.turning = true, .travel = travel, .turn = turn});
    }
  }
  return sectors;
}

/// False if no form describes the plant.
bool fit(const Plant& plant, double payload_kg, std::vector<Sector>& sectors) {
  for (Sector& sector : sectors) {
    const SectorModel model(plant, sector, payload_kg);
    for (Side side : kSides) sector.wheel[side] = fitted(model, plant.robot.motor[side], side);
    if (!holds(model, sector)) return false;
  }
  return true;
}

/// Whether driving in reverse is driving forward with every wheel turning the other way.
bool is_reverse_of(const Sector& reverse, const Sector& forward) {
  if (reverse.turning != forward.turning || reverse.travel != -forward.travel ||
      reverse.turn != -forward.turn || reverse.x_low != forward.x_low || reverse.x_high != forward.x_high)
    return false;
  for (Side side : kSides) {
    const WheelForm &r = reverse.wheel[side], &f = forward.wheel[side];
    for (const double sum : {r.i0 + f.i0, r.b0 + f.b0, r.b1 + f.b1, r.d0 + f.d0, r.d1 + f.d1, r.d2 + f.d2,
                             r.of_a + f.of_a, r.of_alpha - f.of_alpha, r.s0 + f.s0, r.s1 + f.s1})
      if (std::abs(sum) > kSameForm) return false;
  }
  return true;
}

void mark_mirrored(std::vector<Sector>& sectors) {
  for (Sector& sector : sectors)
    sector.mirrored = sector.travel < 0 &&
                      std::any_of(sectors.begin(), sectors.end(),
                                  [&](const Sector& forward) { return is_reverse_of(sector, forward); });
}

/// A part of the floor may lie between all places at which the form is compared with the model.
bool acts_in_places(const Effect& effect) {
  return std::visit([](const auto& one) { return std::decay_t<decltype(one)>::info.needs.pose; }, effect);
}

std::string culprit(const Plant& plant, double payload_kg) {
  for (const Effect& effect : plant.effects) {
    if (acts_in_places(effect)) return setting_of(effect).name;
    Plant alone = plant;
    alone.effects = {effect};
    alone.torque_loss_fraction = alone.creep_m_s_N = 0;
    std::vector<Sector> sectors = all_sectors();
    if (!fit(alone, payload_kg, sectors)) return setting_of(effect).name;
  }
  if (plant.torque_loss_fraction != 0) return "gear_efficiency";
  return plant.creep_m_s_N != 0 ? "wheel_slip" : "the robot's model";
}

std::string missing_limit(const PowerForm& form) {
  const Limits& limits = form.limits;
  const std::pair<double, const char*> needed[] = {
      {limits.speed_m_s, "speed_m_s"},
      {limits.acceleration_m_s2, "acceleration_m_s2"},
      {limits.deceleration_m_s2, "deceleration_m_s2"},
      {limits.yaw_rate_rad_s, "yaw_rate_rad_s"},
      {limits.yaw_acceleration_rad_s2, "yaw_acceleration_rad_s2"}};
  for (const auto& [value, key] : needed)
    if (!std::isfinite(value)) return std::string("the robot has no limit ") + key;
  return form.standby_W > 0 ? "" : "standby power is zero";
}

}  // namespace

PowerForm power_form(const Plant& plant, const Limits& limits, double payload_kg) {
  Plant plain = plant;
  plain.driver_voltage_drop_V = 0;
  const Robot& robot = plant.robot;
  const double l = robot.geometry.half_track_m,
               r = 0.5 * (robot.geometry.wheel_radius_m.left + robot.geometry.wheel_radius_m.right);
  PowerForm form{.sectors = all_sectors(),
                 .half_track_m = l,
                 .standby_W = robot.power.standby_W,
                 .regeneration = robot.power.regeneration_efficiency,
                 .shared = robot.power.sharing == PowerSharing::bus,
                 .reverse = std::isfinite(limits.reverse_speed_m_s),
                 .limits = limits};
  form.yaw_inertia_kg_m2 = mass_properties(robot, plant.payload_kg(payload_kg)).yaw_inertia_kg_m2 +
                           2 * robot.inertia.wheel_axle_inertia_kg_m2 * l * l / (r * r);
  form.yaw_inertia_kg_m2 *= robot.motor.left.voltage_constant_V_s_rad / robot.motor.left.torque_constant_Nm_A;
  form.not_covered = missing_limit(form);
  if (form.not_covered.empty() && plant.driver_voltage_drop_V < 0)
    form.not_covered = "the bound does not cover a negative voltage drop of the drivers";
  if (form.not_covered.empty() && (std::any_of(plain.effects.begin(), plain.effects.end(), acts_in_places) ||
                                   !fit(plain, payload_kg, form.sectors)))
    form.not_covered = "the bound does not cover " + culprit(plain, payload_kg);
  if (!form.reverse) std::erase_if(form.sectors, [](const Sector& sector) { return sector.travel < 0; });
  mark_mirrored(form.sectors);
  return form;
}

}  // namespace joulepath
