#pragma once

#include "diagnosis/verdict/examination.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {

/// A model for the held-out runs. With cross-fitting, each run is held out of the fit that predicts it and
/// has the state of the other folds' runs.
struct JudgedModel {
  std::vector<RunSignals> signals{};  ///< of the held-out runs, at the model's delay
  std::vector<ModelState> states{};   ///< one for each
};

/// Its constants are those of the fit, in their boxes: within_calibration().
[[nodiscard]] JudgedModel judged_model(const Examination& examination, const Refit& fitted);

/// The calibration fitted on the diagnosis runs with the given effects, for the held-out runs.
[[nodiscard]] JudgedModel judged_fit(const Examination& examination,
                                     const std::vector<ActiveEffect>& effects);

/// The state with every calibration error within kCalibrationBox of its uncertainty, and every constant between
/// 1/(1 + box) and 1 + box of the file's: a wide box has no constant without its sign.
[[nodiscard]] ModelState within_calibration(const Examination& examination, ModelState state);

/// The file's robot with a state's constants and physical effects.
[[nodiscard]] Robot corrected_robot(const Examination& examination, const ModelState& state);

[[nodiscard]] ModelPoints points_of(const Examination& examination, const JudgedModel& model);

/// Energies of the held-out runs.
[[nodiscard]] std::vector<RunEnergy> judged_energies(const Examination& examination,
                                                     const JudgedModel& model);

}  // namespace joulepath
