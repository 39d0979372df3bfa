#include <algorithm>

#include "diagnosis/checks/data_checks.hpp"
#include "diagnosis/checks/survey.hpp"
#include "diagnosis/correction/all_clear.hpp"
#include "diagnosis/correction/ceiling.hpp"
#include "diagnosis/correction/control.hpp"
#include "diagnosis/correction/correction.hpp"
#include "diagnosis/energies_only/diagnose_energies.hpp"
#include "diagnosis/energies_only/energy_run.hpp"
#include "diagnosis/evidence/isolability.hpp"
#include "diagnosis/evidence/unstated_payload.hpp"
#include "diagnosis/next_run/next_run.hpp"
#include "diagnosis/where/localize.hpp"

namespace joulepath {
namespace {

Diagnosis diagnose_without_logs(const Dataset& dataset, const DiagnoseOptions& options) {
  if (std::ranges::any_of(dataset.runs, is_energy_run)) return diagnose_energies(dataset, options);
  return {.notes = {"no run has a log with wheel speeds, nor an energy with its motion"}};
}

/// Broken channels say nothing about the robot: no cause is sought.
Diagnosis stopped_by(const Dataset& dataset, const RunsByUse& runs, std::vector<DataCheck> checks) {
  const Survey survey = survey_dataset(dataset, runs.signals);
  return {.verdict = Verdict::data_suspect,
          .data_checks = std::move(checks),
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

/// Share of the unknown terms in what is explained; without a name, they are all that is.
double share_of(const std::vector<UnknownCause>& unknowns, Verdict verdict) {
  if (verdict == Verdict::unexplained) return 1.0;
  double sum = 0;
  for (const UnknownCause& unknown : unknowns) sum += unknown.share;
  return std::min(1.0, sum);
}

/// What the held-out runs say of the named causes: verdict, gap, causes, and what they are worth.
Diagnosis conclusion(const Examination& x, const Names& names, const Validation& validation,
                     std::size_t bootstrap) {
  const auto& [judged, named, unknowns, depends_on, judgment_notes, sizes] = validation.judgment;
  GapReport gap = held_out_gap(x, validation, bootstrap);
  const auto [verdict, detectable_percent, all_clear_note] = examine_all_clear(x, judged, gap.energy);
  gap.energy.detectable_percent = detectable_percent;
  const Causes causes = report_causes(x, names, validation, gap.energy);
  const Control control = wrong_candidate(x, named, causes.causes, gap.energy);
  return {.gap = gap,
          .verdict = verdict,
          .causes = causes.causes,
          .ranking = rank_effects(names.probabilities, names.surest),
          .unknowns = unknowns,
          .below_materiality = below_materiality(x, names, validation),
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

/// The steps in their order; each reads what the steps before it found.
Diagnosis diagnose_logs(const Dataset& dataset, const RunsByUse& runs, const DiagnoseOptions& options) {
  const Survey survey = survey_dataset(dataset, runs.signals);
  std::set<std::string> without = survey.invisible_effects;
  without.insert(options.without.begin(), options.without.end());
  const Identification id = identify(runs.diagnosis, without);
  const Examination x{.dataset = dataset, .runs = runs, .id = id};
  const std::vector<OtherPrediction> others = other_predictions(dataset, runs.signals, runs.options);
  const Names names = choose_names(x);
  const Validation validation = validate(x, judge(x, names));
  const Correction correction = correction_of(x, validation);
  Diagnosis d = conclusion(x, names, validation, options.bootstrap);
  d.where = localize_gap(runs.signals, others, x.nominal(), id.equations.noise, options.bootstrap);
  d.next = propose_run(id, dataset.robot, d.causes, d.ranking, d.verdict);
  d.isolability = isolability(read_signals(runs.diagnosis, 0.0), dataset.robot,
                              {id.equations.noise, id.equations.run_variance, id.dispersion},
                              survey.invisible_effects, options.without);
  d.estimated_payload_kg = runs.diagnosis.estimated_payload_kg;
  d.missing_channels = survey.missing_channels;
  d.notes = joined({survey.notes,
                    taken_out(options.without),
                    {told_by_others(runs.signals, others)},
                    d.notes,
                    correction.notes,
                    {told_by_energies(dataset, correction)}});
  d.corrected_robot = correction.robot;
  d.corrected_instruments = correction.instruments;
  return d;
}

}  // namespace

Diagnosis diagnose(const Dataset& dataset, const DiagnoseOptions& options) {
  RunsByUse runs = sort_runs(dataset);
  std::vector<DataCheck> checks = check_data(dataset, runs);
  if (checks.empty()) runs = with_estimated_payloads(std::move(runs));
  Diagnosis diagnosis = !checks.empty()        ? stopped_by(dataset, runs, std::move(checks))
                        : runs.signals.empty() ? diagnose_without_logs(dataset, options)
                                               : diagnose_logs(dataset, runs, options);
  diagnosis.artifacts = artifact_texts(dataset);
  return diagnosis;
}

}  // namespace joulepath
