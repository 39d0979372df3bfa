#pragma once

#include "scenarios/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema sweep_schema();  ///< sweep.json
[[nodiscard]] Schema shard_schema();  ///< shard.json

}  // namespace joulepath
