#include "diagnosis/correction/correction.hpp"

#include "model/model_error.hpp"

namespace joulepath {
namespace {

/// (measured - predicted)/predicted energy of the motion, of the held-out runs that measure it.
std::vector<MotionEnergyError> held_out_errors(const Examination& x, const JudgedModel& model) {
  const std::vector<RunEnergy> energies = judged_energies(x, model);
  std::vector<MotionEnergyError> errors;
  for (std::size_t r = 0; r < energies.size(); ++r) {
    const RunSignals& run = model.signals[r];
    const double standby_J = measures_motors(run) ? 0.0
                                                  : x.dataset.robot.power.standby_W * run.period_s *
                                                        static_cast<double>(run.size());
    const double motion_J = energies[r].predicted_J - standby_J;
    if (energies[r].measured_J != 0 && motion_J > 0)
      errors.push_back({-energies[r].gap_J() / motion_J, motion_J});
  }
  return errors;
}

}  // namespace

Correction correction_of(const Examination& x, const Validation& v) {
  if (v.judgment.verdict == Verdict::ambiguous && !v.judgment.named.empty())
    return {.notes = {"these runs cannot separate the effects of the group: no correction is written"}};
  if (!v.corrected) return {.refused = v.refused};
  Correction correction;
  for (const ActiveEffect& effect : v.corrected->effects)
    (is_instrument(effect.candidate.shape.name) ? correction.instruments : correction.effects)
        .push_back(setting_of(effect.candidate, effect.amplitude, x.dataset.robot));
  if (correction.effects.empty()) return correction;
  Robot robot = corrected_robot(x, *v.corrected);
  write_constant_errors(v.errors, x.id.nuisances, *v.corrected, robot);
  correction.notes = {write_model_energy(held_out_errors(x, v.model), robot)};
  correction.robot = std::move(robot);
  return correction;
}

}  // namespace joulepath
