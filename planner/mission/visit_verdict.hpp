#pragma once

#include "planner/mission/visit_search.hpp"

namespace joulepath {

/// The verdict if no order of the stops is possible: the first constraint whose removal allows one.
[[nodiscard]] Infeasibility no_order(const MissionRequest& mission, const Robot& robot,
                                     const VisitSearch& search);

}  // namespace joulepath
