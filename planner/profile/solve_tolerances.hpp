#pragma once

namespace joulepath {

/// Relative violation that a plan may have, below the replay's 1e-6.
inline constexpr double kLimitTolerance = 7e-7;
inline constexpr double kMetTime = 1e-7;  ///< relative: a deadline missed by less counts as met

}  // namespace joulepath
