#pragma once

#include "diagnosis/signals/log_set.hpp"

namespace joulepath {

/// What the windings tell of wheel speeds that are late.
struct LateSpeeds {
  double filter_s{};       ///< time constant of a first-order filter that explains them; 0: none is told
  bool filter_fits_too{};  ///< none is told, but it explains them about as well as a delay, if they are late
};

/// V = a + b i + c q with the wheel speed q. Behind a filter of the time constant T, q is the logged speed
/// plus T times its slope; behind a delay it is the logged speed of a later time. The two differ in the
/// second order of the time. A clock offset beside a filter is told where it exceeds half a sample: by so
/// much a filter that is computed at the samples differs from one in continuous time.
[[nodiscard]] LateSpeeds examine_late_speeds(const LogSet& logs);

}  // namespace joulepath
