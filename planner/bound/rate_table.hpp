#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "planner/bound/line_price.hpp"

namespace joulepath {

/// Least rates (J/m) at equally spaced prices of a radian of heading, from -most_J to most_J. The rate is
/// concave in the price, so that a chord lies below it.
struct HeadingRates {
  double most_J{};
  Eigen::ArrayXd at{};

  double step_J() const { return 2 * most_J / static_cast<double>(at.size() - 1); }
  double free() const { return at[(at.size() - 1) / 2]; }
  /// `per_rad_J` within the limits.
  double operator()(double per_rad_J) const;
};

/// What each meter of a line takes at least, certified, at both ends of its pieces, at the same prices;
/// between them the rate is concave. The piece at the peak of speed and each further meter take `middle`.
struct RateTable {
  LinePrice line{};
  std::vector<std::array<HeadingRates, 2>> pieces{};
  HeadingRates middle{};
  bool reverse{};  ///< the robot may drive backward
  bool bounded{};  ///< every rate has a certified bound
};

/// The table is valid for all ends, and sharpest where the headings at the named ends are given.
[[nodiscard]] RateTable rate_table(const PowerForm& form, double length_m, double time_W, bool start_given,
                                   bool goal_given);

}  // namespace joulepath
