#pragma once

#include "planner/controller/controlled_drive.hpp"
#include "planner/path/floor/occupancy_grid.hpp"

namespace joulepath {

/// A speed mask (kind absolute, base 0) about a plan's path: a cell that the path crosses caps the speed at
/// the plan's highest speed in it, over all passes, times `scale`, rounded down to the mask's hundredths but
/// never to nothing; cells within `reach_m` take the cap of the nearest one. Elsewhere there is no cap.
///
/// A cell that the path clips by less than a twentieth of its side counts as beside it. A mask knows neither
/// legs nor payload, and turns in place are none of its business.
[[nodiscard]] SpeedMask planned_speed_mask(const Plan& plan, double resolution_m, double reach_m,
                                           double scale);

/// The mask's caps on a stretch.
[[nodiscard]] std::vector<SpeedCap> caps_on(const SpeedMask& mask, const StretchPlan& stretch);

}  // namespace joulepath
