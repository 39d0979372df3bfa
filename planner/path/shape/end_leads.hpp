#pragma once

#include <optional>
#include <vector>

#include "planner/path/shape/blended_path.hpp"

namespace joulepath {

/// A straight line along a heading at an end of a route: the route leaves (or reaches) the end with that
/// heading and then bends, without a turn in place.
struct Lead {
  double heading_rad{};
  double length_m{};
};

/// The polyline with leads, its corners rounded; absent if a lead's corner has no room for a blend or the
/// curve is not free.
[[nodiscard]] std::optional<SmoothPath> blend_with_leads(const std::vector<Point2>& polyline_m,
                                                         const std::optional<Lead>& start,
                                                         const std::optional<Lead>& goal,
                                                         const FootprintChecker& checker,
                                                         const CornerPolicy& policy);

/// As blend_with_leads, with several lead lengths: of the free paths the one with the least turning in
/// place, then the shortest.
[[nodiscard]] std::optional<SmoothPath> blend_along_headings(const std::vector<Point2>& polyline_m,
                                                             const std::optional<double>& start_heading_rad,
                                                             const std::optional<double>& goal_heading_rad,
                                                             const FootprintChecker& checker,
                                                             const CornerPolicy& policy);

}  // namespace joulepath
