#pragma once

#include <vector>

#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/solution.hpp"
#include "planner/profile/place_cost.hpp"
#include "planner/values/profile.hpp"

// Method: [Pontryagin1962]
namespace joulepath {

/// The price of the square of the rate along a path, p(s) = psi/(2 u) with psi linear in the profile's time
/// on each segment, u the profile's rate (p itself has a pole where the robot rests). It may jump at nodes.
struct Costate {
  std::vector<double> psi_start{}, psi_end{};  ///< per segment
  std::vector<double> jump{};                  ///< of p, per node; 0 at both ends
  double of_rate{};  ///< share of psi that is a price of the rate itself, the same along the whole path
};

/// The costate of a discrete solution's multipliers: with l_k a segment's part of the Lagrangian,
///   p(s_k+) = -d l_k / d b_k,   p(s_{k+1}-) = d l_k / d b_{k+1}.
/// Where a cap holds the rate on neighboring nodes, the steps between their segments are distributed over
/// them.
/// At rest H = psi a.
///
/// A part of psi may price u in place of u^2, as d(c u)/ds = c a/u. With c the slope of H in a at rest,
/// the copper loss of friction's current counts as a price of time if there is no other price; `priced_rate`
/// enables it.
[[nodiscard]] Costate costate_of(const nlp::Problem& problem, const nlp::Solution& solution,
                                 const Profile& profile, const CostModel& model, bool priced_rate = false);

}  // namespace joulepath
