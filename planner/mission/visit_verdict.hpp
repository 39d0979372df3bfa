#pragma once

#include "planner/mission/visit_search.hpp"

namespace joulepath {

/// Why no order of the stops is possible: the first constraint without which there would be one.
[[nodiscard]] Infeasibility no_order(const MissionRequest& mission, const Robot& robot,
                                     const VisitSearch& search);

}  // namespace joulepath
