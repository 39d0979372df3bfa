#include "effects.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "ranges.hpp"

namespace blind {
namespace {

const Range* find_range(const std::vector<Range>& ranges, const std::string& name) {
  const auto at = std::find_if(ranges.begin(), ranges.end(), [&](const Range& r) { return name == r.name; });
  return at == ranges.end() ? nullptr : &*at;
}

/// A share of a large effect, which is half of the strongest of its range. Stiffnesses and limits are
/// strongest at their least value.
double shared_size(const Range& range, double share) {
  const std::string name = range.name;
  if (name == "wheel_slip" || name == "driver_foldback") return std::max(range.low, 2 * range.low / share);
  return 0.5 * share * range.high;
}

/// Further parameters of an effect besides its size.
void draw_other_parameters(Effect& e, const Machine& nominal, Random& random) {
  constexpr double kPi = std::numbers::pi;
  const Scales s = scales_of(nominal);
  const auto add = [&](const char* key, double value) { e.parameters.emplace_back(key, value); };
  const auto draw_side = [&] { e.side = random.uniform() < 0.5 ? "left" : "right"; };
  if (e.name == "floor_patch") {
    const double start = random.uniform(0.5, 3.5), length = random.uniform(1.0, 2.5);
    add("x_min_m", start), add("x_max_m", start + length), add("y_min_m", -1.0), add("y_max_m", 1.0);
  } else if (e.name == "stribeck_friction") {
    add("speed_rad_s", s.speed_rad_s * random.uniform(0.08, 0.3));
  } else if (e.name == "dragging_wheel" || e.name == "current_sensor_offset" ||
             e.name == "wheel_eccentricity" || e.name == "flat_spot" || e.name == "encoder_drift") {
    draw_side();
  } else if (e.name == "caster_swivel") {
    add("trail_m", random.uniform(0.05, 0.3));
  } else if (e.name == "floor_slope") {
    add("uphill_direction_rad", random.uniform(-kPi, kPi));
  } else if (e.name == "winding_heating") {
    add("time_constant_s", random.uniform(60.0, 250.0));
  } else if (e.name == "belt_set") {
    add("angle_rad", random.uniform(1.0, 6.0));
  } else if (e.name == "air_draft") {
    add("direction_rad", random.uniform(-kPi, kPi));
  } else if (e.name == "payload_slosh") {
    add("frequency_rad_s", random.uniform(3.0, 9.0));
  } else if (e.name == "cold_grease") {
    add("time_constant_s", random.uniform(50.0, 200.0));
  } else if (e.name == "eddy_brake") {
    add("speed_rad_s", s.speed_rad_s * random.uniform(0.15, 0.4));
  }
}

std::vector<std::string> names_of(const std::vector<Range>& ranges) {
  std::vector<std::string> names;
  for (const Range& r : ranges) names.emplace_back(r.name);
  return names;
}

bool apply_resistance(const Effect& e, double x, std::size_t side, Machine& truth, World& world) {
  if (e.name == "rolling_resistance")
    world.rolling_coefficient = x;
  else if (e.name == "floor_patch") {
    world.patch_coefficient = x;
    world.patch_m = {e.value("x_min_m"), e.value("x_max_m"), e.value("y_min_m"), e.value("y_max_m")};
  } else if (e.name == "stribeck_friction") {
    world.stribeck_torque_Nm = x;
    world.stribeck_speed_rad_s = e.value("speed_rad_s");
  } else if (e.name == "coulomb_friction") {
    for (double& t : truth.friction_torque_Nm) t += x;
  } else if (e.name == "dragging_wheel")
    world.drag_torque_Nm[side] = x;
  else if (e.name == "direction_dependent_friction")
    world.reverse_torque_Nm = x;
  else if (e.name == "viscous_friction")
    truth.viscous_friction_Nm_s_rad += x;
  else if (e.name == "gear_efficiency")
    world.gear_loss_fraction = x;
  else if (e.name == "turning_scrub")
    world.scrub_moment_Nm = x;
  else if (e.name == "caster_swivel") {
    world.caster_moment_Nm = x;
    world.caster_trail_m = e.value("trail_m");
  } else if (e.name == "quadratic_drag")
    world.air_drag_N_s2_m2 = x;
  else if (e.name == "wheel_slip")
    truth.tyre_creep_N_s_m = x;
  else
    return false;
  return true;
}

bool apply_mass_or_place(const Effect& e, double x, Machine& truth, World& world) {
  if (e.name == "payload_mass_error")
    truth.payload_factor *= 1 + x;
  else if (e.name == "center_of_mass_offset")
    truth.center_of_mass_offset_m += x;
  else if (e.name == "yaw_inertia_error")
    truth.chassis_yaw_inertia_kg_m2 *= 1 + x;
  else if (e.name == "wheel_radius_error") {
    for (double& r : truth.wheel_radius_m) r *= 1 + x;
  } else if (e.name == "wheel_radius_mismatch") {
    truth.wheel_radius_m[kLeft] *= 1 + x / 2;
    truth.wheel_radius_m[kRight] *= 1 - x / 2;
  } else if (e.name == "track_width_error")
    truth.half_track_m *= 1 + x;
  else if (e.name == "floor_slope") {
    world.slope_grade = x;
    world.uphill_direction_rad = e.value("uphill_direction_rad");
  } else
    return false;
  return true;
}

bool apply_electrical(const Effect& e, double x, std::size_t side, Machine& truth, World& world) {
  if (e.name == "winding_resistance_error") {
    for (double& r : truth.resistance_ohm) r *= 1 + x;
  } else if (e.name == "winding_heating") {
    world.heating_fraction = x;
    world.heating_time_s = e.value("time_constant_s");
  } else if (e.name == "torque_constant_error")
    truth.torque_constant_Nm_A *= 1 + x;
  else if (e.name == "driver_voltage_drop")
    world.driver_drop_V = x;
  else if (e.name == "standby_power_error")
    truth.standby_W += x;
  else if (e.name == "regeneration_error")
    truth.regeneration_efficiency = x;
  else if (e.name == "supply_sag")
    truth.internal_resistance_ohm = x;
  else if (e.name == "current_sensor_offset")
    world.current_offset_A[side] = x;
  else if (e.name == "current_sensor_gain")
    world.current_gain = x;
  else if (e.name == "time_misalignment")
    world.electrical_delay_s = x;
  else
    return false;
  return true;
}

void apply_foreign(const Effect& e, double x, std::size_t side, World& world) {
  if (e.name == "wheel_eccentricity")
    world.eccentric_torque_Nm[side] = x;
  else if (e.name == "belt_set") {
    world.belt_set_torque_Nm = x;
    world.belt_set_angle_rad = e.value("angle_rad");
  } else if (e.name == "air_draft") {
    world.draft_force_N = x;
    world.draft_direction_rad = e.value("direction_rad");
  } else if (e.name == "flat_spot")
    world.flat_spot_torque_Nm[side] = x;
  else if (e.name == "trailing_cable")
    world.cable_N_m = x;
  else if (e.name == "payload_slosh") {
    world.slosh_fraction = x;
    world.slosh_frequency_rad_s = e.value("frequency_rad_s");
  } else if (e.name == "cold_grease") {
    world.grease_torque_Nm = x;
    world.grease_time_s = e.value("time_constant_s");
  } else if (e.name == "encoder_drift")
    world.encoder_drift[side] = x;
  else if (e.name == "eddy_brake") {
    world.eddy_torque_Nm = x;
    world.eddy_speed_rad_s = e.value("speed_rad_s");
  } else if (e.name == "driver_foldback")
    world.foldback_current_A = x;
  else
    throw std::invalid_argument("no effect '" + e.name + "'");
}

}  // namespace

double Effect::value(const std::string& parameter) const {
  for (const auto& [key, x] : parameters)
    if (key == parameter) return x;
  throw std::invalid_argument(name + " has no parameter " + parameter);
}

const std::vector<std::string>& catalog_names() {
  static const std::vector<std::string> names = names_of(catalog_ranges(nominal_machine("nomad")));
  return names;
}

const std::vector<std::string>& foreign_names() {
  static const std::vector<std::string> names = names_of(foreign_ranges(nominal_machine("nomad")));
  return names;
}

Effect draw_effect(const std::string& name, const Machine& nominal, double size, double share,
                   Random& random) {
  const std::vector<Range> known = catalog_ranges(nominal), foreign = foreign_ranges(nominal);
  const Range* range = find_range(known, name);
  Effect e;
  e.name = name;
  if (!range) {
    range = find_range(foreign, name);
    e.foreign = true;
  }
  if (!range) throw std::invalid_argument("no effect '" + name + "'");
  double drawn = random.log_uniform(range->low, range->high);
  if (share > 0) drawn = shared_size(*range, share);
  if (range->both_signs) drawn *= random.sign();
  if (name == "regeneration_error") {  // a change of the efficiency; the parameter is what replaces it
    const double up = nominal.regeneration_efficiency + std::abs(drawn);
    drawn = up <= 0.95 ? up : std::max(0.0, nominal.regeneration_efficiency - std::abs(drawn));
  }
  e.parameters.emplace_back(range->parameter, size != 0 ? size : drawn);
  draw_other_parameters(e, nominal, random);
  return e;
}

void apply_effect(const Effect& effect, const Machine&, Machine& truth, World& world) {
  const double x = effect.parameters.front().second;
  const std::size_t side = effect.side == "right" ? kRight : kLeft;
  if (apply_resistance(effect, x, side, truth, world) || apply_mass_or_place(effect, x, truth, world) ||
      apply_electrical(effect, x, side, truth, world))
    return;
  apply_foreign(effect, x, side, world);
}

std::string effect_line(const Effect& e) {
  std::ostringstream out;
  out << "{effect: " << (e.foreign ? "foreign, kind: " : "") << e.name;
  if (!e.side.empty()) out << ", side: " << e.side;
  for (const auto& [key, x] : e.parameters) out << ", " << key << ": " << x;
  out << "}";
  return out.str();
}

}  // namespace blind
