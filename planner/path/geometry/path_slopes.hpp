#pragma once

#include <vector>

namespace joulepath {

/// Derivatives of a path's cost by what the path is at one place.
struct PlaceSlope {
  double s_m{};
  double by_curvature{};
  double by_curvature_slope{};
  double by_x_m{}, by_y_m{}, by_heading_rad{};  ///< by the pose
};

/// Derivative of a path's cost by the length between two places.
struct LengthSlope {
  double from_m{}, to_m{};
  double by_length{};
};

/// The derivatives of the cost of a path of one curve, by everything that changes with its shape.
struct PathSlopes {
  std::vector<PlaceSlope> places{};
  std::vector<LengthSlope> lengths{};
};

}  // namespace joulepath
