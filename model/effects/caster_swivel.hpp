#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// Casters swivel when the course changes; until they are aligned, they push against the turn. The memory is
/// the course that they are aligned with; it follows the course with a lag in distance travelled:
///   d memory/ds = (course - memory)/trail,   moment = moment_Nm (course - memory).
struct CasterSwivel {
  double moment_Nm{};
  double trail_m{};

  static constexpr EffectInfo info{
      .name = "caster_swivel",
      .kind = "resistance",
      .stage = Stage::body,
      .law = "yaw moment of that size against the swivel, decaying as exp(-s/trail) after a change of course",
      .validity =
          "casters that trail behind; a change of course is read from the yaw rate, a reversal on a straight "
          "line is not seen",
      .source = "first-order lag in distance of the caster angle",
      .gazebo = "a swivel joint with <friction>",
      .mujoco = "a hinge with frictionloss at the caster fork",
      .sign = Sign::nonnegative,
      .pliability = Pliability::slow_turns,
      .needs = {.turns = true}};
  static constexpr std::array kTrails_m{0.03, 0.08, 0.2, 0.5};
  static constexpr auto parameters() {
    return std::array{EffectParameter<CasterSwivel>{
                          "moment_Nm", "N m", -100, 1000, 0.5, "moment against a full change of course",
                          &CasterSwivel::moment_Nm, ParameterRole::strength, kResistingMoment},
                      EffectParameter<CasterSwivel>{"trail_m",
                                                    "m",
                                                    0.005,
                                                    10,
                                                    0.1,
                                                    "distance over which the casters align",
                                                    &CasterSwivel::trail_m,
                                                    ParameterRole::shape,
                                                    {},
                                                    kTrails_m}};
  }

  double memory_rate_per_m(double memory, double course) const { return (course - memory) / trail_m; }

  template <class Real>
  BodyLoad<Real> body_load(const BodyContext<Real>& body) const {
    return {Real(0.0), Real(moment_Nm * (body.site.course - body.memory))};
  }
};

}  // namespace joulepath
