#pragma once

#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {

/// A force that grows with the square of the speed.
struct QuadraticDrag {
  double coefficient_N_s2_m2{};

  static constexpr EffectInfo info{.name = "quadratic_drag",
                                   .kind = "resistance",
                                   .stage = Stage::body,
                                   .law = "force coefficient v |v| against the motion",
                                   .validity = "fast or large robots, headwind",
                                   .source = "aerodynamic drag",
                                   .gazebo = "none by default (a drag plugin)",
                                   .mujoco = "fluid drag of the body (density)",
                                   .sign = Sign::nonnegative};
  static constexpr auto parameters() {
    return std::array{EffectParameter<QuadraticDrag>{"coefficient_N_s2_m2", "N s^2/m^2", -100, 1000, 2.0,
                                                     "force at 1 m/s", &QuadraticDrag::coefficient_N_s2_m2,
                                                     ParameterRole::strength, kResistingForce}};
  }

  template <class Real>
  BodyLoad<Real> body_load(const BodyContext<Real>& body) const {
    return {coefficient_N_s2_m2 * body.site.travel_direction * (body.speed_m_s * body.speed_m_s), Real(0.0)};
  }
};

}  // namespace joulepath
