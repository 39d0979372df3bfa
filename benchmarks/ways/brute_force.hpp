#pragma once

#include <random>

#include "benchmarks/ways/cma_es.hpp"
#include "benchmarks/ways/poses.hpp"
#include "benchmarks/ways/free_spline.hpp"

namespace joulepath::ways {

/// Size of the search, per number of spans.
struct SearchSize {
  int samples{150};      ///< random splines, each evaluated once
  int descents{4};       ///< descents by CMA-ES from the cheapest of them
  int evaluations{400};  ///< of each descent
  int refinements{300};  ///< of Nelder-Mead at the end of each descent
};

/// The cheapest spline found and its energy on a fine grid; infinite: no free spline.
struct BestSpline {
  FreeSpline spline{};
  double energy_J{};
  int evaluations{};
};

/// Independent search for the cheapest path without a turn in place: C2 cubic splines of one to four spans
/// with random knots, handles and goal headings; CMA-ES from the best, then Nelder-Mead. It shares the
/// spline, the collision check and the profile solver (the evaluator) with the planner, but none of its
/// guesses. `known`: splines that descents start from too.
[[nodiscard]] BestSpline brute_force(const World& world, const Problem& problem, std::mt19937& random,
                                     const SearchSize& size, const std::vector<FreeSpline>& known = {});

/// "start handle, goal handle, goal heading, x, y of each knot" as one field of a CSV file, and back.
[[nodiscard]] std::string spline_text(const FreeSpline& spline);
[[nodiscard]] FreeSpline spline_from(const std::string& text, const Problem& problem);

}  // namespace joulepath::ways
