#include "rivals.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "ranges.hpp"

namespace blind {
namespace {

using Parameters = std::vector<std::pair<std::string, double>>;

bool bends(const std::string& name) {
  constexpr std::array kBent{"rolling_resistance", "floor_patch",         "stribeck_friction",
                             "dragging_wheel",     "gear_efficiency",     "direction_dependent_friction",
                             "turning_scrub",      "quadratic_drag",      "floor_slope",
                             "winding_heating",    "driver_voltage_drop", "current_sensor_offset"};
  for (const char* bent : kBent)
    if (name == bent) return true;
  return false;
}

/// What else shapes the law: a coarse grid over what the generator draws (effects.cpp).
std::vector<Parameters> shapes_of(const std::string& name, const Machine& nominal) {
  if (name == "floor_patch") {
    std::vector<Parameters> patches;
    for (const double start_m : {0.5, 1.5, 2.5, 3.5})
      patches.push_back(
          {{"x_min_m", start_m}, {"x_max_m", start_m + 1.75}, {"y_min_m", -1.0}, {"y_max_m", 1.0}});
    return patches;
  }
  if (name == "stribeck_friction") {
    const double speed_rad_s = scales_of(nominal).speed_rad_s;
    return {{{"speed_rad_s", 0.1 * speed_rad_s}},
            {{"speed_rad_s", 0.16 * speed_rad_s}},
            {{"speed_rad_s", 0.26 * speed_rad_s}}};
  }
  if (name == "caster_swivel") return {{{"trail_m", 0.08}}, {{"trail_m", 0.2}}};
  if (name == "winding_heating") return {{{"time_constant_s", 80.0}}, {{"time_constant_s", 180.0}}};
  return {{}};
}

Rival rival_of(const Range& range, const Parameters& shape, const std::string& side, const Machine& m) {
  Rival r;
  const std::string name = range.name;
  r.effect.name = name;
  r.effect.parameters.emplace_back(range.parameter, 0.0);
  r.effect.parameters.insert(r.effect.parameters.end(), shape.begin(), shape.end());
  r.effect.side = side;
  r.bends = bends(name);
  r.step = {std::sqrt(range.low * range.high)};
  r.least = {range.both_signs ? -2 * range.high : 0.0};
  r.most = {2 * range.high};
  if (name == "wheel_slip") {  // compliance in place of stiffness: it adds up
    r.step = {1 / r.step[0]};
    r.most = {2 / range.low};
  } else if (name == "regeneration_error") {
    r.least = {-m.regeneration_efficiency};
    r.most = {0.95 - m.regeneration_efficiency};
    r.step = {0.1};
  } else if (name == "floor_slope") {  // along x and along y
    r.step = {r.step[0], r.step[0]};
    r.least = {-r.most[0], -r.most[0]};
    r.most = {r.most[0], r.most[0]};
  }
  return r;
}

}  // namespace

std::vector<Rival> rivals_of(const Case& c, const std::string& truth) {
  std::vector<Rival> rivals;
  for (const Range& range : catalog_ranges(c.nominal)) {
    const std::string name = range.name;
    if (name == truth) continue;
    const bool sided = name == "dragging_wheel" || name == "current_sensor_offset";
    const std::vector<std::string> sides =
        sided ? std::vector<std::string>{"left", "right"} : std::vector<std::string>{""};
    for (const std::string& side : sides)
      for (const Parameters& shape : shapes_of(name, c.nominal))
        rivals.push_back(rival_of(range, shape, side, c.nominal));
  }
  return rivals;
}

void put_rival(const Case& c, const Rival& rival, const Vector& amplitudes, Scene& scene) {
  Effect effect = rival.effect;
  const double a = amplitudes[0];
  if (effect.name == "wheel_slip")
    scene.machine.tyre_creep_N_s_m = 1 / (1 / scene.machine.tyre_creep_N_s_m + a);
  else if (effect.name == "regeneration_error")
    scene.machine.regeneration_efficiency += a;
  else if (effect.name == "supply_sag")
    scene.machine.internal_resistance_ohm += a;
  else if (effect.name == "floor_slope") {
    scene.world.slope_grade = std::hypot(a, amplitudes[1]);
    scene.world.uphill_direction_rad = std::atan2(amplitudes[1], a);
  } else {
    effect.parameters.front().second = a;
    apply_effect(effect, c.nominal, scene.machine, scene.world);
  }
}

}  // namespace blind
