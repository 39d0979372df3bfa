#pragma once

namespace joulepath {

/// Shorter pieces of a given path, and smaller steps of it, are the rounding of input files.
inline constexpr double kRounding_m = 1e-3;
inline constexpr double kRounding_rad = 1e-3;

}  // namespace joulepath
