#pragma once

#include "diagnosis/signals/log_set.hpp"

namespace joulepath {

/// What the windings tell of wheel speeds that are late.
struct LateSpeeds {
  double filter_s{};  ///< time constant of a first-order filter that explains them; 0: none is told
  bool undecided{};   ///< no winding tells a filter from a delay, or both explain them about as well
};

/// V = a + b i + c q with the wheel speed q. Behind a filter of the time constant T, q is the logged speed
/// plus T times its slope; behind a delay it is the logged speed of a later time. The two differ in the
/// second order of the time. A clock offset beside a filter is told where it exceeds half a sample: by so
/// much a filter that is computed at the samples differs from one in continuous time. `delay_s` is that of
/// the electrical channels when a delay alone explains the speeds, as of rough_channel_delay_s(): negative.
[[nodiscard]] LateSpeeds examine_late_speeds(const LogSet& logs, double delay_s);

}  // namespace joulepath
