#include <algorithm>

#include "diagnosis/checks/survey.hpp"
#include "diagnosis/correction/correction.hpp"
#include "diagnosis/correction/validation.hpp"
#include "diagnosis/energies_only/diagnose_energies.hpp"
#include "diagnosis/energies_only/energy_run.hpp"
#include "diagnosis/next_run/next_run.hpp"
#include "diagnosis/signals/split.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "diagnosis/verdict/causes.hpp"
#include "diagnosis/verdict/control.hpp"
#include "diagnosis/verdict/names.hpp"
#include "diagnosis/verdict/verdict.hpp"
#include "diagnosis/where/localize.hpp"

namespace joulepath {
namespace {

constexpr double kMostRows = 12000.0;

/// Long logs are thinned out more: rows, not seconds, cost time and memory.
SignalOptions sampling(const Examination& x) {
  double duration_s = 0;
  for (std::size_t r : x.usable)
    duration_s += x.dataset.runs[r].log.time_s.back() - x.dataset.runs[r].log.time_s.front();
  SignalOptions options;
  options.period_s = std::max(options.period_s, duration_s / kMostRows);
  return options;
}

/// Which runs choose and which judge; what the dataset cannot show at all.
void prepare(Examination& x) {
  const RunSplit split = split_runs(x.dataset, x.usable);
  x.few = x.usable.size() < kLeastRuns || split.diagnosis.size() < kLeastRuns - 1;
  const SignalOptions options = sampling(x);
  x.diagnosis = {.dataset = &x.dataset, .runs = x.few ? x.usable : split.diagnosis, .options = options};
  x.validation = {.dataset = &x.dataset, .runs = x.few ? x.usable : split.validation, .options = options};
  x.all_signals = read_signals({.dataset = &x.dataset, .runs = x.usable, .options = options}, 0.0);
  x.nominal = {.robot = x.dataset.robot};
  const Survey survey = survey_dataset(x.dataset, x.all_signals);
  x.report.missing_channels = survey.missing_channels;
  x.report.notes = survey.notes;
  for (const std::string& effect : x.options.without)
    x.report.notes.push_back(effect + " is taken out of the catalog");
}

void propose_next(Examination& x) {
  std::vector<std::string> rivals;
  for (const Cause& cause : x.report.causes)
    if (!cause.indistinguishable_from.empty()) {
      rivals.push_back(cause.effect.name);
      for (const std::string& label : cause.indistinguishable_from) rivals.push_back(label);
    }
  x.report.next = propose_run(x.id, x.dataset.robot, rivals, x.report.ranking, x.report.verdict);
}

}  // namespace

Diagnosis diagnose(const Dataset& dataset, const DiagnoseOptions& options) {
  Examination x{.dataset = dataset, .options = options};
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    if (has_usable_log(dataset.runs[r])) x.usable.push_back(r);
  x.report.artifacts = artifact_texts(dataset);
  if (x.usable.empty() && std::ranges::any_of(dataset.runs, is_energy_run)) {
    Diagnosis of_energies = diagnose_energies(dataset, options);
    of_energies.artifacts = std::move(x.report.artifacts);
    return of_energies;
  }
  if (x.usable.empty()) {
    x.report.notes.push_back("no run has a log with wheel speeds, nor an energy with its motion");
    return std::move(x.report);
  }
  prepare(x);
  x.id = identify(x.diagnosis, {.without = options.without});
  const std::vector<OtherPrediction> others = other_predictions(x.dataset, x.all_signals, sampling(x));
  if (const std::string told = told_by_others(x.all_signals, others); !told.empty())
    x.report.notes.push_back(told);
  x.report.where = localize_gap(x.all_signals, others, x.nominal, x.id.equations.noise, options.bootstrap);
  choose_names(x);
  rank_effects(x);
  judge(x);
  const Correction correction = validate(x);
  report_gap(x, correction);
  report_causes(x, correction);
  report_control(x);
  write_correction(x, correction.state);
  propose_next(x);
  judge_on_energies(dataset, x.report);
  return std::move(x.report);
}

}  // namespace joulepath
