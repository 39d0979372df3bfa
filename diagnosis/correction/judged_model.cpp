#include "diagnosis/correction/judged_model.hpp"

#include <algorithm>

#include "diagnosis/evidence/fitted_model.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {

ModelState within_calibration(const Examination& x, ModelState state) {
  for (std::size_t k = 0; k < x.id.nuisances.size(); ++k) {
    const double most = kCalibrationBox * x.id.nuisances[k].sigma,
                 least = is_factor(x.id.nuisances[k]) ? 1 / (1 + most) - 1 : -most;
    state.nuisance_fraction[k] = std::clamp(state.nuisance_fraction[k], least, most);
  }
  return state;
}

Robot corrected_robot(const Examination& x, const ModelState& state) {
  ModelState constants = state;
  constants.effects.clear();
  Robot robot = x.point_of(constants).robot;
  for (const ActiveEffect& effect : state.effects)
    if (!is_instrument(effect.candidate.shape.name))
      robot.effects.push_back(setting_of(effect.candidate, effect.amplitude, x.dataset.robot));
  return robot;
}

JudgedModel judged_model(const Examination& x, const Refit& fitted) {
  JudgedModel model{
      .signals = x.runs.fold_of.empty() ? read_signals(x.runs.validation, channel_delay_s(fitted.state))
                                        : fitted.signals,
      .states = std::vector<ModelState>(x.runs.validation.runs.size(), within_calibration(x, fitted.state))};
  const std::vector<std::size_t>& fold_of = x.runs.fold_of;
  if (fold_of.empty()) return model;
  for (std::size_t fold = 0; fold < fold_count(x.runs); ++fold) {
    const ModelState state = state_of_runs(fitted, x.id.nuisances, fitted_runs(x.runs, fold));
    for (std::size_t r = 0; r < fold_of.size(); ++r)
      if (fold_of[r] == fold) model.states[r] = within_calibration(x, state);
  }
  return model;
}

JudgedModel judged_fit(const Examination& x, const std::vector<ActiveEffect>& effects) {
  return judged_model(x, fit_effects(x.runs.diagnosis, x.id, effects));
}

ModelPoints points_of(const Examination& x, const JudgedModel& model) {
  ModelPoints points;
  for (const ModelState& state : model.states) points.push_back(x.point_of(state));
  return points;
}

std::vector<RunEnergy> judged_energies(const Examination& x, const JudgedModel& model) {
  return run_energies(model.signals, points_of(x, model));
}

}  // namespace joulepath
