#pragma once

#include "planner/mission/charging.hpp"
#include "planner/ways/mission_ways.hpp"

namespace joulepath {

/// An order of the stops, as the table of leg energies estimates it.
struct OrderEstimate {
  VisitOrder visit{};
  double free_cost_J{};  ///< energy, and time at its price, were there no windows
  bool late{};           ///< by more than the table's routes are rough
};

/// Orders of the stops in the order in which they are planned: the one of least energy (and time at its
/// price) within the windows, then others, clearly late ones last. Energies are those of the inner profile
/// solve between every two stops, at three payloads, interpolated between them; each stop's dwell costs
/// standby. A drop comes after the picks listed before it and unloads its own payload, or all of it. The
/// capacity is the robot's max_payload_kg; windows bound the arrival, and an early robot waits. One entry
/// with the verdict where no order is possible whatever its windows.
///
/// The first is exact by label setting over subsets up to kExactStops; above, the best `kBeam` labels of each
/// layer are kept. Up to kAllOrders stops the others are all of them, above only those that the table does
/// not call worse in everything. Legs are costed with free departure headings and on rough routes.
[[nodiscard]] std::vector<OrderEstimate> order_visits(const ChoiceContext& context);

/// Plans the stops in the cheapest order that can be driven. Without windows that is the first one that can
/// be. With windows every order is planned (kPlannedOrders at most) that the table does not call dearer, by
/// more than it errs, than one that is planned already. Where none can be driven, the plan that is least late
/// is the verdict. `price_W`: the mission's price of a second.
[[nodiscard]] Plan plan_visits(const MissionRequest& asked, std::vector<OrderEstimate> orders, double price_W,
                               const PlanLegs& plan_legs);

}  // namespace joulepath
