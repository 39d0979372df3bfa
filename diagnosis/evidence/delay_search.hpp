#pragma once

#include "diagnosis/evidence/refit.hpp"

namespace joulepath {

/// A first estimate of how late the electrical channels are, to the log's sample: the shift at which
/// the windings' equation V - R i = Kv n q' holds best. Needs voltages and currents.
/// Far from zero a delay is not linear, and looks like inertia, resistance and friction at once. 0
/// unless the shift explains notably more than none.
[[nodiscard]] double rough_channel_delay_s(const LogSet& logs);

}  // namespace joulepath
