#include "model/plant.hpp"

#include <algorithm>
#include <cmath>

#include "model/channel_delay.hpp"
#include "model/config_error.hpp"

namespace joulepath {
namespace {

/// Applies the part of an effect that only changes constants; returns whether another part remains.
template <class Type>
bool absorb(const Type& effect, Plant& plant) {
  if constexpr (Type::info.stage == Stage::instrument)
    return false;
  else if constexpr (requires(Robot & robot) { effect.adjust(robot); })
    return effect.adjust(plant.robot), false;
  else if constexpr (requires { effect.payload_kg(1.0); })
    return plant.payload_factor *= effect.payload_kg(1.0), false;
  else if constexpr (requires { effect.torque_loss_fraction(); })
    plant.torque_loss_fraction += effect.torque_loss_fraction();
  else if constexpr (requires { effect.creep_m_s_N(); })
    plant.creep_m_s_N += effect.creep_m_s_N();
  else if constexpr (requires { effect.voltage_drop_V(); })
    plant.driver_voltage_drop_V += effect.voltage_drop_V();
  return true;
}

}  // namespace

double Plant::resistance_factor(double time_of_day_s) const {
  double factor = 1.0;
  for (const Effect& effect : effects)
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.resistance_factor(0.0); }) factor *= e.resistance_factor(time_of_day_s);
        },
        effect);
  return factor;
}

Plant make_plant(const Robot& robot, const std::vector<EffectSetting>& more_effects) {
  Plant plant{.robot = robot};
  plant.robot.effects.insert(plant.robot.effects.end(), more_effects.begin(), more_effects.end());
  std::size_t memories = 0;
  for (const EffectSetting& setting : plant.robot.effects) {
    const Effect effect = make_effect(setting);
    if (!std::visit([&](const auto& e) { return absorb(e, plant); }, effect)) continue;
    memories += std::visit(
        [](const auto& e) {
          return requires { e.memory_rate_per_m(0.0, 0.0); };
        },
        effect);
    plant.effects.push_back(effect);
  }
  if (memories > kMaxMemories)
    throw ConfigError({.mark = {},
                       .key = "effects",
                       .found = std::to_string(memories) + " effects with a memory",
                       .accepted = "at most " + std::to_string(kMaxMemories),
                       .hint = {}});
  return plant;
}

Plant make_nominal_plant(Robot robot) {
  robot.effects.clear();
  return make_plant(robot);
}

void distort_log(const std::vector<Effect>& effects, Trajectory& log) {
  for (const Effect& effect : effects)
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.current_reading(Side::left); })
            for (Side side : kSides)
              for (double& current_A : log.motor_current_A[side]) {
                const CurrentReading reading = e.current_reading(side);
                current_A = reading.gain * current_A + reading.offset_A;
              }
          if constexpr (requires { e.channel_delay_s(); }) delay_motor_channels(log, e.channel_delay_s());
        },
        effect);
}

bool remembers(const Plant& plant) {
  for (const Effect& effect : plant.effects)
    if (std::visit(
            [](const auto& e) {
              return requires { e.memory_rate_per_m(0.0, 0.0); };
            },
            effect))
      return true;
  return false;
}

void advance_memory(const Plant& plant, double distance_m, double course, EffectMemory& memory) {
  std::size_t slot = 0;
  for (const Effect& effect : plant.effects)
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.memory_rate_per_m(0.0, 0.0); }) {
            const double rate_per_m = e.memory_rate_per_m(0.0, 1.0);  // d(memory)/ds = rate (course - memory)
            memory[slot] = course + (memory[slot] - course) * std::exp(-std::abs(distance_m) * rate_per_m);
            ++slot;
          }
        },
        effect);
}

}  // namespace joulepath
