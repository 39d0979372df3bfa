#pragma once

#include <string_view>

#include "scenarios/schema.hpp"

namespace joulepath {

/// The schema of an input with physical bounds on every number: by the unit at the end of its key's name, or
/// by the name itself. The bounds are wide; a value beyond them is a slip of the unit or of a digit, and
/// would fail later in the numerics, far from its cause. Keys of `effects` and `uncertainty` keep their own
/// bounds.
[[nodiscard]] Schema with_physical_bounds(Schema schema);

/// The greatest size that a number may have when its key ends like this; infinity without such a bound.
[[nodiscard]] double greatest_size(std::string_view key);

inline constexpr double kFarthest_m = 1e6;  ///< of a coordinate from the origin

}  // namespace joulepath
