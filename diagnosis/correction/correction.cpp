#include "diagnosis/correction/correction.hpp"

namespace joulepath {

Correction correction_of(const Examination& x, const Validation& v) {
  if (v.judgment.verdict == Verdict::ambiguous && !v.judgment.named.empty())
    return {.notes = {"these runs cannot separate the effects of the group: no correction is written"}};
  if (!v.corrected) return {};
  ModelState constants = *v.corrected;
  constants.effects.clear();
  Robot robot = x.point_of(constants).robot;
  bool physical = false;
  Correction correction;
  for (const ActiveEffect& effect : v.corrected->effects) {
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
