#pragma once

#include "planner/mission/charging.hpp"
#include "planner/ways/mission_ways.hpp"

namespace joulepath {

/// Plans the stops of `visit:` in the cheapest order that was found; `plan_legs` plans an order in full. The
/// verdict where no order is possible whatever its windows is in VisitOrder::infeasibility, without a plan.
///
/// A table estimates the cost of orders: energies of the inner profile solve between every two stops, at
/// three payloads, interpolated between them; each stop's dwell costs standby. Legs are estimated with free
/// departure headings and on rough routes. A drop comes after the picks listed before it and unloads its own
/// payload, or all of it. The capacity is the robot's max_payload_kg; windows bound the arrival, and an early
/// robot waits. The cheapest order is exact for the table by label setting over subsets up to kExactStops;
/// above, the best kBeam labels of each layer are kept. Up to kAllOrders stops all orders may be planned,
/// above only those that the table does not call worse in everything.
///
/// Orders are planned in full, the cheapest estimate first, until by the table no other can be cheaper than
/// the best plan. Without windows each plan corrects the table for its legs, and legs that no plan had count
/// as a little cheaper, relative to their estimate, than any planned leg. With windows the table's error of
/// whole orders is allowed for, clearly late ones come last, and where none can be driven, the plan that is
/// least late is the verdict.
[[nodiscard]] Plan plan_visits(const ChoiceContext& context, const PlanLegs& plan_legs);

}  // namespace joulepath
