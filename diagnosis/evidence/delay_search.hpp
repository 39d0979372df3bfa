#pragma once

#include "diagnosis/evidence/refit.hpp"

namespace joulepath {

/// First estimate of the delay of the electrical channels, to one sample of the log: the shift at which the
/// winding equation V - R i = Kv n q' holds best, with any constants and in units of what each channel's
/// noise leaves in it. Needs voltages and currents. A long delay is not linear and imitates inertia,
/// resistance and friction together, so the search needs this start. 0 unless the shift explains notably more
/// than no shift.
[[nodiscard]] double rough_channel_delay_s(const LogSet& logs);

}  // namespace joulepath
