#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "diagnosis/evidence/linear_fit.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {

/// One set of effects as an explanation, with its evidence.
struct Explanation {
  std::vector<int> candidates{};  ///< of the equations, in order of index
  std::vector<int> unknowns{};    ///< unknown terms of the equations, in order of index
  std::vector<int> columns{};
  Eigen::VectorXd mean{};  ///< of `columns`, calibration projected out
  double score{};          ///< log evidence and log prior, relative to "nothing"
  double loss{};
  std::vector<double> size{};  ///< of each candidate, in just material amplitudes
  std::vector<int> small{};    ///< candidates below the materiality floor and not beyond doubt

  /// Whether it holds a candidate that may be named.
  bool has_material() const { return small.size() < candidates.size(); }
};

struct SearchOptions {
  int most_effects{kMostEffects};
  std::vector<int> allowed{};      ///< candidates that may enter; empty = all
  int most_members{kMostMembers};  ///< effects and unknown terms
  double dispersion{1.0};
  std::vector<double> least_amplitude{};  ///< of each candidate, to be material; empty = any
  /// Log evidence needed to name an effect below the materiality floor. Infinite: none counts as material.
  double small_effect_evidence{std::numeric_limits<double>::infinity()};
  /// The same for pliable effects at just material size; grows as 1/sqrt(size).
  double small_pliable_evidence{std::numeric_limits<double>::infinity()};
  std::vector<double> cost_of_unknown{};  ///< log odds against each; the search sets them
};

/// What log evidence is worth for an effect of a size below the materiality floor. Noise averages out over the
/// runs, the model's own error does not: in ln LR = a^2/(2 s^2) the variance s^2 of the amplitude has a part
/// kModelError^2 that no further run makes smaller, so the evidence ends at size^2/(2 kModelError^2).
[[nodiscard]] double evidence_beyond_model_error(double evidence, double size);

/// Options of a search on this many runs. Of effects below the materiality floor few runs name firm ones
/// alone.
[[nodiscard]] SearchOptions search_options(double dispersion, std::size_t runs,
                                           std::vector<double> least_amplitude);

/// How far an effect of an explanation may be the others' inexact form, 0 to 1: the part of its
/// signature that they reproduce with strengths free to vary as their forms allow. Near 0 where they act on
/// other channels or at other times.
[[nodiscard]] double ghost_share(const LinearProblem& problem, const Equations& equations,
                                 const Explanation& explanation, int candidate);

/// Search over sets of candidates and unknown terms with the calibration projected out: every pair, then
/// forward from the best sets of each size. Returns every evaluated set once, best first, the empty set with
/// score 0 among them.
[[nodiscard]] std::vector<Explanation> search_explanations(const LinearProblem& problem,
                                                           const Equations& equations,
                                                           const SearchOptions& options);

/// The member of the set of all candidates and unknown terms whose own evidence beside the others lies
/// furthest below what it takes to name it at its size.
[[nodiscard]] std::optional<int> weakest_member(const LinearProblem& problem, const Equations& equations,
                                                const SearchOptions& options);

/// Erases the sets that cannot be an answer: those with a small effect. Where the best set holds an effect
/// that may be named beside it, sets like it stay: a worse set would name what explains less.
void erase_immaterial(std::vector<Explanation>& explanations);

/// Gives each unknown term the prior width at which it explains most beside the given columns: nobody knows
/// how large an unknown cause is.
void scale_unknowns(Equations& equations, LinearProblem& problem, const std::vector<int>& known,
                    double dispersion);

}  // namespace joulepath
