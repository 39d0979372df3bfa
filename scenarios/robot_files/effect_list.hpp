#pragma once

#include <vector>

#include "model/robot.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

/// One effect: a map with one key, `rolling_resistance: {coefficient: 0.015}`.
[[nodiscard]] Schema effect_entry_schema();

/// Reads a checked entry; the catalog validates it. Throws ConfigError at the entry.
[[nodiscard]] EffectSetting read_effect_entry(const Node& entry);

/// `effects:` of a robot file: a list of such entries.
[[nodiscard]] Schema effect_list_schema();

/// Reads a checked list; the catalog validates every entry. Throws ConfigError at the invalid entry.
[[nodiscard]] std::vector<EffectSetting> read_effect_list(const Node& node);

}  // namespace joulepath
