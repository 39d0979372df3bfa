#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "diagnosis/checks/data_checks.hpp"
#include "diagnosis/checks/survey.hpp"
#include "diagnosis/correction/all_clear.hpp"
#include "diagnosis/correction/ceiling.hpp"
#include "diagnosis/correction/control.hpp"
#include "diagnosis/correction/correction.hpp"
#include "diagnosis/correction/runs_apart.hpp"
#include "diagnosis/energies_only/diagnose_energies.hpp"
#include "diagnosis/energies_only/energy_run.hpp"
#include "diagnosis/evidence/another_robot.hpp"
#include "diagnosis/evidence/delay_search.hpp"
#include "diagnosis/evidence/isolability.hpp"
#include "diagnosis/evidence/unstated_payload.hpp"
#include "diagnosis/evidence/velocity_filter_search.hpp"
#include "diagnosis/next_run/next_run.hpp"
#include "diagnosis/signals/held_readings.hpp"
#include "diagnosis/simulator/simulated_runs.hpp"
#include "diagnosis/where/localize.hpp"
#include "model/effects/catalog.hpp"
#include "model/effects/effect_label.hpp"
#include "model/progress.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {
namespace {

/// Broken channels say nothing about the robot: no cause is sought.
Diagnosis stopped_by(const Dataset& dataset, const RunsByUse& runs, std::vector<DataCheck> checks) {
  const Survey survey = survey_dataset(dataset, runs.signals);
  return {.verdict = Verdict::data_suspect,
          .data_checks = std::move(checks),
          .missing_channels = survey.missing_channels,
          .notes = survey.notes};
}

/// Causes relative to another robot's constants say nothing about this one.
Diagnosis of_another_robot(const Dataset& dataset, const RunsByUse& runs,
                           std::vector<ForeignConstant> constants, std::vector<DataCheck> checks) {
  const Survey survey = survey_dataset(dataset, runs.signals);
  return {.verdict = Verdict::unexplained,
          .data_checks = std::move(checks),
          .foreign_constants = std::move(constants),
          .missing_channels = survey.missing_channels,
          .notes = survey.notes};
}

std::vector<std::string> names_of(const Dataset& dataset, const std::vector<std::size_t>& runs) {
  std::vector<std::string> names;
  for (std::size_t r : runs) names.push_back(dataset.runs[r].name);
  return names;
}

std::vector<std::string> taken_out(const std::set<std::string>& effects) {
  std::vector<std::string> notes;
  for (const std::string& effect : effects) notes.push_back(effect + " is removed from the catalog");
  return notes;
}

/// One list after the other, empty sentences left out.
std::vector<std::string> joined(const std::vector<std::vector<std::string>>& lists) {
  std::vector<std::string> all;
  for (const std::vector<std::string>& list : lists)
    std::ranges::copy_if(list, std::back_inserter(all),
                         [](const std::string& note) { return !note.empty(); });
  return all;
}

std::string method_of(const RunsByUse& runs) {
  const std::string payloads = runs.diagnosis.estimated_payload_kg.empty()
                                   ? ""
                                   : "; payloads that no file states are estimated from each run itself";
  if (runs.few) return "the same runs: too few to hold any out" + payloads;
  if (runs.fold_of.empty()) return "held-out runs, never used to choose or fit" + payloads;
  return "cross-fitted, " + std::to_string(fold_count(runs)) + " folds" + payloads;
}

/// Laws and unknown terms with evidence below the materiality floor.
std::vector<SmallEffect> below_materiality(const Examination& x, const Names& names,
                                           const Validation& validation) {
  if (x.runs.few) return {};
  std::vector<SmallEffect> small = x.id.below_materiality;
  for (const std::vector<SmallEffect>* more : {&names.small_unknowns, &validation.listed})
    small.insert(small.end(), more->begin(), more->end());
  return small;
}

/// Labels of what is named, with what it is not told from, and of what is listed as too small to count.
std::set<std::string> found_effects(const Diagnosis& d) {
  std::set<std::string> found;
  for (const Cause& cause : d.causes) {
    found.insert(effect_label(cause.effect));
    found.insert(cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  }
  for (const SmallEffect& small : d.below_materiality) found.insert(small.effect);
  return found;
}

/// Share of the unknown terms in what is explained; without a name, they are all that is.
double share_of(const std::vector<UnknownCause>& unknowns, Verdict verdict) {
  if (verdict == Verdict::unexplained) return 1.0;
  double sum = 0;
  for (const UnknownCause& unknown : unknowns) sum += unknown.share;
  return std::min(1.0, sum);
}

/// An explanation shows in a gap that shrinks.
Verdict shown_verdict(Verdict verdict, const GapReport& gap) {
  return verdict == Verdict::explained && !shrinks_notably(gap) ? Verdict::partly_explained : verdict;
}

/// Whether the energy gap or a signal's falls to half.
bool is_halved(const GapReport& gap) {
  const auto halves = [](double before, double after) { return before > 0 && 2 * after <= before; };
  const auto signal = [&](const SignalGap& s) { return s.present && halves(s.before_rms, s.after_rms); };
  const auto energy = [&](const EnergyGap& e) { return halves(e.before_percent, e.after_percent); };
  return energy(gap.energy) || (gap.battery_energy && energy(*gap.battery_energy)) || signal(gap.current_A) ||
         signal(gap.voltage_V) || signal(gap.position_m) || signal(gap.heading_rad) || signal(gap.battery_W);
}

/// Whether names beside something unknown leave most of every gap on the held-out runs, and energy that
/// matters: then they imitate the unknown cause.
bool leaves_most(const Examination& x, const Validation& validation) {
  const Judgment& judgment = validation.judgment;
  if (judgment.verdict != Verdict::partly_explained || judgment.named.empty() || !validation.refused.empty())
    return false;
  const GapReport gap = held_out_gap(x, validation, 0);
  return is_seen(gap.energy) && gap.energy.after_percent > 100 * kMaterialEnergy && !is_halved(gap);
}

/// The same judgment without its names, and without the unknown terms that are theirs.
Judgment without_names(Judgment judgment) {
  std::vector<std::string> labels;
  for (const ActiveEffect& effect : std::exchange(judgment.named, {})) {
    labels.push_back(effect.candidate.label());
    std::erase_if(judgment.unknowns, [&](const UnknownCause& unknown) {
      return unknown.depends_on.ends_with("(" + labels.back() + ")");
    });
  }
  judgment.verdict = Verdict::unexplained;
  judgment.depends_on = "more than half of every gap is left after " + text_of_list(labels);
  judgment.sizes.of_names.clear();
  return judgment;
}

/// What the held-out runs say of the named causes: verdict, gap, causes, and what they are worth.
Diagnosis conclusion(const Examination& x, const Names& names, const Validation& validation,
                     std::size_t bootstrap) {
  const auto& [judged, named, unknowns, depends_on, judgment_notes, sizes] = validation.judgment;
  GapReport gap = held_out_gap(x, validation, bootstrap);
  const std::vector<SmallEffect> small = below_materiality(x, names, validation);
  const auto [verdict, detectable_percent, hard_to_see, all_clear_note] =
      examine_all_clear(x, shown_verdict(judged, gap), gap.energy, small);
  gap.energy.detectable_percent = detectable_percent;
  gap.energy.hard_to_see = hard_to_see;
  const Causes causes = report_causes(x, names, validation, gap.energy);
  const Control control = wrong_candidate(x, named, causes.causes, gap.energy);
  return {.gap = gap,
          .verdict = verdict,
          .causes = causes.causes,
          .ranking = rank_effects(names.probabilities, names.surest),
          .unknowns = unknowns,
          .below_materiality = small,
          .leftover_significant = !depends_on.empty(),
          .leftover_share = share_of(unknowns, verdict),
          .leftover_description = depends_on,
          .ceiling_shrink_fraction = ceiling_shrink_fraction(x, !named.empty(), gap.energy),
          .control_effect = control.effect,
          .control_shrink_fraction = control.shrink_fraction,
          .pinned_combination = causes.pinned_combination,
          .correlations = causes.correlations,
          .notes = joined({judgment_notes, {all_clear_note}}),
          .validation_runs = names_of(x.dataset, x.runs.validation.runs),
          .validation_method = method_of(x.runs)};
}

/// The steps up to the names and their test on held-out runs; each reads what the steps before it found.
struct Examined {
  RunsByUse runs{};
  Survey survey{};
  Identification id{};
  Names names{};
  Validation validation{};

  Examination on(const Dataset& dataset, const DiagnoseOptions& options) const {
    return {.dataset = dataset, .runs = runs, .id = id, .refusal = options.refusal};
  }
};

Examined examine(const Dataset& dataset, RunsByUse runs, const DiagnoseOptions& options) {
  Examined examined{.runs = std::move(runs)};
  examined.survey = survey_dataset(dataset, examined.runs.signals);
  std::set<std::string> without = examined.survey.invisible_effects;
  without.insert(options.without.begin(), options.without.end());
  expect_steps(3);  // identify, choose, validate
  examined.id = identify(examined.runs.diagnosis, without);
  finish_steps();
  const Examination x = examined.on(dataset, options);
  examined.names = choose_names(x);
  finish_steps();
  examined.validation = validate(x, judge(x, examined.names));
  if (leaves_most(x, examined.validation))
    examined.validation = validate(x, without_names(examined.validation.judgment));
  finish_steps();
  return examined;
}

/// The runs that the fit of the others does not describe, in the numbers of the answer.
std::vector<RunApart> describe(const Dataset& dataset, const RunsByUse& all,
                               const std::vector<RunPower>& powers, const std::set<std::size_t>& apart) {
  const std::vector<RunEnergy> nominal =
      run_energies(all.signals, ModelPoints(all.signals.size(), {.robot = dataset.robot}));
  const double gap_J = absolute_gap_J(nominal);
  std::vector<RunApart> described;
  for (const RunPower& power : powers) {
    if (!apart.contains(power.run)) continue;
    const auto at = std::ranges::find(all.signals, power.run, &RunSignals::run_index) - all.signals.begin();
    described.push_back({dataset.runs[power.run].name, 100 * (power.measured_W / power.predicted_W - 1),
                         std::abs(nominal[static_cast<std::size_t>(at)].gap_J()) / gap_J});
  }
  return described;
}

/// Where the fit of all runs leaves some of them far from the rest, the others are examined alone. The answer
/// is theirs if their fit confirms it.
std::vector<RunApart> leave_out_runs_apart(const Dataset& dataset, const DiagnoseOptions& options,
                                           Examined& all) {
  if (all.runs.few) return {};
  const auto apart_from = [&](const Examined& e, const std::vector<RunPower>& powers, double ratio) {
    return runs_apart(powers, ratio, noise_floor_percent(e.on(dataset, options), e.validation.fitted));
  };
  const std::set<std::size_t> doubted =
      apart_from(all, run_powers(all.on(dataset, options), all.validation), kDoubtedApart);
  if (doubted.empty()) return {};
  Examined others = examine(dataset, with_estimated_payloads(sort_runs(dataset, doubted)), options);
  const std::vector<RunPower> powers =
      run_powers(others.on(dataset, options), others.validation, {doubted.begin(), doubted.end()});
  if (others.runs.few || apart_from(others, powers, kApart) != doubted) return {};
  std::vector<RunApart> described = describe(dataset, all.runs, powers, doubted);
  all = std::move(others);
  return described;
}

/// A cause's probability stands beside its effect in the corrected robot, behind those of the robot's file.
void state_probabilities(const std::vector<Cause>& causes, std::size_t of_file, Robot& robot) {
  for (const Cause& cause : causes)
    for (std::size_t k = of_file; k < robot.effects.size(); ++k)
      if (robot.effects[k].name == cause.effect.name && robot.effects[k].side == cause.effect.side)
        robot.effects[k].probability = cause.probability;
}

Diagnosis diagnose_logs(const Dataset& dataset, RunsByUse usable, const DiagnoseOptions& options) {
  expect_steps(4);  // runs apart, conclusion, next run, isolability
  Examined examined = examine(dataset, std::move(usable), options);
  std::vector<RunApart> apart = leave_out_runs_apart(dataset, options, examined);
  finish_steps();
  const auto& [runs, survey, id, names, validation] = examined;
  const Examination x = examined.on(dataset, options);
  const Correction correction = correction_of(x, validation);
  Diagnosis d = conclusion(x, names, validation, options.bootstrap);
  d.runs_apart = std::move(apart);
  finish_steps();
  d.where = localize_gap(runs.signals, x.nominal(), id.equations.noise, options.bootstrap);
  d.next = propose_run(id, dataset.robot, d.causes, d.ranking, d.verdict);
  finish_steps();
  d.isolability = isolability(read_signals(runs.diagnosis, 0.0), dataset.robot,
                              {id.equations.noise, id.equations.run_variance, id.dispersion},
                              survey.invisible_effects, options.without, found_effects(d));
  finish_steps();
  d.estimated_payload_kg = runs.diagnosis.estimated_payload_kg;
  d.missing_channels = survey.missing_channels;
  d.notes = joined({survey.notes,
                    taken_out(options.without),
                    d.notes,
                    correction.notes,
                    {told_by_energies(dataset, correction)}});
  d.corrected_robot = correction.robot;
  if (d.corrected_robot) state_probabilities(d.causes, dataset.robot.effects.size(), *d.corrected_robot);
  d.corrected_effects = correction.effects;
  d.corrected_instruments = correction.instruments;
  d.refused_correction = correction.refused;
  return d;
}

Diagnosis diagnose_sorted(const Dataset& dataset, RunsByUse runs, std::vector<DataCheck> checks,
                          std::vector<ForeignConstant> foreign, const DiagnoseOptions& options) {
  if (!foreign.empty()) return of_another_robot(dataset, runs, std::move(foreign), std::move(checks));
  if (!checks.empty()) return stopped_by(dataset, runs, std::move(checks));
  if (runs.signals.empty()) return diagnose_energies(dataset, options);
  return diagnose_logs(dataset, with_estimated_payloads(std::move(runs)), options);
}

/// By which a named cause says that the wheel speeds are late; 0 without one.
double named_delay_s(const std::vector<Cause>& causes) {
  for (const Cause& cause : causes)
    if (const EffectDescription* effect = find_effect(cause.effect.name); effect->delays_channels)
      return std::max(0.0, -cause.parameters.front().value);
  return 0.0;
}

/// Time constant of the filter of wheel speeds that are clearly late; 0: none is told.
double filter_of_late_speeds_s(const LogSet& logs) {
  const double delay_s = rough_channel_delay_s(logs);
  return delay_s < 0 ? examine_late_speeds(logs, delay_s).filter_s : 0.0;
}

Diagnosis diagnose_sound(const Dataset& dataset, RunsByUse runs, const DiagnoseOptions& options) {
  std::vector<DataCheck> checks = check_data(dataset, runs);
  AnotherRobot another = another_robot(dataset, runs, checks);
  Diagnosis d =
      diagnose_sorted(dataset, std::move(runs), std::move(checks), std::move(another.constants), options);
  d.notes.insert(d.notes.begin(), another.notes.begin(), another.notes.end());
  return d;
}

std::string undecided_note(double delay_s) {
  return "the wheel speeds are late by " + std::to_string(std::lround(1000 * delay_s)) +
         " ms: whether by a clock offset or by a filter of that time constant these runs do not tell";
}

/// With a filter that is told; where wheel speeds are named late, it is sought about the named delay.
/// `behind` diagnoses what is read behind a filter.
Diagnosis filter_decided(Diagnosis d, const LogSet& logs, const std::function<Diagnosis(double)>& behind) {
  const double delay_s = named_delay_s(d.causes);
  if (delay_s == 0) return d;
  const LateSpeeds late = examine_late_speeds(logs, -delay_s);
  if (late.filter_s > 0) return behind(late.filter_s);
  if (late.undecided) d.notes.push_back(undecided_note(delay_s));
  return d;
}

/// Of the robot against the file's model. Where a filter smoothed the wheel speeds of sound channels, all are
/// read behind it: swapped currents resemble one.
Diagnosis diagnose_robot(const Dataset& dataset, const DiagnoseOptions& options) {
  const auto behind = [&](double filter_s) {
    Dataset filtered = dataset;
    for (Run& run : filtered.runs) run.velocity_filter_s = filter_s;
    Diagnosis d = diagnose_sound(filtered, sort_runs(filtered), options);
    d.velocity_filter_s = filter_s;
    return d;
  };
  RunsByUse runs = sort_runs(dataset);
  const LogSet logs = runs.diagnosis;
  const double filter_s = filter_of_late_speeds_s(logs);
  if (filter_s > 0 && check_data(dataset, runs).empty()) return behind(filter_s);
  return filter_decided(diagnose_sound(dataset, std::move(runs), options), logs, behind);
}

/// Faults of the robot's log; what the simulator's log shows as well is no fault but another model.
std::vector<DataCheck> faults_of_robot(const Dataset& dataset, const RunsByUse& runs,
                                       const Diagnosis& contents) {
  if (!contents.foreign_constants.empty()) return {};
  std::vector<DataCheck> checks = check_data(dataset, runs);
  std::erase_if(checks, [&](const DataCheck& check) {
    return std::ranges::any_of(contents.data_checks, [&](const DataCheck& shared) {
      return shared.channel == check.channel && shared.kind == check.kind;
    });
  });
  return checks;
}

/// A gap of the simulator that no cause explains and that calibration errors would explain is still one: a
/// simulator's constants are what its user set.
void judge_simulator(Diagnosis& d) {
  if (d.verdict != Verdict::no_gap || !is_seen(d.gap.energy)) return;
  d.verdict = Verdict::unexplained;
  d.leftover_significant = true;
  d.leftover_description = "goes with constants within their uncertainty in the robot file";
}

/// Runs by their number in the whole dataset.
void renumber(const std::vector<std::size_t>& indices, Diagnosis& d) {
  for (DataCheck& check : d.data_checks)
    for (std::size_t& run : check.runs) run = indices[run];
  std::map<std::size_t, double> payload_kg;
  for (const auto& [run, kg] : d.estimated_payload_kg) payload_kg[indices[run]] = kg;
  d.estimated_payload_kg = std::move(payload_kg);
}

/// How a simulator's predictions stand beside the robot's runs.
void describe_simulator(const ComparedRuns& compared, Diagnosis& d) {
  SimulatorGap& simulator = d.simulator;
  simulator.runs = compared.dataset.runs.size();
  simulator.noise_floor_percent = d.gap.energy.noise_floor_percent;
  simulator.lacking_channels = compared.lacking;
  simulator.robot = compared.dataset.robot;
  for (std::size_t r = 0; r < compared.indices.size(); ++r)
    simulator.deviations[compared.indices[r]] = *compared.dataset.runs[r].deviation;
  for (const Alignment& alignment : compared.alignments) {
    ++(alignment.by == AlignedBy::time      ? simulator.by_time
       : alignment.by == AlignedBy::command ? simulator.by_command
                                            : simulator.by_path);
    simulator.motion_difference_percent =
        std::max(simulator.motion_difference_percent, 100 * alignment.motion_difference);
    if (std::abs(alignment.clock_offset_s) > std::abs(simulator.clock_offset_s))
      simulator.clock_offset_s = alignment.clock_offset_s;
  }
  renumber(compared.indices, d);
}

Diagnosis compared_with_simulator(const ComparedRuns& compared, RunsByUse runs,
                                  const DiagnoseOptions& options) {
  const std::vector<RunEnergy> energies =
      run_energies(runs.signals, ModelPoints(runs.signals.size(), {.robot = compared.dataset.robot}));
  Diagnosis d = diagnose_logs(compared.dataset, with_estimated_payloads(std::move(runs)), options);
  d.simulator.gap_percent = energy_gap_percent(energies);
  d.simulator.bias_percent = energy_bias_percent(energies);
  judge_simulator(d);
  describe_simulator(compared, d);
  return d;
}

/// Of a robot whose wheel speeds are behind a filter: its channels and the simulator's are read behind it.
Diagnosis compared_behind(double filter_s, Dataset dataset, const Robot& robot,
                          const DiagnoseOptions& options) {
  for (Run& run : dataset.runs) run.velocity_filter_s = filter_s;
  const ComparedRuns compared = compare_runs(dataset, robot);
  Diagnosis d = compared_with_simulator(compared, sort_runs(compared.dataset), options);
  d.velocity_filter_s = filter_s;
  return d;
}

Diagnosis diagnose_compared(const Dataset& dataset, const Robot& robot, const Diagnosis& contents,
                            const DiagnoseOptions& options) {
  const auto behind = [&](double filter_s) { return compared_behind(filter_s, dataset, robot, options); };
  const ComparedRuns compared = compare_runs(dataset, robot);
  RunsByUse runs = sort_runs(compared.dataset);
  if (auto checks = faults_of_robot(compared.dataset, runs, contents); !checks.empty()) {
    Diagnosis d = stopped_by(compared.dataset, runs, std::move(checks));
    describe_simulator(compared, d);
    return d;
  }
  const LogSet logs = runs.diagnosis;
  if (const double filter_s = filter_of_late_speeds_s(logs); filter_s > 0) return behind(filter_s);
  return filter_decided(compared_with_simulator(compared, std::move(runs), options), logs, behind);
}

/// Of the robot against the user's own simulator: the model is that of the robot file with what the
/// simulator has beyond it, and what the simulator's predictions still have beyond that model is added.
Diagnosis diagnose_simulator(Dataset dataset, const DiagnoseOptions& options) {
  const Diagnosis contents = diagnose_robot(simulator_dataset(dataset), options);
  for (Run& run : dataset.runs) run.predicted_filter_s = contents.velocity_filter_s;
  Diagnosis d =
      diagnose_compared(dataset, contents.corrected_robot.value_or(dataset.robot), contents, options);
  d.simulator.of_runs = static_cast<std::size_t>(std::ranges::count_if(dataset.runs, has_usable_log));
  d.simulator.contents = contents.verdict;
  d.simulator.contains = contents.causes;
  d.simulator.velocity_filter_s = contents.velocity_filter_s;
  d.simulator.is_another_robots = !contents.foreign_constants.empty();
  for (const DataCheck& check : contents.data_checks)
    d.notes.push_back("the simulator's logs: " + check.channel + " " + check.kind + ", " + check.evidence);
  return d;
}

}  // namespace

Diagnosis diagnose(const Dataset& dataset, const DiagnoseOptions& options) {
  refuse_short_runs(dataset);
  const bool holds = holds_readings(dataset);
  const Dataset lines = holds ? between_readings(dataset) : Dataset{};
  const Dataset& read = holds ? lines : dataset;
  Diagnosis diagnosis = std::ranges::any_of(read.runs, has_prediction) ? diagnose_simulator(read, options)
                                                                       : diagnose_robot(read, options);
  if (holds)
    diagnosis.notes.push_back(
        "channels repeat their readings over several samples: they are read as lines between the readings");
  diagnosis.artifacts = artifact_texts(dataset);
  return diagnosis;
}

}  // namespace joulepath
