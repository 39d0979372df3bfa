#include "diagnosis/correction/validation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "diagnosis/correction/companions.hpp"
#include "diagnosis/correction/parameters.hpp"
#include "diagnosis/evidence/fitted_model.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/text_of_list.hpp"
// Design: docs/decisions/0507-cross-fitting.md
// Method: [Stone1974]
namespace joulepath {
namespace {

/// Logs without any noise (a simulator's) have no floor to measure.
double finite_or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

double nominal_gap_percent(const Examination& x) {
  const std::vector<RunSignals> signals = read_signals(x.runs.validation, 0.0);
  return energy_gap_percent(run_energies(signals, ModelPoints(signals.size(), x.nominal())));
}

double gap_percent(const Examination& x, const JudgedModel& model) {
  return energy_gap_percent(judged_energies(x, model));
}

/// With unknown terms beside the names; alone where such a term can stand for a name.
Refit fit_names(const Examination& x, const std::vector<ActiveEffect>& named,
                const std::set<std::string>& terms) {
  const auto fit = [&](const std::set<std::string>& unknowns) {
    return fit_effects(x.runs.diagnosis, x.id, named, unknowns);
  };
  const std::set<std::string> unknowns = named.empty() ? std::set<std::string>{} : terms;
  Refit fitted = fit(unknowns);
  for (std::size_t e = 0; e < named.size() && !unknowns.empty(); ++e)
    if (!is_told_from_zero(fitted, e)) return fit({});
  return fitted;
}

/// What the held-out gap may be without a part of it that is not explained.
double least_gap_left_percent(const Examination& x, const Refit& fitted) {
  return std::max(kFloorsLeft * noise_floor_percent(x, fitted), kMaterialGap_percent);
}

/// The unknown terms of the best explanation, for the fit of the names. One that nothing reports can take
/// over what a name explains: a curve of voltage over current is a resistance. None count where the names
/// alone explain the held-out gap and beside such terms do not.
std::set<std::string> terms_beside_names(const Examination& x, const Judgment& judgment) {
  std::set<std::string> terms = unknown_labels(x.id.equations, x.best());
  if (judgment.named.empty() || terms.empty() || !judgment.unknowns.empty()) return terms;
  const auto explains = [&](const std::set<std::string>& beside) {
    const Refit fitted = fit_names(x, judgment.named, beside);
    return gap_percent(x, judged_model(x, fitted)) <= least_gap_left_percent(x, fitted);
  };
  return !explains(terms) && explains({}) ? std::set<std::string>{} : terms;
}

/// A member that is not named; below the materiality floor it is listed.
void withdraw(std::size_t member, const std::string& why, Validation& v) {
  std::vector<ActiveEffect>& named = v.judgment.named;
  const std::string label = named[member].candidate.label();
  v.judgment.notes.push_back(label + " is not named: its " + why);
  std::ranges::copy_if(v.judgment.sizes.of_names, std::back_inserter(v.listed),
                       [&](const SmallEffect& name) { return name.effect == label && name.size < 1; });
  named.erase(named.begin() + static_cast<std::ptrdiff_t>(member));
}

/// Fits the names, without companions of the others, without those whose size a fit cannot tell from 0 or
/// that lie outside their range. The evidence for them stays: without any name left the gap is unexplained,
/// unless an effect too small to count is the cause.
void fit_what_can_be_told(const Examination& x, const std::set<std::string>& terms, Validation& v) {
  std::vector<ActiveEffect>& named = v.judgment.named;
  std::string dropped;
  v.fitted = fit_names(x, named, terms);
  while (const std::optional<std::size_t> companion = weakest_companion(x, v.fitted, terms)) {
    withdraw(*companion, "own evidence beside the other names is too small", v);
    v.fitted = fit_names(x, named, terms);
  }
  for (std::size_t e = named.size(); e-- > 0;) {
    if (is_told_from_zero(v.fitted, e) && is_inside_range(v.fitted, e, x.dataset.robot)) continue;
    const std::string why =
        is_told_from_zero(v.fitted, e) ? "size lies outside what is physical" : "size cannot be told from 0";
    dropped = "goes with " + named[e].candidate.label() + ", whose " + why;
    withdraw(e, why, v);
    v.fitted = fit_names(x, named, terms);
  }
  if (dropped.empty() || !named.empty()) return;  // the verdict stays what the race says
  if (v.judgment.unknowns.empty() && has_small_effect(x)) {
    v.judgment.verdict = Verdict::no_gap;
    return;
  }
  v.judgment.verdict = Verdict::unexplained;
  if (v.judgment.unknowns.empty()) v.judgment.depends_on = dropped;
}

JudgedModel with_nominal_constants(JudgedModel model) {
  for (ModelState& state : model.states) std::ranges::fill(state.nuisance_fraction, 0.0);
  return model;
}

/// All names, then the sets without one, then single names.
std::vector<std::vector<ActiveEffect>> parts_of(const std::vector<ActiveEffect>& named) {
  std::vector<std::vector<ActiveEffect>> parts{named};
  if (named.size() < 2) return parts;
  for (std::size_t e = 0; e < named.size(); ++e) {
    parts.push_back(named);
    parts.back().erase(parts.back().begin() + static_cast<std::ptrdiff_t>(e));
  }
  if (named.size() > 2)
    for (const ActiveEffect& effect : named) parts.push_back({effect});
  return parts;
}

std::string in_words(const std::vector<ActiveEffect>& effects) {
  return text_of_list(effects, [](const ActiveEffect& effect) { return effect.candidate.label(); });
}

/// Whether a model may be written: it shrinks the held-out energy gap, or hardly changes it and shrinks the
/// gap of another signal.
bool is_better(const Examination& x, double before, const JudgedModel& model) {
  const double after = gap_percent(x, model);
  if (after < before) return true;
  if (after > before + kToleratedWorsening_percent) return false;
  const std::vector<RunSignals> signals = read_signals(x.runs.validation, 0.0);
  return shrinks_a_signal(signals, ModelPoints(signals.size(), x.nominal()), model.signals,
                          points_of(x, model));
}

/// The correction holds a part of the names. Where all together widen the held-out gap, the others are
/// withdrawn.
void keep_part(const std::vector<ActiveEffect>& part, const Refit& fitted, bool widens, Validation& v) {
  v.judgment.notes.push_back(widens ? "all names together widen the held-out energy gap, " + in_words(part) +
                                          " shrinks it: nothing else is named"
                                    : "only " + in_words(part) +
                                          " shrinks the held-out gap: the correction holds nothing else");
  if (!widens) return;
  v.judgment.named = part;
  v.fitted = fitted;
}

/// A correction that may be written, and what it does on held-out runs.
struct Draft {
  ModelState state{};
  JudgedModel model{};
};

/// The names with the fit's constants and with the file's, the one with the smaller held-out gap first.
std::vector<Draft> drafts_of(const Examination& x, const Refit& fitted, JudgedModel model) {
  Draft effects_alone{.state = fitted.state, .model = with_nominal_constants(model)};
  std::ranges::fill(effects_alone.state.nuisance_fraction, 0.0);
  std::vector<Draft> drafts{{within_calibration(x, fitted.state), std::move(model)},
                            std::move(effects_alone)};
  if (!(gap_percent(x, drafts[0].model) <= gap_percent(x, drafts[1].model))) std::swap(drafts[0], drafts[1]);
  return drafts;
}

/// A gap (percent) that is no more than noise and below the materiality floor.
bool is_noise(const Examination& x, double gap, const Refit& fitted) {
  return gap < 100 * kMaterialEnergy && gap <= kFloorsLeft * noise_floor_percent(x, fitted);
}

/// A gap of noise, of causes that are all below the materiality floor, is none: they are listed, however sure
/// they are.
bool is_no_gap(const Examination& x, double before, const Validation& v) {
  return v.judgment.verdict != Verdict::no_gap && v.judgment.sizes.greatest < 1 &&
         is_noise(x, before, v.fitted);
}

void list_what_is_no_gap(const Examination& x, Validation& v) {
  v = {.judgment = {.verdict = Verdict::no_gap}, .listed = v.judgment.sizes.of_names};
  std::erase_if(v.listed, [](const SmallEffect& effect) { return effect.size >= 1; });
  v.fitted = fit_names(x, {}, {});
  v.model = judged_model(x, v.fitted);
}

/// The first part of the names that is better than the file on held-out runs and that the program reads.
/// Constants are moved only where that reduces the gap. Names that widen it by more than kMaterialGap_percent
/// are withdrawn.
void choose_correction(const Examination& x, const std::set<std::string>& terms, double before,
                       Validation& v) {
  const bool widens = gap_percent(x, v.model) > before + kMaterialGap_percent;
  for (const std::vector<ActiveEffect>& part : parts_of(v.judgment.named)) {
    const bool all = part.size() == v.judgment.named.size();
    const Refit fitted = all ? v.fitted : fit_names(x, part, terms);
    for (Draft& draft : drafts_of(x, fitted, all ? v.model : judged_model(x, fitted))) {
      if (!is_better(x, before, draft.model)) break;
      v.refused = x.refusal ? x.refusal(corrected_robot(x, draft.state)) : "";
      if (!v.refused.empty()) continue;
      if (std::ranges::any_of(draft.state.nuisance_fraction, [](double moved) { return moved != 0; }))
        v.errors = constant_errors(fitted, x.id.nuisances, x.dataset.robot);
      v.corrected = std::move(draft.state), v.model = std::move(draft.model);
      if (!all) keep_part(part, fitted, widens, v);
      return;
    }
  }
  if (!v.refused.empty()) {
    v.judgment.notes.push_back("no correction is written: the program would refuse its robot file, " +
                               v.refused);
    if (v.judgment.verdict == Verdict::explained) v.judgment.verdict = Verdict::partly_explained;
    return;
  }
  // Names that lift a gap out of its noise explain nothing.
  if (const double after = gap_percent(x, v.model);
      after > before && is_noise(x, before, v.fitted) && !is_noise(x, after, v.fitted)) {
    const std::string withdrawn = in_words(v.judgment.named);
    list_what_is_no_gap(x, v);
    v.judgment.notes.push_back(withdrawn + " fits the runs, and widens a held-out gap of noise: not named");
    return;
  }
  v.judgment.notes.push_back("no part of the correction shrinks the held-out gap: none is written");
  if (before > kMaterialGap_percent && v.judgment.verdict == Verdict::explained)
    v.judgment.verdict = Verdict::partly_explained;
  if (!widens) return;
  v.judgment.notes.push_back(in_words(v.judgment.named) +
                             " widens the held-out energy gap: no name is given");
  v.judgment.named.clear();
  v.judgment.verdict = Verdict::unexplained;
  v.fitted = fit_names(x, {}, {});
  v.model = judged_model(x, v.fitted);
}

/// The gap of one or two held-out runs is mostly scatter between runs: more of it is tolerated.
double caution(const Examination& x) {
  return x.runs.validation.runs.size() < kFewHeldOut ? kCautionFactor : 1.0;
}

/// What the names leave of the held-out energy gap, beyond noise, is a part that is not explained.
void judge_what_is_left(const Examination& x, double before, Validation& v) {
  const bool named = !v.judgment.named.empty();
  const double after = gap_percent(x, v.model);
  const double least = (named ? caution(x) : kCautionFactor) * least_gap_left_percent(x, v.fitted);
  if (after <= least) return;
  if (!named && v.judgment.verdict == Verdict::no_gap) {
    v.judgment.verdict = Verdict::unexplained;
    v.judgment.notes.push_back(
        "calibration errors do not explain the gap, and no effect of the catalog holds");
  }
  if (!named || v.judgment.verdict != Verdict::explained) return;
  v.judgment.verdict = Verdict::partly_explained;
  char text[160];
  std::snprintf(text, sizeof text, "the names leave %.3g %% of a held-out energy gap of %.3g %%", after,
                before);
  v.judgment.notes.push_back(text);
}

void fill_floors(const NoiseModel& noise, GapReport& gap) {
  gap.current_A.noise_floor_rms = noise.channel_sd[kCurrentLeft];
  gap.voltage_V.noise_floor_rms = noise.channel_sd[kWindingLeft];
  gap.position_m.noise_floor_rms = noise.channel_sd[kPositionX];
  gap.heading_rad.noise_floor_rms = noise.channel_sd[kHeading];
  gap.battery_W.noise_floor_rms = noise.channel_sd[kDriverPower];
}

}  // namespace

double noise_floor_percent(const Examination& x, const Refit& fitted, EnergyAt at) {
  const ModelPoint point = x.point_of(fitted.state);
  const double left =
      energy_gap_percent(run_energies(fitted.signals, ModelPoints(fitted.signals.size(), point), at));
  return finite_or_zero(
      std::min(left, kScatterFactor * run_scatter_percent(fitted.signals, point, x.id.equations.run_variance,
                                                          x.id.equations.noise, at)));
}

Validation validate(const Examination& x, const Judgment& by_race) {
  Validation v{.judgment = by_race};
  const std::set<std::string> terms = terms_beside_names(x, v.judgment);
  fit_what_can_be_told(x, terms, v);
  v.model = judged_model(x, v.fitted);
  if (v.judgment.verdict == Verdict::too_little_data) return v;
  const double before = nominal_gap_percent(x);
  if (is_no_gap(x, before, v)) list_what_is_no_gap(x, v);
  if (!v.judgment.named.empty() && v.judgment.verdict != Verdict::ambiguous)
    choose_correction(x, terms, before, v);
  judge_what_is_left(x, before, v);
  return v;
}

GapReport held_out_gap(const Examination& x, const Validation& v, std::size_t bootstrap) {
  const bool correct_it = !v.judgment.named.empty();
  const std::vector<RunSignals> before = read_signals(x.runs.validation, 0.0);
  GapReport gap =
      measure_gap({.before_signals = before,
                   .after_signals = correct_it ? v.model.signals : before,
                   .before = x.nominal(),
                   .after = correct_it ? points_of(x, v.model) : ModelPoints(before.size(), x.nominal()),
                   .noise_floor_percent = noise_floor_percent(x, v.fitted),
                   .battery_floor_percent = noise_floor_percent(x, v.fitted, EnergyAt::battery),
                   .bootstrap = bootstrap,
                   .fitted_signals = v.fitted.signals,
                   .fitted = x.point_of(v.fitted.state)});
  if (!correct_it) gap.energy.shrink_interval_95 = {};  // nothing is claimed
  if (!correct_it && gap.battery_energy) gap.battery_energy->shrink_interval_95 = {};
  fill_floors(x.id.equations.noise, gap);
  return gap;
}

}  // namespace joulepath
