#include "diagnosis/correction/correction.hpp"

namespace joulepath {

void write_correction(Examination& x, const ModelState& corrected) {
  if (x.named.empty()) return;
  if (x.report.verdict == Verdict::ambiguous) {
    x.report.notes.push_back("which effect of the group it is cannot be told: no correction is written");
    return;
  }
  const EnergyGap& energy = x.report.gap.energy;
  if (energy.after_J > kToleratedWorsening * energy.before_J &&
      energy.after_percent > kFloorsLeft * energy.noise_floor_percent) {
    x.report.notes.push_back("the correction does not shrink the held-out energy gap: none is written");
    return;
  }
  ModelState constants = corrected;
  constants.effects.clear();
  Robot robot = x.point_of(constants).robot;
  bool physical = false;
  for (const ActiveEffect& effect : corrected.effects) {
    const EffectSetting setting = setting_of(effect.candidate, effect.amplitude, x.dataset.robot);
    if (is_instrument(setting.name))
      x.report.corrected_instruments.push_back(setting);
    else
      robot.effects.push_back(setting), physical = true;
  }
  if (physical) x.report.corrected_robot = robot;
}

}  // namespace joulepath
