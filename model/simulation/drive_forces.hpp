#pragma once

#include "model/simulation/drive.hpp"

namespace joulepath {

/// Generalized forces on (v, omega, left wheel, right wheel) and their parts.
struct Drive::Forces {
  Velocity total{};              ///< accelerating force, without reactions
  Sided<double> motor_Nm{};      ///< Kt n i
  Sided<double> gear_loss_Nm{};  ///< signed, resists
  Sided<double> friction_Nm{};   ///< signed, resists; with reactions
  Sided<double> creep_m_s{};     ///< r q' - speed of the contact point, creeping only
  BodyLoad<double> load{};       ///< of the effects; with reactions
  Velocity low{};                ///< bounds of the reactions, which resist like friction
  Velocity high{};
};

}  // namespace joulepath
