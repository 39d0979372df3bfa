#include "extensions/simulators/proposed_effect.hpp"

#include <algorithm>

namespace joulepath {
namespace {

/// The gap of the energy, or where this hardly changes another one.
bool shrinks(const GapReport& gap) {
  const double widened_percent = gap.energy.after_percent - gap.energy.before_percent;
  return widened_percent < 0 || (widened_percent <= kToleratedWorsening_percent && shrinks_notably(gap));
}

}  // namespace

std::optional<EffectSetting> proposed_effect(const Cause& cause, const Diagnosis& diagnosis) {
  if (diagnosis.corrected_effects.empty() && diagnosis.corrected_instruments.empty())
    return shrinks(diagnosis.gap) ? std::optional(cause.effect) : std::nullopt;
  std::vector<EffectSetting> kept = diagnosis.corrected_instruments;
  kept.insert(kept.end(), diagnosis.corrected_effects.begin(), diagnosis.corrected_effects.end());
  const auto found = std::ranges::find_if(kept, [&](const EffectSetting& effect) {
    return effect.name == cause.effect.name && effect.side == cause.effect.side;
  });
  return found == kept.end() ? std::nullopt : std::optional(*found);
}

}  // namespace joulepath
