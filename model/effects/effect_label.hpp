#pragma once

#include <string>

#include "model/robot.hpp"

namespace joulepath {

/// "dragging_wheel (left)": the name of an effect with its side, where it has one.
inline std::string effect_label(const EffectSetting& effect) {
  return effect.side ? effect.name + " (" + side_name(*effect.side) + ")" : effect.name;
}

}  // namespace joulepath
