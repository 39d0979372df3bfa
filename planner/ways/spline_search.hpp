#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/shape/free_spline.hpp"
#include "planner/path/shape/spline_slopes.hpp"

// Design: docs/decisions/0211-whole-curves.md
namespace joulepath {

/// A member of one of the splines.
struct SplineMember {
  enum class Kind { start_heading, start_handle, goal_heading, goal_handle, knot };
  Kind kind{};
  std::size_t spline{};
  std::size_t knot{};  ///< index in points_m
};

/// What an optimizer moves: one number (two for a knot) that all its members share.
struct SplineVariable {
  std::vector<SplineMember> members{};
};

/// Splines of consecutive legs that are moved together.
struct SplineSearch {
  const FootprintChecker* checker{};
  std::vector<FreeSpline> first{};
  std::vector<SplineVariable> variables{};
  /// The cost of the paths of all splines, infinite where they cannot be driven.
  std::function<double(const std::vector<Path>&)> cost{};
  /// Derivatives of the last cost, which was finite and that of these splines.
  std::function<std::vector<SplineSlopes>(const std::vector<FreeSpline>&)> slopes{};
  /// The search ends early where its cost falls too slowly for this one.
  double cost_to_beat{kNoLimit};
  int most_evaluations{40};
};

struct SplineSearchResult {
  std::vector<FreeSpline> splines{};
  std::vector<Path> paths{};
  double cost{};
  int evaluations{};
};

/// Minimizes the cost by sequential quadratic programming with its gradient (NLopt, SLSQP): handles by their
/// logarithm, clearance as one inequality per part of a path. The result is free of collisions along its
/// whole length; absent where none was found.
[[nodiscard]] std::optional<SplineSearchResult> minimize(const SplineSearch& search);

}  // namespace joulepath
