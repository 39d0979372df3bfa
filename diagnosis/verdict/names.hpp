#pragma once

#include "diagnosis/values/diagnosis.hpp"
#include "diagnosis/verdict/examination.hpp"

namespace joulepath {

/// The effects with sufficient evidence, before any test of them.
struct Names {
  std::vector<ActiveEffect> named{};
  std::map<std::string, double> probabilities{};  ///< of effects by label
  double surest{1.0};  ///< share of sure names that were right on development cases: none is stated surer
  std::map<std::string, std::vector<std::string>> stand_ins{};  ///< by label: indistinguishable ones
  std::vector<std::string> notes{};
};

/// The best set's effects, without those that may only compensate the inexact form of a greater one.
[[nodiscard]] Names choose_names(const Examination& examination);

/// Effects by probability, the dozen likeliest.
[[nodiscard]] std::vector<RankedEffect> rank_effects(const std::map<std::string, double>& probabilities,
                                                     double surest = 1.0);

[[nodiscard]] double probability_of(const Names& names, const ActiveEffect& effect);

/// Share of the best set's gain in loss that is lost when one of its effects is left out.
[[nodiscard]] double gain_share_of(const Examination& examination, const std::string& label);

}  // namespace joulepath
