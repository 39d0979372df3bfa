#pragma once

#include <random>

#include "benchmarks/ways/cma_es.hpp"
#include "benchmarks/ways/poses.hpp"
#include "planner/path/shape/free_spline.hpp"

namespace joulepath::ways {

/// How much is tried, per number of spans.
struct SearchSize {
  int samples{150};      ///< random splines, each judged once
  int descents{4};       ///< of the cheapest of them by CMA-ES
  int evaluations{400};  ///< of each descent
  int refinements{300};  ///< of each descent's end by Nelder-Mead
};

/// The cheapest spline found, and what driving it takes on a fine grid; infinite: none was free.
struct BestSpline {
  FreeSpline spline{};
  double energy_J{};
  int evaluations{};
};

/// A search of its own for the cheapest path without a turn in place: C2 cubic splines of one to four spans
/// with random knots, handles and goal headings; CMA-ES from the best, then Nelder-Mead. Shares the planner's
/// spline, collision check and profile solver (the evaluator), none of its guesses.
[[nodiscard]] BestSpline brute_force(const World& world, const Problem& problem, std::mt19937& random,
                                     const SearchSize& size);

/// "start handle, goal handle, goal heading, x, y of each knot" as one field of a CSV file, and back.
[[nodiscard]] std::string spline_text(const FreeSpline& spline);
[[nodiscard]] FreeSpline spline_from(const std::string& text, const Problem& problem);

}  // namespace joulepath::ways
