#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The payload mass differs from the stated mass.
struct PayloadMassError {
  double fraction{};

  static constexpr EffectInfo info{.name = "payload_mass_error",
                                   .kind = "mass and geometry",
                                   .stage = Stage::parameters,
                                   .law = "payload = (1 + fraction) stated",
                                   .validity = "payload carried",
                                   .source = "-",
                                   .gazebo = "<inertial><mass> of the payload link",
                                   .mujoco = "mass of the payload body"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<PayloadMassError>{"fraction", "1", -0.99, 5, 0.05,
                                                        "relative error of the stated payload",
                                                        &PayloadMassError::fraction}};
  }

  double payload_kg(double stated_kg) const { return (1.0 + fraction) * stated_kg; }
};

}  // namespace joulepath
