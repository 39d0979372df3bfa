#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/refit.hpp"

namespace joulepath {

/// With fewer diagnosis runs noise and scatter are known too little to be sure, and what hardly matters
/// needs more evidence.
inline constexpr std::size_t kRunsForSmallEffects = 8;

/// What the diagnosis runs say about the cause: the converged state, and every explanation that was
/// weighed about it.
struct Identification {
  std::vector<Nuisance> nuisances{};
  ModelState state{};                       ///< of the best explanation
  std::vector<RunSignals> signals{};        ///< read at the state's delay
  Equations equations{};                    ///< whole catalog and dictionary, about the state
  LinearProblem problem{};                  ///< of all runs, with the calibration projected out
  std::vector<Explanation> explanations{};  ///< best first
  double dispersion{1.0};
};

struct IdentifyOptions {
  double effect_cost{6.0};
  double further_effect_cost{14.0};
  double small_effect_evidence{10.0};              ///< names what hardly matters, and
  double small_effect_evidence_of_few_runs{20.0};  ///< the same from fewer than kRunsForSmallEffects
  double small_pliable_evidence{13.0};             ///< as SearchOptions has it; never from few runs
  int most_effects{4};
  int rounds{4};
  std::set<std::string> without{};  ///< effects that the catalog is taken to lack
};

/// Searches for the effects behind a gap: linearize, weigh sets of effects, take the best over, refit by
/// Gauss-Newton, and linearize again about it until the set stays the same.
[[nodiscard]] Identification identify(const LogSet& logs, const IdentifyOptions& options = {});

/// Energy (J) that an effect of a state is responsible for, summed without sign over the runs, and the
/// sum of what the model predicts.
struct EnergyShare {
  double effect_J{};
  double total_J{};
};
[[nodiscard]] EnergyShare energy_of_effect(const std::vector<RunSignals>& signals, const Robot& robot,
                                           const std::vector<Nuisance>& nuisances, const ModelState& state,
                                           std::size_t effect);

}  // namespace joulepath
