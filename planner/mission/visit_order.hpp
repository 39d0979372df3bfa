#pragma once

#include "planner/ways/mission_ways.hpp"

namespace joulepath {

/// The order of stops of least energy (and time at its price) first, then others to plan where windows make
/// the first one impossible. Energies are those of the inner profile solve between every two stops, at three
/// payloads, interpolated between them; each stop's dwell costs standby. A drop comes after the picks listed
/// before it and unloads its own payload, or all of it. The capacity is the robot's max_payload_kg; windows
/// bound the arrival, and an early robot waits.
///
/// Exact by label setting over subsets up to kExactStops; above, the best `kBeam` labels of each layer are
/// kept. Legs are costed with free departure headings; the plan itself is made leg by leg, exactly.
///
/// Routes of the table are rough: an order that misses a window there is returned after those that keep all
/// of them, and the exact plan decides.
[[nodiscard]] std::vector<VisitOrder> order_visits(const ChoiceContext& context);

}  // namespace joulepath
