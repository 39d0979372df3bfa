#pragma once

#include "diagnosis/values/diagnosis.hpp"
#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// How large the causes are over the materiality floor.
struct Sizes {
  double greatest{};                    ///< of the best set's effects and terms
  std::vector<SmallEffect> of_names{};  ///< what is named, as it is listed where it is no gap
};

/// Outcome of the race between the catalog's laws and unknown terms.
struct Names {
  std::vector<ActiveEffect> named{};
  std::vector<UnknownCause> unknowns{};           ///< the greatest share first
  std::vector<SmallEffect> small_unknowns{};      ///< below the materiality floor
  std::map<std::string, double> probabilities{};  ///< of effects by label
  Sizes sizes{};
  double something{};  ///< probability that there is any cause that matters, named or not
  double surest{
      1.0};  ///< the greatest probability that is stated: share of correct names on development cases
  /// By label: those that fit about as well, then those that runs favour by turns.
  std::map<std::string, std::vector<std::string>> stand_ins{};
  std::map<std::string, std::string> inseparable{};  ///< by label: the one that fits best in its place
};

/// The best set's effects and unknown terms whose marginal inclusion is high enough to name them.
[[nodiscard]] Names choose_names(const Examination& examination);

/// The kLongestRanking most probable effects, the most probable first.
[[nodiscard]] std::vector<RankedEffect> rank_effects(const std::map<std::string, double>& probabilities,
                                                     double surest = 1.0);

[[nodiscard]] double probability_of(const Names& names, const ActiveEffect& effect);

}  // namespace joulepath
