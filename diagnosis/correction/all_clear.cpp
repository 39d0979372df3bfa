#include "diagnosis/correction/all_clear.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "diagnosis/evidence/boxed_fit.hpp"
#include "diagnosis/evidence/linear_fit.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/evidence/power.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/prediction/nuisance.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/plant.hpp"
#include "model/text_of_list.hpp"
// Design: docs/decisions/0506-verdict.md
namespace joulepath {
namespace {

constexpr double kAnySize_percent = 1000;  ///< in percent of the energy

bool energies_were_measured(const Examination& x) {
  return std::ranges::any_of(x.runs.signals, [](const RunSignals& run) { return measures_energy(run); });
}

/// Power to detect an effect that changes the energy: its expected evidence in units of the noise, for a gap
/// of one percent.
struct DetectionPower {
  std::string effect{};
  double sigmas_per_percent{};
  double prior_sigmas_per_percent{};  ///< in units of the search's prior width
};

/// The state with one step of a candidate's amplitude.
ModelState with_step(const Examination& x, const Candidate& candidate) {
  ModelState with_it = x.id.state;
  std::vector<double> amplitude(candidate.amplitude.size(), 0.0);
  amplitude[0] = candidate.step[0];
  with_it.effects.push_back({candidate, amplitude});
  return with_it;
}

/// Share of the energy that one unit of the candidate's amplitude changes.
double energy_per_amplitude(const Examination& x, const Candidate& candidate) {
  const Impact impact =
      impact_between(x.id.signals, x.point_of(with_step(x, candidate)), x.point_of(x.id.state));
  const bool motors = std::ranges::any_of(x.id.signals, measures_motors);
  return (motors ? impact.motor_power : impact.battery_power) / candidate.step[0];
}

/// A payload that no file states has no error.
bool has_no_meaning(const Examination& x, const Candidate& candidate) {
  if (std::ranges::any_of(x.id.signals, &RunSignals::payload_known)) return false;
  ModelPoint point = x.point_of(with_step(x, candidate));
  point.robot.effects = {point.effects.back()};
  return make_plant(point.robot).payload_factor != 1.0;
}

std::vector<DetectionPower> detection_powers(const Examination& x) {
  std::vector<DetectionPower> effects;
  std::set<std::string> met;
  for (std::size_t c = 0; c < x.id.equations.candidates.size(); ++c) {
    const Candidate& candidate = x.id.equations.candidates[c];
    if (candidate.effect().delays_channels || has_no_meaning(x, candidate)) continue;
    if (!met.insert(candidate.label()).second) continue;
    const double share = energy_per_amplitude(x, candidate);
    if (share * candidate.step[0] < kLeastEnergyOfStep) continue;
    const int column = x.id.equations.columns_of_candidate(static_cast<int>(c), false).front();
    const double amplitude = 0.01 / share;
    effects.push_back({candidate.label(),
                       amplitude * std::sqrt(x.id.problem.gram(column, column) / x.id.dispersion),
                       x.id.problem.prior_sd[column] / amplitude});
  }
  return effects;
}

double probability_seen(const DetectionPower& effect, double gap_percent) {
  return probability_taken_up(effect.sigmas_per_percent * gap_percent,
                              effect.prior_sigmas_per_percent * effect.sigmas_per_percent,
                              gap_percent < 100 * kMaterialEnergy ? kSmallEffectEvidence : 0.0);
}

double detectable_percent(const std::vector<DetectionPower>& effects) {
  if (effects.empty()) return kAnySize_percent;
  const auto seen = [&](double gap_percent) {
    double sum = 0;
    for (const DetectionPower& effect : effects) sum += probability_seen(effect, gap_percent);
    return sum / static_cast<double>(effects.size());
  };
  if (seen(kAnySize_percent) < kShareSeen) return kAnySize_percent;
  double low = 0, high = kAnySize_percent;
  for (int halving = 0; halving < 60; ++halving)
    (seen(0.5 * (low + high)) < kShareSeen ? low : high) = 0.5 * (low + high);
  return high;
}

/// Effects by which a gap of kNotedUnseen_percent would not be seen, however well the runs show others; not
/// those that the runs do show.
std::vector<HardToSee> hard_to_see(const std::vector<DetectionPower>& effects,
                                   const std::vector<SmallEffect>& listed) {
  std::vector<HardToSee> hard;
  for (const DetectionPower& effect : effects) {
    if (std::ranges::count(listed, effect.effect, &SmallEffect::effect) > 0) continue;
    if (const double percent = detectable_percent({effect}); percent > kNotedUnseen_percent)
      hard.push_back(
          {effect.effect, percent < kAnySize_percent ? percent : std::numeric_limits<double>::infinity()});
  }
  return hard;
}

std::string size_text(double percent) {
  char text[64];
  std::snprintf(text, sizeof text, "%.2g %%", percent);
  return percent < kAnySize_percent ? text : "any size";
}

/// "; effects that would show only above 3 %: ..." with the size from which each of them shows; or empty.
std::string hard_words(const std::vector<HardToSee>& hard) {
  std::vector<std::string> words;
  for (const HardToSee& one : hard)
    words.push_back(one.effect + " (from " + size_text(one.detectable_percent) + ")");
  return words.empty() ? ""
                       : "; effects that would show only above " + size_text(kNotedUnseen_percent) + ": " +
                             text_of_list(words);
}

/// " (friction_torque_Nm (left) is 2.1 standard deviations off)": the constant of the robot file that the fit
/// moves by the largest part of its uncertainty; empty where the file states none.
std::string largest_error(const Examination& x) {
  const Equations& equations = x.id.equations;
  std::vector<int> constants = equations.columns_of(Column::Kind::nuisance);
  std::erase_if(constants, [&](int column) {
    const int owner = equations.columns[static_cast<std::size_t>(column)].owner;
    return !is_factor(x.id.nuisances[static_cast<std::size_t>(owner)]);
  });
  if (constants.empty()) return "";
  const Eigen::VectorXd value = fit_parameters(equations, every(equations.runs.size()), {}, x.id.dispersion);
  const auto sigmas = [&](int column) { return std::abs(value[column]) / equations.prior_sd[column]; };
  const int most = *std::ranges::max_element(constants, {}, sigmas);
  char text[64];
  std::snprintf(text, sizeof text, " is %.1f standard deviations off)", sigmas(most));
  return " (" + calibration_name(x.id, most) + text;
}

/// What the runs show without a cause: "no gap is seen", or what covers the one that is.
std::string gap_in_words(const Examination& x, const EnergyGap& measured,
                         const std::vector<SmallEffect>& listed) {
  if (!is_seen(measured)) return "no gap is seen";
  const std::string gap = "the gap of " + size_text(measured.before_percent) + " of the energy ";
  if (!listed.empty()) return gap + "has no cause of material size";
  return gap + "lies within the uncertainty of the robot file's constants" + largest_error(x);
}

std::string hidden_words(const std::string& gap, const std::string& hidden) {
  return gap + "; these runs would not show one of " + hidden +
         ": calibrate, or log more channels or more runs";
}

}  // namespace

bool is_seen(const EnergyGap& measured) {
  return measured.before_percent > 2 * measured.noise_floor_percent &&
         measured.before_percent > 100 * kMaterialEnergy;
}

AllClear examine_all_clear(const Examination& x, Verdict verdict, const EnergyGap& measured,
                           const std::vector<SmallEffect>& listed) {
  if (verdict != Verdict::no_gap && verdict != Verdict::explained) return {.verdict = verdict};
  if (!energies_were_measured(x))
    return {
        .verdict = verdict == Verdict::no_gap ? Verdict::too_little_data : Verdict::partly_explained,
        .note = "no run measures the energy of the motors or of the battery: an energy gap cannot be seen"};
  if (verdict != Verdict::no_gap) return {.verdict = verdict};
  const std::vector<DetectionPower> effects = detection_powers(x);
  const double percent = detectable_percent(effects);
  const std::vector<HardToSee> hard = hard_to_see(effects, listed);
  if (percent > kGreatestUnseen_percent)
    return {.verdict = Verdict::too_little_data,
            .detectable_percent = percent,
            .hard_to_see = hard,
            .note = hidden_words(gap_in_words(x, measured, listed), size_text(percent) + " of the energy")};
  std::vector<std::string> hidden;
  for (const HardToSee& one : hard)
    if (one.detectable_percent > kGreatestUnseen_percent) hidden.push_back(one.effect);
  if (!hidden.empty())
    return {.verdict = Verdict::too_little_data,
            .detectable_percent = percent,
            .hard_to_see = hard,
            .note = hidden_words(
                gap_in_words(x, measured, listed),
                size_text(kGreatestUnseen_percent) + " of the energy by " + text_of_list(hidden))};
  return {.verdict = verdict,
          .detectable_percent = percent,
          .hard_to_see = hard,
          .note = "no gap above " +
                  size_text(std::max({percent, 100 * kMaterialEnergy, measured.before_percent})) +
                  " of the energy (" + std::to_string(std::lround(100 * kShareSeen)) +
                  " % of such gaps would have been seen)" + hard_words(hard) +
                  (is_seen(measured) ? "; " + gap_in_words(x, measured, listed) : "")};
}

}  // namespace joulepath
