#pragma once

#include <string>
#include <vector>

#include "model/robot.hpp"

namespace joulepath {

/// A model of another simulator (URDF, SDF or MJCF) with the effects that a diagnosis named.
struct SimulatorPatch {
  struct Change {
    std::string effect{};  ///< with its side, where it has one
    std::string what{};    ///< "friction of left_wheel_joint and right_wheel_joint: 0.21 and 0.21 to ..."
  };
  struct Remainder {
    std::string effect{};
    std::string what{};  ///< what the model needs by hand or by a plugin
  };
  std::string text{};  ///< of the patched model; lines without a change are those of the file
  std::string diff{};  ///< unified; empty: nothing changes
  std::vector<Change> changes{};
  std::vector<Remainder> not_in_model{};
};

/// Adds each effect to the model. A change of friction, damping, radius, yaw inertia or center of mass is
/// made only where the patched file reads back with the intended value; an effect without a counterpart in
/// the file is told in `not_in_model`. `wheels`: as in draft_of(). The load on the wheels is that of the
/// model. Throws ConfigError for a file that is no model with two drive wheels.
[[nodiscard]] SimulatorPatch simulator_patch(const std::string& file,
                                             const std::vector<EffectSetting>& effects,
                                             const std::vector<std::string>& wheels);

}  // namespace joulepath
