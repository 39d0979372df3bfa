#include "diagnosis/prediction/model_state.hpp"

#include <algorithm>

namespace joulepath {

double channel_delay_s(const ModelState& state) {
  double sum_s = 0.0;
  for (const ActiveEffect& effect : state.effects)
    if (effect.candidate.effect().delays_channels) sum_s += effect.amplitude[0];
  return sum_s;
}

ModelPoint model_point(const Robot& robot, const std::vector<Nuisance>& nuisances, const ModelState& state) {
  ModelPoint point{.robot = robot};
  for (std::size_t k = 0; k < nuisances.size(); ++k) {
    if (nuisances[k].key == kCreepNuisance)
      point.contact_creep_m_s_N = usual_creep_m_s_N(robot) * std::max(0.0, state.nuisance_fraction[k]);
    else if (nuisances[k].key == kHeldTurnNuisance)
      point.held_moment_Nm[*nuisances[k].side] = usual_held_moment_Nm(robot) * state.nuisance_fraction[k];
    else if (is_column_only(nuisances[k]))
      continue;
    else if (is_payload_nuisance(nuisances[k]))
      point.payload_factor *= 1 + state.nuisance_fraction[k];
    else
      apply_nuisance(nuisances[k], state.nuisance_fraction[k], point.robot);
  }
  for (const ActiveEffect& effect : state.effects)
    if (!effect.candidate.effect().delays_channels)
      point.effects.push_back(setting_of(effect.candidate, effect.amplitude, robot));
  return point;
}

std::vector<EffectSetting> settings_of(const Robot& robot, const ModelState& state) {
  std::vector<EffectSetting> settings;
  for (const ActiveEffect& effect : state.effects)
    settings.push_back(setting_of(effect.candidate, effect.amplitude, robot));
  return settings;
}

bool is_instrument(const std::string& effect) {
  const EffectDescription* description = find_effect(effect);
  return description && description->info.stage == Stage::instrument;
}

}  // namespace joulepath
