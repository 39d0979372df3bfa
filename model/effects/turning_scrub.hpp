#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// Tires and casters scrub the floor whenever the robot turns.
struct TurningScrub {
  double moment_Nm{};

  static constexpr EffectInfo info{.name = "turning_scrub",
                                   .kind = "resistance",
                                   .stage = Stage::body,
                                   .law = "yaw moment against the yaw rate, constant size",
                                   .validity = "wide tires, casters or tracks on a hard floor",
                                   .source = "Coulomb law at the contact patch",
                                   .gazebo = "<surface><friction><torsional>",
                                   .mujoco = "torsional friction of the wheel geoms",
                                   .sign = Sign::nonnegative,
                                   .pliability = Pliability::slow_turns,
                                   .needs = {.turns = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<TurningScrub>{"moment_Nm", "N m", -100, 1000, 0.3,
                                                    "moment against the turn", &TurningScrub::moment_Nm,
                                                    ParameterRole::strength, kResistingMoment}};
  }

  template <class Real>
  BodyLoad<Real> body_load(const BodyContext<Real>& body) const {
    return {Real(0.0), Real(moment_Nm * body.site.turn_direction)};
  }
};

}  // namespace joulepath
