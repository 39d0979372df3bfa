#include "diagnosis/correction/judged_model.hpp"

#include <algorithm>

#include "diagnosis/evidence/fitted_model.hpp"

namespace joulepath {

JudgedModel judged_model(const Examination& x, const Refit& fitted) {
  JudgedModel model{.signals = x.runs.fold_of.empty()
                                   ? read_signals(x.runs.validation, channel_delay_s(fitted.state))
                                   : fitted.signals,
                    .states = std::vector<ModelState>(x.runs.validation.runs.size(), fitted.state)};
  const std::vector<std::size_t>& fold_of = x.runs.fold_of;
  if (fold_of.empty()) return model;
  for (std::size_t fold = 0; fold < fold_count(x.runs); ++fold) {
    const ModelState state = state_of_runs(fitted, x.id.nuisances, fitted_runs(x.runs, fold));
    for (std::size_t r = 0; r < fold_of.size(); ++r)
      if (fold_of[r] == fold) model.states[r] = state;
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
