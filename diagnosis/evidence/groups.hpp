#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/attribution.hpp"

namespace joulepath {

/// Marginal probabilities of effects (by label, side included) and unknown terms of being among the causes:
/// the weight of all explanations with them. Scores are flattened as calibrated on development cases.
class Inclusion {
 public:
  /// Takes in the explanations of one choice of runs; the weights of all choices add up to 1.
  void add(const Equations& equations, const std::vector<Explanation>& explanations, double weight = 1.0);

  /// Of at least one of some labels: each set is counted once.
  [[nodiscard]] double of_any(const std::set<std::string>& labels) const;
  [[nodiscard]] double of(const std::string& label) const { return of_any({label}); }
  [[nodiscard]] std::map<std::string, double> of_each() const;
  /// Of any unknown term, or of any effect that is large enough to matter.
  [[nodiscard]] double of_something() const;

 private:
  struct WeightedSet {
    std::set<std::string> labels{};
    double weight{};
    bool matters{};  ///< holds an unknown term, or an effect that is large enough to matter
  };
  std::vector<WeightedSet> sets_{};
};

/// Log evidence of the best explanation beyond the best one without an effect.
[[nodiscard]] double evidence_for(const Equations& equations, const std::vector<Explanation>& explanations,
                                  const std::string& label);

/// An effect that could stand in for a named one, the rest kept.
struct StandIn {
  std::string label{};
  double loss_more{};  ///< of the data, beyond the named effect's: -2 log of the likelihood ratio
};

/// Likelihood of a stand-in over that of the named effect. One that fits better as the textbook has it is no
/// likelier than the one named, which won with inexact forms.
[[nodiscard]] double likelihood_over_named(const StandIn& other);

/// Effects that could replace one effect of the best explanation with nearly the same likelihood, whatever
/// their typical sizes, with amplitudes that the catalog accepts. Laws are compared without their forms,
/// which would favor the best explanation.
[[nodiscard]] std::vector<StandIn> stand_ins(const LinearProblem& problem, const Equations& equations,
                                             const std::vector<Explanation>& explanations, int candidate,
                                             double dispersion, const Robot& robot);

/// Up to kMostLikelyRivals effects in the place of one of the best explanation, the likeliest first, until
/// they, the effect and its stand-ins together are as likely as a name must be; none where they never are.
/// Runs that favour one law or another by turns are ambiguous.
[[nodiscard]] std::vector<StandIn> likely_rivals(const Equations& equations,
                                                 const std::vector<Explanation>& explanations, int candidate,
                                                 const Inclusion& inclusion,
                                                 const std::vector<StandIn>& stand_ins);

/// The combination of two candidates' amplitudes that the data determine, neither alone: "a + k b = c".
[[nodiscard]] std::string pinned_combination(const LinearProblem& problem, const Equations& equations,
                                             const Explanation& best, const std::string& label,
                                             const std::string& other, double dispersion);

}  // namespace joulepath
