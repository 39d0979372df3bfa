#pragma once

namespace joulepath {

/// A normal quantity lies within this many sigmas of its mean with 95 % probability.
inline constexpr double kNormal95 = 1.959964;
/// The same, below its mean plus this many.
inline constexpr double kNormal95OneSided = 1.644854;

}  // namespace joulepath
