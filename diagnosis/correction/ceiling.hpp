#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// Share of the held-out energy gap that the most flexible model closes: the named effects, the calibration
/// and a dictionary of all measured quantities (splines and harmonics in speed, acceleration, yaw rate,
/// payload, place, heading, wheel angle, time). The dictionary is fitted to the diagnosis runs by ridge
/// regression; leaving out diagnosis runs chooses its strength. In [0, 1], and at least the share that the
/// diagnosis itself closes.
[[nodiscard]] double ceiling_shrink_fraction(const Examination& examination, bool any_named,
                                             const EnergyGap& gap);

}  // namespace joulepath
