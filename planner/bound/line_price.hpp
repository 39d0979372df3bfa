#pragma once

#include <algorithm>
#include <vector>

#include "planner/bound/least_rate.hpp"

// Method: [Vinter1993]
namespace joulepath {

/// The costate p of the cheapest straight line of a length, from rest to rest, at nodes of its arc length:
///   p = phi'/(2 u),   phi'(u) = max over a > 0 of (e u - L(u, a))/a before the peak of speed,
///                     phi'(u) = min over a < 0 of (L(u, a) - e u)/|a| after it,
/// where e is the price of a meter at which both ramps fit. Any p gives a valid bound; this one is nearly the
/// best on a straight line.
struct LinePrice {
  std::vector<double> s_m{};  ///< 0 to the length
  std::vector<double> p{};    ///< linear between the nodes
  std::size_t peak{};         ///< the piece from this node on has p constant and may be longer
  double length_m() const { return s_m.back(); }
};

[[nodiscard]] LinePrice line_price(const PowerForm& form, double length_m, double time_W);

/// The price at a place of a line's piece; the speed is that which limits of acceleration let a robot reach.
[[nodiscard]] MotionPrice price_on(const LinePrice& line, std::size_t piece, bool at_end,
                                   const PowerForm& form);

/// The credits of a turning robot on each piece. They may fall, but not rise: chosen for the greatest mean of
/// the rates at prices of a radian of heading up to the peak and after it.
[[nodiscard]] std::vector<TurnCredit> falling_credits(const PowerForm& form, const LinePrice& line,
                                                      double time_W, const std::vector<double>& before_J,
                                                      const std::vector<double>& after_J);

/// A lower bound of every motion from rest to rest whose way is at least as long as a line, whatever its
/// path, its turns in place and its changes of direction.
struct LineBound {
  double length_m{};
  double energy_J{};  ///< price of time included
  double per_m_J{};   ///< of each further meter, >= 0
  double at(double way_m) const { return std::max(0.0, energy_J + per_m_J * (way_m - length_m)); }
};
[[nodiscard]] LineBound line_bound(const PowerForm& form, double length_m, double time_W);

/// The length (m) from which on a straight line is driven at its cheapest speed in the middle.
[[nodiscard]] double long_line_m(const PowerForm& form, double time_W);

}  // namespace joulepath
