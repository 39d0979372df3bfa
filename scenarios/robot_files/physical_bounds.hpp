#pragma once

#include <string_view>

#include "scenarios/text/schema.hpp"

namespace joulepath {

/// The schema of an input with physical bounds on every number, by the unit at the end of its key or by the
/// key itself. The bounds are wide. A value beyond them has a wrong unit or digit and would otherwise fail
/// later in the numerics. Keys of `effects` and `uncertainty` keep their own bounds.
[[nodiscard]] Schema with_physical_bounds(Schema schema);

/// The greatest size that a number may have when its key ends like this; infinity without such a bound.
[[nodiscard]] double greatest_size(std::string_view key);

inline constexpr double kFarthest_m = 1e6;  ///< of a coordinate from the origin

}  // namespace joulepath
