#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/refit.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// Result of the search on the diagnosis runs: the converged state, and every explanation that was
/// compared about it.
struct Identification {
  std::vector<Nuisance> nuisances{};
  ModelState state{};                       ///< of the best explanation
  std::vector<RunSignals> signals{};        ///< read at the state's delay
  Equations equations{};                    ///< whole catalog and dictionary, about the state
  LinearProblem problem{};                  ///< of all runs, with the calibration projected out
  SearchOptions options{};                  ///< of the search
  std::vector<Explanation> explanations{};  ///< best first
  std::vector<SmallEffect> below_materiality{};
  double dispersion{1.0};
};

/// Searches for the effects behind a gap: linearize, weigh sets of effects, take the best over, refit by
/// Gauss-Newton, and linearize again about it until the set stays the same. About the nominal model a curve
/// of an unknown cause bends where a strong law cannot: before a curve is the answer, the best single law
/// gets the same rounds, and what it leads to is the answer if they settle on laws alone. `without`:
/// effects that the catalog is taken to lack.
[[nodiscard]] Identification identify(const LogSet& logs, const std::set<std::string>& without = {});

/// Labels of an explanation's unknown terms.
[[nodiscard]] std::set<std::string> unknown_labels(const Equations& equations,
                                                   const Explanation& explanation);

/// Energy (J) of the motors that an effect of a state is responsible for, summed without sign over the runs.
[[nodiscard]] double energy_of_effect_J(const std::vector<RunSignals>& signals, const Robot& robot,
                                        const std::vector<Nuisance>& nuisances, const ModelState& state,
                                        std::size_t effect);

}  // namespace joulepath
