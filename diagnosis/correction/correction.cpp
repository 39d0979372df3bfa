#include "diagnosis/correction/correction.hpp"

namespace joulepath {

Correction correction_of(const Examination& x, const Validation& v) {
  if (v.judgment.verdict == Verdict::ambiguous && !v.judgment.named.empty())
    return {.notes = {"these runs cannot separate the effects of the group: no correction is written"}};
  if (!v.corrected) return {.refused = v.refused};
  Correction correction;
  bool physical = false;
  for (const ActiveEffect& effect : v.corrected->effects)
    if (is_instrument(effect.candidate.shape.name))
      correction.instruments.push_back(setting_of(effect.candidate, effect.amplitude, x.dataset.robot));
    else
      physical = true;
  if (physical) correction.robot = corrected_robot(x, *v.corrected);
  return correction;
}

}  // namespace joulepath
