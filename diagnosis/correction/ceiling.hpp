#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// Share of the held-out energy gap that the most flexible model closes: the named effects, the calibration
/// and a dictionary of everything that was measured (splines and harmonics in speed, acceleration, yaw rate,
/// payload, place, heading, wheel angle, time), fitted on the diagnosis runs by ridge regression whose
/// strength comes from leaving diagnosis runs out. In [0, 1], and never below what the diagnosis itself
/// closes.
[[nodiscard]] double ceiling_shrink_fraction(const Examination& examination, bool any_named,
                                             const EnergyGap& gap);

}  // namespace joulepath
