#pragma once

#include <array>

#include "model/effects/effect.hpp"

// Method: [Kalker1990]
namespace joulepath {

/// Driven wheels turn slightly faster than the ground speed requires: the contact creeps under force.
struct WheelSlip {
  double creep_stiffness_N_s_m{};

  static constexpr EffectInfo info{
      .name = "wheel_slip",
      .kind = "resistance",
      .stage = Stage::contact,
      .law = "contact force = creep_stiffness (r q' - speed of the wheel's contact point)",
      .validity = "small creep, no sliding",
      .source = "linear creep (Kalker)",
      .gazebo = "<surface><friction><ode><slip1>",
      .mujoco = "solref/solimp and slide friction of the contact",
      .sign = Sign::nonnegative,
      .needs = {.pose = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<WheelSlip>{"creep_stiffness_N_s_m", "N s/m", 1.0, 1000000000.0, 2000,
                                                 "force per speed of creep; small = slippery",
                                                 &WheelSlip::creep_stiffness_N_s_m,
                                                 ParameterRole::inverse_strength}};
  }

  double creep_m_s_N() const { return 1.0 / creep_stiffness_N_s_m; }
};

}  // namespace joulepath
