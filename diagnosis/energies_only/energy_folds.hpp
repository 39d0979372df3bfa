#pragma once

#include "diagnosis/energies_only/energy_fit.hpp"
#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Runs (indices into EnergyProblem::runs) that fit, and those that only judge.
struct EnergyFold {
  std::vector<std::size_t> fitted{};
  std::vector<std::size_t> judged{};
};

/// One fold where the dataset says `use: validation`; else four, each run judging once, spread over kinds of
/// path, payloads and accelerations. Depends on what is in the runs, not on their order.
[[nodiscard]] std::vector<EnergyFold> energy_folds(const Dataset& dataset,
                                                   const std::vector<EnergyRun>& runs);

/// Gaps (J) of judged runs under models fitted without them, run by run.
struct HeldOutGaps {
  std::vector<std::size_t> runs{};
  std::vector<double> before_J{};  ///< the robot file
  std::vector<double> after_J{};
  std::vector<double> measured_J{};

  double sum_before_J() const;  ///< of absolute values
  double sum_after_J() const;
};

/// Each fold chooses its own effects.
[[nodiscard]] HeldOutGaps held_out_gaps(const EnergyProblem& problem, const std::vector<EnergyFold>& folds);

/// Each fold fits the given effects.
[[nodiscard]] HeldOutGaps held_out_gaps(const EnergyProblem& problem, const std::vector<EnergyFold>& folds,
                                        const std::vector<Candidate>& effects);

/// Each fold fits a smooth function of the runs' circumstances in place of a cause.
[[nodiscard]] HeldOutGaps smooth_held_out_gaps(const EnergyProblem& problem,
                                               const std::vector<EnergyFold>& folds);

}  // namespace joulepath
