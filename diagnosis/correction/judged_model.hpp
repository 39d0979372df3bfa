#pragma once

#include "diagnosis/verdict/examination.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {

/// A model as the judging runs meet it: where runs take turns, each run meets a fit of the other folds' runs.
struct JudgedModel {
  std::vector<RunSignals> signals{};  ///< of the judging runs, at the model's delay
  std::vector<ModelState> states{};   ///< one for each
};

[[nodiscard]] JudgedModel judged_model(const Examination& examination, const Refit& fitted);

/// The calibration fitted on the diagnosis runs with the given effects, as the judging runs meet it.
[[nodiscard]] JudgedModel judged_fit(const Examination& examination,
                                     const std::vector<ActiveEffect>& effects);

[[nodiscard]] ModelPoints points_of(const Examination& examination, const JudgedModel& model);

/// Energies of the judging runs.
[[nodiscard]] std::vector<RunEnergy> judged_energies(const Examination& examination,
                                                     const JudgedModel& model);

}  // namespace joulepath
