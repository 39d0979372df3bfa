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

  /// `radius_m` of the arc; the largest that fits where legs of `leg_m` are too short for it. 0: stop and
  /// turn in place, as where no arc fits.
  CornerTable(const Plant& plant, const Limits& limits, double payload_kg, double radius_m, double leg_m);

  /// Counter-clockwise angles are positive; (-pi, pi].
  [[nodiscard]] Cost at(double angle_rad) const;

  /// The greatest corner that the arc as asked for fits; pi without arcs.
  double fits_up_to_rad() const { return fits_up_to_rad_; }

 private:
  std::vector<Cost> costs_{};  ///< from -pi to pi
  double fits_up_to_rad_{};
};

}  // namespace joulepath
