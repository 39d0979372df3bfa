#pragma once

#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/solution.hpp"

namespace joulepath::nlp {

/// A bound from below on what any profile on this grid costs.
struct Certificate {
  double objective{};    ///< of the solution
  double lower_bound{};  ///< no feasible b on this grid does better, see `convex`
  bool convex{};         ///< every segment's Lagrangian has a positive semidefinite Hessian wherever sampled
};

/// The Lagrangian's dual bound at a solution's multipliers.
///
///   L(b) = sum l_k(b_k, b_{k+1});   min over the box >= L(b*) + min over the box of grad L(b*) (b - b*)
///
/// holds where every l_k is convex on the box 0 <= b <= fastest; that is sampled on a grid of (b_k, b_{k+1})
/// within the acceleration limits. Where a sampled eigenvalue is negative, the bound is lowered by what
/// that curvature can bring over the box, and `convex` is false.
///
/// Copper loss has a part c (sqrt(b_{k+1}) - sqrt(b_k)), which is not convex but telescopes: where it is in
/// the way it is subtracted from every l_k, with one c for all, and added as the constant that it sums up to.
[[nodiscard]] Certificate certify(const Problem& problem, const Solution& solution,
                                  const std::vector<double>& fastest);

}  // namespace joulepath::nlp
