#pragma once

#include "planner/mission/visit_search.hpp"

namespace joulepath {

/// The verdict on the window of a stop (an index into `visit`) that so many planned orders miss, the best by
/// late_s.
[[nodiscard]] Infeasibility missed_window(const MissionRequest& mission, std::size_t visit, double late_s,
                                          int planned_orders);

/// The verdict if no order of the stops is possible whatever their windows.
[[nodiscard]] Infeasibility no_order(const MissionRequest& mission, const Robot& robot,
                                     const VisitSearch& search);

}  // namespace joulepath
