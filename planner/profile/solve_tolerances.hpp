#pragma once

namespace joulepath {

inline constexpr double kSettled =
    7e-7;  ///< relative violation that a plan may have, short of the replay's 1e-6
inline constexpr double kMetTime = 1e-7;  ///< relative: a deadline missed by less is met

}  // namespace joulepath
