#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/attribution.hpp"

namespace joulepath {

/// Probability of each effect (by label, side included) of being among the causes, from the scores of all
/// explanations, flattened as calibration on development cases asks.
[[nodiscard]] std::map<std::string, double> effect_probabilities(
    const Equations& equations, const std::vector<Explanation>& explanations);

/// Labels that could stand in for one effect of the best explanation: the rest kept, the data hardly mind.
[[nodiscard]] std::vector<std::string> stand_ins(const Equations& equations,
                                                 const std::vector<Explanation>& explanations, int candidate);

/// The combination of two candidates' amplitudes that the data pin although neither is: "a + k b = c".
[[nodiscard]] std::string pinned_combination(const LinearProblem& problem, const Equations& equations,
                                             const Explanation& best, const std::string& label,
                                             const std::string& other, double dispersion);

inline constexpr double kStandInLogOdds = 4.0;
inline constexpr double kScoreFlattening = 0.7;  ///< log evidence of real data is worth less than its face

}  // namespace joulepath
