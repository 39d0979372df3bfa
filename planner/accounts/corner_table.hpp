#pragma once

#include <vector>

#include "model/plant.hpp"

namespace joulepath {

/// Cost of a corner between two straight legs by its angle, in addition to driving their length straight on:
/// planned every 5 degrees, linear between. Up to 5 degrees the robot does not stop.
class CornerTable {
 public:
  struct Cost {
    double energy_J{};
    double time_s{};
  };

  /// `radius_m` of the arc; 0, or where no such arc fits the legs: stop and turn in place.
  CornerTable(const Plant& plant, const Limits& limits, double payload_kg, double radius_m, double leg_m);

  /// Counter-clockwise angles are positive; (-pi, pi].
  [[nodiscard]] Cost at(double angle_rad) const;

 private:
  std::vector<Cost> costs_{};  ///< from -pi to pi
};

}  // namespace joulepath
