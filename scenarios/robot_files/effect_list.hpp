#pragma once

#include <vector>

#include "model/robot.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

/// `effects:` of a robot file: a list of one-key maps, `- rolling_resistance: {coefficient: 0.015}`.
[[nodiscard]] Schema effect_list_schema();

/// Reads a checked list; the catalog validates every entry. Throws ConfigError at the invalid entry.
[[nodiscard]] std::vector<EffectSetting> read_effect_list(const Node& node);

}  // namespace joulepath
