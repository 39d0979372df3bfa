#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The resistance of the armature circuit differs: cables, connectors, brushes, a warm motor.
struct WindingResistanceError {
  double fraction{};

  static constexpr EffectInfo info{.name = "winding_resistance_error",
                                   .kind = "electrical",
                                   .stage = Stage::parameters,
                                   .law = "R (1 + fraction)",
                                   .validity = "any",
                                   .source = "[P1, Eq. (15)]",
                                   .gazebo = "none",
                                   .mujoco = "none"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<WindingResistanceError>{"fraction", "1", -0.9, 10, 0.05,
                                                              "relative error of the winding resistance",
                                                              &WindingResistanceError::fraction}};
  }

  void adjust(Robot& robot) const {
    robot.motor.left.resistance_ohm *= 1.0 + fraction;
    robot.motor.right.resistance_ohm *= 1.0 + fraction;
  }
};

}  // namespace joulepath
