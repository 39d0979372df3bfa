#include "diagnosis/prediction/candidates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace joulepath {
namespace {

/// Effects that physics allows in one direction only: they take energy, never give it.
const std::set<std::string> kOneSigned{
    "rolling_resistance", "floor_patch",     "stribeck_friction",
    "dragging_wheel",     "turning_scrub",   "direction_dependent_friction",
    "caster_swivel",      "gear_efficiency", "quadratic_drag",
    "wheel_slip",         "winding_heating", "driver_voltage_drop",
    "regeneration_error"};

/// Grids over shape parameters; any other gets multiples of its typical size.
const std::map<std::string, std::vector<double>> kShapeGrids{{"speed_rad_s", {0.6, 1.0, 1.6, 2.5, 4.0}},
                                                             {"trail_m", {0.03, 0.08, 0.2, 0.5}},
                                                             {"time_constant_s", {25, 60, 140, 330, 1200}},
                                                             {"delay_s", {}}};

std::vector<double> shape_grid(const ParameterDescription& parameter) {
  const auto found = kShapeGrids.find(parameter.name);
  if (found != kShapeGrids.end()) return found->second;
  std::vector<double> grid;
  for (double factor : {0.3, 1.0, 3.0})
    grid.push_back(std::clamp(factor * parameter.typical, parameter.min, parameter.max));
  return grid;
}

double value_or(const EffectSetting& setting, const std::string& key, double fallback) {
  const auto found = setting.parameters.find(key);
  return found == setting.parameters.end() ? fallback : found->second;
}

/// What a parameter replaces in the robot file, if it does.
double replaced_value(const std::string& effect, const Robot& robot) {
  if (effect == "regeneration_error") return robot.power.regeneration_efficiency;
  if (effect == "supply_sag") return robot.battery.internal_resistance_ohm;
  return 0.0;
}

constexpr double kHardestContact_N_s_m = 1e8;

/// What drives and stops a robot: the measure by which a resistance is small or large.
struct OwnResistance {
  double torque_Nm{}, moment_Nm{}, force_N{}, current_A{};
};

OwnResistance own_resistance(const Robot& robot) {
  OwnResistance own;
  for (Side side : kSides) {
    const Motor& motor = robot.motor[side];
    const double radius_m = robot.geometry.wheel_radius_m[side];
    const double rolling_N = 0.01 * 9.81 * robot.inertia.chassis_mass_kg / 2;  // of a hard tire
    const double torque_Nm = motor.friction_torque_Nm + rolling_N * radius_m;
    own.torque_Nm += 0.5 * torque_Nm;
    own.force_N += torque_Nm / radius_m;
    own.current_A += 0.5 * torque_Nm / motor.torque_per_ampere_Nm_A();
  }
  own.moment_Nm = own.force_N * robot.geometry.half_track_m;
  return own;
}

/// The catalog's typical sizes are those of a robot of 24 kg; this is what they are on another robot.
double typical_size(const ParameterDescription& parameter, const Robot& robot) {
  constexpr OwnResistance kReference{
      .torque_Nm = 0.463, .moment_Nm = 1.53, .force_N = 9.27, .current_A = 0.27};
  const OwnResistance own = own_resistance(robot);
  const std::string_view name(parameter.name);
  if (name == "moment_Nm") return parameter.typical * own.moment_Nm / kReference.moment_Nm;
  if (parameter.unit == std::string_view("N m"))
    return parameter.typical * own.torque_Nm / kReference.torque_Nm;
  if (name == "offset_A") return parameter.typical * own.current_A / kReference.current_A;
  if (name == "coefficient_N_s2_m2") return parameter.typical * own.force_N / kReference.force_N;
  return parameter.typical;
}

void add_with_grid(const EffectDescription& description, Candidate candidate, std::vector<Candidate>& out) {
  std::vector<Candidate> grown{std::move(candidate)};
  for (const std::string& name : shape_parameters(std::string(description.info.name))) {
    std::vector<Candidate> next;
    for (const ParameterDescription& parameter : description.parameters)
      if (parameter.name == name)
        for (double value : shape_grid(parameter))
          for (Candidate c : grown) {
            c.shape.parameters[name] = value;
            next.push_back(std::move(c));
          }
    grown = std::move(next);
  }
  out.insert(out.end(), grown.begin(), grown.end());
}

}  // namespace

std::string Candidate::label() const {
  return shape.side ? shape.name + " (" + side_name(*shape.side) + ")" : shape.name;
}

std::vector<std::string> shape_parameters(const std::string& effect) {
  const EffectDescription* description = find_effect(effect);
  std::vector<std::string> names;
  if (!description || effect == "floor_slope") return names;
  for (std::size_t k = 1; k < description->parameters.size(); ++k)
    names.push_back(description->parameters[k].name);
  return names;
}

EffectSetting setting_of(const Candidate& candidate, const std::vector<double>& amplitudes,
                         const Robot& robot) {
  EffectSetting setting = candidate.shape;
  const EffectDescription& description = *find_effect(setting.name);
  if (setting.name == "floor_slope") {
    setting.parameters["grade"] = std::min(0.3, std::hypot(amplitudes[0], amplitudes[1]));
    setting.parameters["uphill_direction_rad"] = std::atan2(amplitudes[1], amplitudes[0]);
    return setting;
  }
  const ParameterDescription& first = description.parameters.front();
  double value = amplitudes[0] + replaced_value(setting.name, robot);
  if (setting.name == "wheel_slip")
    value = amplitudes[0] > 1 / kHardestContact_N_s_m ? 1 / amplitudes[0] : kHardestContact_N_s_m;
  setting.parameters[first.name] = std::clamp(value, first.min, first.max);
  return setting;
}

std::vector<double> amplitudes_of(const EffectSetting& setting, const Robot& robot) {
  if (setting.name == "floor_slope") {
    const double grade = value_or(setting, "grade", 0),
                 direction = value_or(setting, "uphill_direction_rad", 0);
    return {grade * std::cos(direction), grade * std::sin(direction)};
  }
  const std::string& first = find_effect(setting.name)->parameters.front().name;
  if (setting.name == "wheel_slip") return {1 / value_or(setting, first, kHardestContact_N_s_m)};
  return {value_or(setting, first, 0) - replaced_value(setting.name, robot)};
}

std::vector<Candidate> catalog_candidates(const Robot& robot, const std::set<std::string>& without) {
  std::vector<Candidate> candidates;
  for (const EffectDescription& description : effect_catalog()) {
    const std::string name(description.info.name);
    if (name == "floor_patch" || without.contains(name)) continue;
    const ParameterDescription& first = description.parameters.front();
    Candidate candidate{.shape = {.name = name},
                        .amplitude = {first.name},
                        .step = {typical_size(first, robot)},
                        .nonnegative = kOneSigned.contains(name)};
    if (name == "floor_slope")
      candidate.amplitude = {"x", "y"}, candidate.step = {first.typical, first.typical};
    if (name == "wheel_slip") candidate.step = {1 / first.typical};
    if (name == "regeneration_error" && robot.power.regeneration_efficiency > 0)
      candidate.nonnegative = false;
    if (!description.has_side) {
      add_with_grid(description, candidate, candidates);
      continue;
    }
    for (Side side : kSides) {
      candidate.shape.side = side;
      add_with_grid(description, candidate, candidates);
    }
  }
  return candidates;
}

}  // namespace joulepath
