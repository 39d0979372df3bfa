#pragma once

#include <vector>

#include "planner/path/search/search.hpp"

namespace joulepath {

/// A travel cost looked up by place and heading, filled on demand: searches query the same places a
/// million times, and a rate may take a microsecond. It is constant over cells of 0.25 m and 22.5 degrees,
/// which is fine for finding a way; what a way costs is scored with the exact rate. For one thread.
class RateTable {
 public:
  RateTable(const TravelCost& exact, const ObstacleField::Extent& extent);
  RateTable(const RateTable&) = delete;
  RateTable& operator=(const RateTable&) = delete;

  /// Refers to this table, which must outlive it; without a rate it is the exact cost itself.
  [[nodiscard]] TravelCost cost();

 private:
  double rate(double x_m, double y_m, double heading_rad);

  const TravelCost& exact_;
  ObstacleField::Extent extent_{};
  int columns_{}, rows_{};
  std::vector<float> rates_{};  ///< negative: not asked yet
};

}  // namespace joulepath
