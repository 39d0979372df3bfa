#include "diagnosis/prediction/candidates.hpp"

#include <algorithm>
#include <cmath>

#include "model/effects/effect_label.hpp"

namespace joulepath {
namespace {

double value_or(const EffectSetting& setting, const std::string& key, double fallback) {
  const auto found = setting.parameters.find(key);
  return found == setting.parameters.end() ? fallback : found->second;
}

/// Value of the robot file that the effect's strength replaces; 0 where it replaces none.
double replaced_value(const EffectDescription& effect, const Robot& robot) {
  return effect.in_robot_file ? effect.in_robot_file(robot) : 0.0;
}

void add_with_grid(const EffectDescription& effect, Candidate candidate, const Robot& robot,
                   std::vector<Candidate>& out) {
  std::vector<Candidate> grown{std::move(candidate)};
  for (const ParameterDescription& parameter : effect.parameters) {
    if (parameter.role != ParameterRole::shape) continue;
    std::vector<Candidate> next;
    for (double value : search_grid(parameter, robot))
      for (Candidate c : grown) {
        c.shape.parameters[parameter.name] = value;
        next.push_back(std::move(c));
      }
    grown = std::move(next);
  }
  out.insert(out.end(), grown.begin(), grown.end());
}

}  // namespace

std::string Candidate::label() const { return effect_label(shape); }

const EffectDescription& Candidate::effect() const { return *find_effect(shape.name); }

std::vector<std::string> shape_parameters(const std::string& effect) {
  std::vector<std::string> names;
  for (const ParameterDescription& parameter : find_effect(effect)->parameters)
    if (parameter.role == ParameterRole::shape || parameter.role == ParameterRole::edge)
      names.push_back(parameter.name);
  return names;
}

EffectSetting setting_of(const Candidate& candidate, const std::vector<double>& amplitudes,
                         const Robot& robot) {
  EffectSetting setting = candidate.shape;
  const EffectDescription& effect = candidate.effect();
  const ParameterDescription& strength = effect.strength();
  double value = amplitudes[0] + replaced_value(effect, robot);
  if (const ParameterDescription* direction = effect.find(ParameterRole::direction)) {
    value = std::hypot(amplitudes[0], amplitudes[1]);
    setting.parameters[direction->name] = std::atan2(amplitudes[1], amplitudes[0]);
  }
  if (strength.role == ParameterRole::inverse_strength)
    value = amplitudes[0] > 1 / strength.max ? 1 / amplitudes[0] : strength.max;
  setting.parameters[strength.name] = std::clamp(value, strength.min, strength.max);
  return setting;
}

std::vector<double> amplitudes_of(const EffectSetting& setting, const Robot& robot) {
  const EffectDescription& effect = *find_effect(setting.name);
  const ParameterDescription& strength = effect.strength();
  if (const ParameterDescription* direction = effect.find(ParameterRole::direction)) {
    const double size = value_or(setting, strength.name, 0), angle = value_or(setting, direction->name, 0);
    return {size * std::cos(angle), size * std::sin(angle)};
  }
  if (strength.role == ParameterRole::inverse_strength)
    return {1 / value_or(setting, strength.name, strength.max)};
  return {value_or(setting, strength.name, 0) - replaced_value(effect, robot)};
}

double outside_range(const Candidate& candidate, const std::vector<double>& amplitudes, const Robot& robot) {
  const std::vector<double> accepted = amplitudes_of(setting_of(candidate, amplitudes, robot), robot);
  double square = 0;
  for (std::size_t k = 0; k < accepted.size(); ++k)
    square += (accepted[k] - amplitudes[k]) * (accepted[k] - amplitudes[k]);
  return std::sqrt(square);
}

Candidate bare_candidate(const EffectDescription& effect, const Robot& robot) {
  const ParameterDescription& strength = effect.strength();
  const double typical = typical_size(strength, robot);
  Candidate candidate{
      .shape = {.name = std::string(effect.info.name)},
      .amplitude = {strength.name},
      .step = {strength.role == ParameterRole::inverse_strength ? 1 / typical : typical},
      .nonnegative = effect.info.sign == Sign::nonnegative && replaced_value(effect, robot) == 0};
  if (effect.find(ParameterRole::direction))
    candidate.amplitude = {"x", "y"}, candidate.step = {typical, typical};
  return candidate;
}

std::vector<Candidate> catalog_candidates(const Robot& robot, const std::set<std::string>& without) {
  std::vector<Candidate> candidates;
  for (const EffectDescription& effect : effect_catalog()) {
    if (effect.has_region || without.contains(std::string(effect.info.name))) continue;
    Candidate candidate = bare_candidate(effect, robot);
    if (!effect.has_side) {
      add_with_grid(effect, candidate, robot, candidates);
      continue;
    }
    for (Side side : kSides) {
      candidate.shape.side = side;
      add_with_grid(effect, candidate, robot, candidates);
    }
  }
  return candidates;
}

}  // namespace joulepath
