#pragma once

#include "planner/controller/controlled_drive.hpp"
#include "planner/path/floor/occupancy_grid.hpp"

namespace joulepath {

/// A speed mask (kind absolute, base 0) along a plan's path. A cell that the path crosses caps the speed at
/// the plan's highest speed in it, over all passes, times `scale`, rounded up to the mask's hundredths, so
/// that a controller need not be late. Cells within `reach_m` take the cap of the nearest crossed cell.
/// Elsewhere there is no cap.
///
/// A cell that the path crosses by less than a twentieth of its side counts as not crossed. A mask depends on
/// neither leg nor payload, and does not affect turns in place.
[[nodiscard]] SpeedMask planned_speed_mask(const Plan& plan, double resolution_m, double reach_m,
                                           double scale);

/// The mask's caps on a stretch.
[[nodiscard]] std::vector<SpeedCap> caps_on(const SpeedMask& mask, const StretchPlan& stretch);

}  // namespace joulepath
