#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/attribution.hpp"

namespace joulepath {

/// Probability of each effect (by label, side included) of being among the causes, from the scores of all
/// explanations, flattened as calibrated on development cases.
[[nodiscard]] std::map<std::string, double> effect_probabilities(
    const Equations& equations, const std::vector<Explanation>& explanations);

/// Probability that at least one of some effects (labels) is among the causes: the weight of all sets that
/// contain any of them, each set counted once.
[[nodiscard]] double probability_of_any(const Equations& equations,
                                        const std::vector<Explanation>& explanations,
                                        const std::set<std::string>& labels);

/// An effect that could stand in for a named one, the rest kept.
struct StandIn {
  std::string label{};
  double loss_more{};  ///< of the data, beyond the named effect's: -2 log of the likelihood ratio
};

/// Effects that could stand in for one of the best explanation with nearly the same likelihood, whatever
/// their typical sizes. Laws are compared without the room that forms give the best one.
[[nodiscard]] std::vector<StandIn> stand_ins(const LinearProblem& problem, const Equations& equations,
                                             const std::vector<Explanation>& explanations, int candidate,
                                             double dispersion);

/// The combination of two candidates' amplitudes that the data determine, neither alone: "a + k b = c".
[[nodiscard]] std::string pinned_combination(const LinearProblem& problem, const Equations& equations,
                                             const Explanation& best, const std::string& label,
                                             const std::string& other, double dispersion);

}  // namespace joulepath
