#pragma once

#include "scenarios/text/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema sweep_schema();  ///< sweep.json
[[nodiscard]] Schema shard_schema();  ///< shard.json

}  // namespace joulepath
