#pragma once

#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// Runs may come out a little worse on energy while the correction is right.
inline constexpr double kToleratedWorsening = 1.05;
/// A held-out gap above so many noise floors is more than noise.
inline constexpr double kFloorsLeft = 2.0;

/// The robot as it seems to be, calibration constants moved and effects added, where that does not make
/// the held-out energy worse.
void write_correction(Examination& examination, const ModelState& corrected);

}  // namespace joulepath
