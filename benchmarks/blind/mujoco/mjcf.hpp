#pragma once

#include <string>

#include "machine.hpp"
#include "protocol.hpp"
#include "world.hpp"

namespace blind {

inline constexpr double kPhysicsStep_s = 1e-3;

/// The machine on a plane as an MJCF model: a free chassis, two driven wheels (hinges with damping and
/// friction loss, the motor's rotor as armature), frictionless casters ahead and behind, the payload as a
/// separate body. The DC motor is an actuator with gain K/R on the voltage and bias -K^2/R on the speed,
/// integrated implicitly. MuJoCo models these effects itself: rolling friction (contact), slope (tilted
/// gravity), a dragging wheel (friction loss of one hinge), payload (mass of its body), and all changed
/// constants.
///
/// Throws std::invalid_argument for other effects, and for level 1.
[[nodiscard]] std::string mjcf_text(const Machine& machine, const World& world, const Run& run);

}  // namespace blind
