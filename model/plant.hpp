#pragma once

#include <vector>

#include "model/dynamics.hpp"
#include "model/effects/catalog.hpp"
#include "model/kinematics.hpp"

namespace joulepath {

/// A robot together with its effects, ready to be evaluated: effects that only change constants are
/// already in `robot`; the others are kept in `effects`. Instrument effects are left out: they change
/// what a log shows, not what the robot does.
struct Plant {
  Robot robot{};
  std::vector<Effect> effects{};
  double payload_factor{1.0};     ///< actual payload / stated payload
  double torque_loss_fraction{};  ///< of the gears
  double creep_m_s_N{};           ///< speed lost at the contact per force
  double driver_voltage_drop_V{};
  Sided<double> heat_price_ohm{};  ///< W/A^2: what the current of a winding costs a planner beside its energy

  double payload_kg(double stated_kg) const { return payload_factor * stated_kg; }
  double resistance_factor(double time_of_day_s) const;
};

/// The plant of a robot file, with its `effects:` and `more_effects`. Throws ConfigError for an effect that
/// the catalog does not contain.
[[nodiscard]] Plant make_plant(const Robot& robot, const std::vector<EffectSetting>& more_effects = {});

/// The plant of a robot without any effect.
[[nodiscard]] Plant make_nominal_plant(Robot robot);

/// Applies the instrument effects among `effects` to a log, in their order.
void distort_log(const std::vector<Effect>& effects, Trajectory& log);

/// Whether an effect of the plant has a memory.
[[nodiscard]] bool remembers(const Plant& plant);

/// Advances the memories of a plant's effects by a distance (m, see caster_speed_m_s()) on a constant course;
/// exact for first-order lags.
void advance_memory(const Plant& plant, double distance_m, double course, EffectMemory& memory);

/// Advances memories along a motion: `twist_at(x)` is its twist per unit of x (time, or a path coordinate).
/// Speed and course of the casters are taken at the middle of each of `steps` equal steps.
template <class TwistAt>
void advance_memory_along(const Plant& plant, TwistAt&& twist_at, double from, double to, int steps,
                          EffectMemory& memory) {
  const Geometry& geometry = plant.robot.geometry;
  const double step = (to - from) / steps;
  for (int i = 0; i < steps; ++i) {
    const Twist<double> twist = twist_at(from + (i + 0.5) * step);
    advance_memory(plant, step * caster_speed_m_s(geometry, twist.speed_m_s, twist.yaw_rate_rad_s),
                   course_of(geometry, twist.speed_m_s, twist.yaw_rate_rad_s), memory);
  }
}

/// Calls function(effect, memory) for each effect of the plant.
template <class Function>
void for_each_effect(const Plant& plant, const EffectMemory& memory, Function&& function) {
  std::size_t slot = 0;
  for (std::size_t index = 0; index < plant.effects.size(); ++index)
    std::visit(
        [&](const auto& effect) {
          double remembered = 0.0;
          if constexpr (requires { effect.memory_rate_per_m(0.0, 0.0); }) remembered = memory[slot++];
          function(index, effect, remembered);
        },
        plant.effects[index]);
}

}  // namespace joulepath
