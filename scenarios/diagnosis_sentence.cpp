#include "scenarios/diagnosis_sentence.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "diagnosis/thresholds.hpp"
#include "model/effects/catalog.hpp"
#include "model/effects/effect_label.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string percent_text(double percent) { return three_digits(percent) + " %"; }

std::string plain_words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// "dragging wheel (left), 0.24 N m": the effect with its strength.
std::string cause_words(const Cause& cause) {
  const std::string text = plain_words(effect_label(cause.effect));
  if (cause.parameters.empty()) return text;
  const FoundParameter& strength = cause.parameters.front();
  const EffectDescription* effect = find_effect(cause.effect.name);
  const ParameterDescription* described = effect ? effect->find(strength.name) : nullptr;
  const std::string unit = described && described->unit != "1" ? described->unit : "";
  return text + ", " + three_digits(strength.value) + (unit.empty() ? "" : " " + unit);
}

std::string causes_words(const std::vector<Cause>& causes) {
  std::vector<std::string> words;
  for (const Cause& cause : causes) words.push_back(cause_words(cause));
  return text_of_list(words, "; ");
}

/// " shrinks from 26 % to 0.3 % (noise floor 0.1 %)": one gap of energy.
std::string size_words(const EnergyGap& e, bool named) {
  const std::string floor = " (noise floor " + percent_text(e.noise_floor_percent) + ")";
  if (!named || !(e.after_percent < e.before_percent)) return " is " + percent_text(e.before_percent) + floor;
  return " shrinks from " + percent_text(e.before_percent) + " to " + percent_text(e.after_percent) + floor;
}

/// "The energy gap shrinks from 26 % to 0.3 % (noise floor 0.1 %)."; of motors and battery, where both are
/// measured.
std::string gap_words(const Diagnosis& d) {
  const bool named = !d.causes.empty();
  const std::optional<EnergyGap>& battery = d.gap.battery_energy;
  std::string words;
  if (d.gap.energy.before_J > 0)
    words = (battery ? " The motors' energy gap" : " The energy gap") + size_words(d.gap.energy, named) + ".";
  if (battery && battery->before_J > 0)
    words += " The battery's energy gap" + size_words(*battery, named) + ".";
  return words;
}

/// " above 2.3 % of the energy": what the runs would have shown, or what they show within calibration errors,
/// where more than what matters.
std::string size_not_seen(const Diagnosis& d) {
  const double percent = std::max(d.gap.energy.detectable_percent, d.gap.energy.before_percent);
  return percent > 100 * kMaterialEnergy ? " above " + three_digits(percent) + " % of the energy" : "";
}

std::string unknown_words(const Diagnosis& d) {
  if (!d.leftover_significant || d.leftover_description.empty()) return "";
  return " What no effect explains " + d.leftover_description + ".";
}

/// "these runs cannot tell viscous friction from quadratic drag, stribeck friction".
std::string group_words(const Diagnosis& d) {
  for (const Cause& cause : d.causes) {
    if (cause.indistinguishable_from.empty()) continue;
    std::vector<std::string> others;
    for (const std::string& other : cause.indistinguishable_from) others.push_back(plain_words(other));
    return "these runs cannot tell " + cause_words(cause) + " from " + text_of_list(others) + ".";
  }
  return "the likeliest cause is uncertain: " + causes_words(d.causes) + ".";
}

/// A sentence after a colon.
std::string clause(std::string sentence) {
  sentence.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(sentence.front())));
  return sentence;
}

std::string suspects_words(const std::vector<DataCheck>& checks) {
  std::vector<std::string> words;
  for (const DataCheck& check : checks)
    words.push_back(check.channel + " " + check.kind + (check.run.empty() ? "" : " in " + check.run));
  return text_of_list(words, "; ");
}

}  // namespace

std::string diagnosis_sentence(const Diagnosis& d) {
  const VerdictWords& words = words_of(d.verdict);
  const std::string title = std::string(words.title) + ": ";
  switch (d.verdict) {
    case Verdict::no_gap:
      return std::string(words.title) + size_not_seen(d) + ": " + clause(words.meaning) + gap_words(d);
    case Verdict::explained:
      return title + causes_words(d.causes) + "." + gap_words(d);
    case Verdict::partly_explained:
      return title + causes_words(d.causes) + "." + gap_words(d) + unknown_words(d);
    case Verdict::ambiguous:
      return title + group_words(d) + gap_words(d);
    case Verdict::data_suspect:
      return title + suspects_words(d.data_checks) + ". " + words.next_step;
    case Verdict::unexplained:
      return title + clause(words.meaning) + gap_words(d) + unknown_words(d);
    case Verdict::too_little_data:
      return title + clause(words.meaning) + gap_words(d);
  }
  return {};
}

}  // namespace joulepath
