#include "diagnosis/correction/correction.hpp"

#include "diagnosis/thresholds.hpp"

namespace joulepath {

Correction correction_of(const Examination& x, const Validation& v, const EnergyGap& gap) {
  if (v.judgment.named.empty()) return {};
  if (v.judgment.verdict == Verdict::ambiguous)
    return {.notes = {"these runs cannot separate the effects of the group: no correction is written"}};
  if (gap.after_J > kToleratedWorsening * gap.before_J &&
      gap.after_percent > kFloorsLeft * gap.noise_floor_percent)
    return {.notes = {"the correction does not shrink the held-out energy gap: no correction is written"}};
  ModelState constants = v.state;
  constants.effects.clear();
  Robot robot = x.point_of(constants).robot;
  bool physical = false;
  Correction correction;
  for (const ActiveEffect& effect : v.state.effects) {
    const EffectSetting setting = setting_of(effect.candidate, effect.amplitude, x.dataset.robot);
    if (is_instrument(setting.name))
      correction.instruments.push_back(setting);
    else
      robot.effects.push_back(setting), physical = true;
  }
  if (physical) correction.robot = robot;
  return correction;
}

}  // namespace joulepath
