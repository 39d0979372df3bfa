#pragma once

#include <vector>

#include "planner/path/search/search.hpp"

namespace joulepath {

/// Travel costs tabulated by place and heading, computed on demand: a search queries the same places a
/// million times, and a rate may take a microsecond. The cost is constant over cells of 0.25 m and 22.5
/// degrees; the search needs no more, and ways are scored with the exact rate. For one thread.
class TabulatedCost {
 public:
  TabulatedCost(const TravelCost& exact, const ObstacleField::Extent& extent);
  TabulatedCost(const TabulatedCost&) = delete;
  TabulatedCost& operator=(const TabulatedCost&) = delete;

  /// A cost that refers to this table, which must outlive it; without a rate it is the exact cost.
  [[nodiscard]] TravelCost cost();

 private:
  double rate(double x_m, double y_m, double heading_rad);

  const TravelCost& exact_;
  ObstacleField::Extent extent_{};
  int columns_{}, rows_{};
  std::vector<float> rates_{};  ///< negative: not computed yet
};

}  // namespace joulepath
