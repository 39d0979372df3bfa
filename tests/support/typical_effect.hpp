#pragma once

#include "model/effects/catalog.hpp"

namespace joulepath::testing {

/// An effect at its typical size; on the right side if it has one, on 20 x 20 m about the origin if it has a
/// region.
inline EffectSetting typical_effect(const EffectDescription& description) {
  EffectSetting setting{.name = std::string(description.info.name)};
  for (const ParameterDescription& p : description.parameters) setting.parameters[p.name] = p.typical;
  if (description.has_side) setting.side = Side::right;
  if (description.has_cells) setting.parameters["x_min_m"] = setting.parameters["y_min_m"] = -10;
  if (description.has_cells) setting.parameters["x_max_m"] = setting.parameters["y_max_m"] = 10;
  return setting;
}

}  // namespace joulepath::testing
