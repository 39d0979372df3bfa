#pragma once

#include <array>

#include "model/effects/effect.hpp"
#include "model/winding.hpp"

namespace joulepath {

/// Windings become warmer over the day, and the resistance of copper rises with temperature.
struct WindingHeating {
  double final_fraction{};
  double time_constant_s{};

  static constexpr EffectInfo info{
      .name = "winding_heating",
      .kind = "electrical",
      .stage = Stage::winding,
      .law = "R (1 + final_fraction (1 - exp(-t/time_constant))), t the time of day since cold",
      .validity = "a day of similar work",
      .source = "first-order thermal model of the winding",
      .gazebo = "none",
      .mujoco = "none",
      .sign = Sign::nonnegative,
      .needs = {.time_of_day = true}};
  static constexpr std::array kTimeConstants_s{25.0, 60.0, 140.0, 330.0, 1200.0};
  static constexpr auto parameters() {
    return std::array{
        EffectParameter<WindingHeating>{"final_fraction", "1", -0.5, 2, 0.1, "relative rise when warm",
                                        &WindingHeating::final_fraction},
        EffectParameter<WindingHeating>{"time_constant_s",
                                        "s",
                                        1,
                                        100000.0,
                                        200,
                                        "of the warming",
                                        &WindingHeating::time_constant_s,
                                        ParameterRole::shape,
                                        {},
                                        kTimeConstants_s}};
  }

  double resistance_factor(double time_of_day_s) const {
    return 1.0 + first_order(0.0, final_fraction, time_of_day_s, time_constant_s);
  }
};

}  // namespace joulepath
