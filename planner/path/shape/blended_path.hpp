#pragma once

#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/geometry/path.hpp"
#include "planner/path/geometry/polygon_distance.hpp"

namespace joulepath {

/// How corners of a polyline are driven.
struct CornerPolicy {
  enum class Kind {
    stop_turn_go,  ///< stop, turn in place, go
    blend_radius,  ///< a blend of this smallest radius, or of the largest free radius below it
    largest_blend  ///< as blend_radius with `kLargestRadius_m`
  };
  static constexpr double kLargestRadius_m = 2.0;

  Kind kind{Kind::largest_blend};
  double radius_m{0.5};  ///< blend_radius only
};

/// The result at a corner.
struct CornerReport {
  double x_m{};
  double y_m{};
  double angle_rad{};
  double radius_m{};  ///< smallest radius of its blend; 0: turn in place
};

struct SmoothPath {
  Path path{};
  std::vector<CornerReport> corners{};
  std::vector<Point2> polyline_m{};  ///< the polyline before any vertex was moved
};

/// Rounds the corners of a polyline into a curve with continuous curvature, as far as the clearance allows.
///
/// Each corner gets the largest radius of a descending series at which the straight parts and the blends
/// around it are free. If its inside is blocked, the vertex is moved outwards by up to the blend's deviation.
/// A corner without a free blend becomes a turn in place. The straight parts stay exactly straight. The path
/// starts and ends with the headings of the polyline. The sweep of turns in place is not checked here.
[[nodiscard]] SmoothPath blend_corners(const std::vector<Point2>& polyline_m, const FootprintChecker& checker,
                                       const CornerPolicy& policy);

}  // namespace joulepath
