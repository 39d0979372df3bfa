#pragma once

#include <vector>

#include "planner/motion/path_motion.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath::nlp {

/// Places where the law of a segment may change: ends and breakpoints of the piece, borders of speed caps,
/// and jumps of the torque at rest (a wheel reverses, the turn changes its side, the floor changes).
[[nodiscard]] std::vector<double> mandatory_nodes(const PathMotion& motion, const ProfileRequest& request);

/// A rough speed profile that shapes the grid: the square root of the speed square that a constant
/// acceleration allows from both ends, under the bounds on the rate.
[[nodiscard]] double reference_rate(const ProfileRequest& request, double length, double s, double cap);

/// About `count` nodes, denser where the reference rate is low (equal times between nodes), where
/// curvature is large or changes, and at rest ends; the mandatory nodes among them.
[[nodiscard]] std::vector<double> make_grid(const PathMotion& motion, const ProfileRequest& request,
                                            std::size_t count);

/// The grid with segments cut in equal parts if their excess (of cost or time) is above the allowed excess; a
/// segment that contains some of `places` is cut there instead.
[[nodiscard]] std::vector<double> cut_by_excess(const std::vector<double>& s,
                                                const std::vector<double>& excess, double allowed,
                                                const std::vector<double>& places = {});

/// The grid with every marked segment cut in two.
[[nodiscard]] std::vector<double> cut_segments(const std::vector<double>& s, const std::vector<bool>& cut);

}  // namespace joulepath::nlp
