#include "diagnosis/signals/runs_by_use.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "diagnosis/numerics/folds.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// Greatest payload, kind of manoeuvre, and the sum of what was measured as a tie break.
using Stratum = std::tuple<double, int, double>;

Stratum stratum_of(const Run& run) {
  const Trajectory& log = run.log;
  double turn = 0, forward = 0, sum = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const bool wheels = !log.wheel_speed_rad_s.left.empty();
    const double a = wheels ? log.wheel_speed_rad_s.left[i] : log.linear_speed_m_s[i];
    const double b = wheels ? log.wheel_speed_rad_s.right[i] : log.angular_speed_rad_s[i];
    turn += wheels ? std::abs(b - a) : std::abs(b);
    forward += wheels ? std::abs(a + b) : std::abs(a);
    sum += std::abs(a) + std::abs(b);
  }
  const int kind = turn > forward ? 2 : turn > 0.1 * forward ? 1 : 0;
  return {log.payload_kg.empty() ? 0.0 : *std::ranges::max_element(log.payload_kg), kind, sum};
}

struct RunSplit {
  std::vector<std::size_t> diagnosis{};  ///< indices into Dataset::runs, in the dataset's order
  std::vector<std::size_t> validation{};
};

/// `use:` where a dataset says it; else about every fourth run, spread over payloads and manoeuvres.
RunSplit split_runs(const Dataset& dataset, const std::vector<std::size_t>& usable) {
  RunSplit split;
  std::vector<std::size_t> open;
  for (std::size_t r : usable) {
    if (dataset.runs[r].use == RunUse::validation) split.validation.push_back(r);
    if (dataset.runs[r].use == RunUse::diagnosis) split.diagnosis.push_back(r);
    if (dataset.runs[r].use == RunUse::any) open.push_back(r);
  }
  const bool told = !split.validation.empty();
  if (!told) {
    std::vector<Stratum> strata;
    for (std::size_t r : open) strata.push_back(stratum_of(dataset.runs[r]));
    const std::vector<std::size_t> fold_of = dealt_folds(strata, kHeldOutEvery);
    for (std::size_t k = 0; k < open.size(); ++k)
      (fold_of[k] == 2 && usable.size() >= kLeastRunsToName ? split.validation : split.diagnosis)
          .push_back(open[k]);
  } else {
    split.diagnosis.insert(split.diagnosis.end(), open.begin(), open.end());
  }
  std::sort(split.diagnosis.begin(), split.diagnosis.end());
  std::sort(split.validation.begin(), split.validation.end());
  return split;
}

/// Long logs are thinned out more: rows, not seconds, cost time and memory.
SignalOptions sampling(const Dataset& dataset, const std::vector<std::size_t>& usable) {
  double duration_s = 0;
  for (std::size_t r : usable)
    duration_s += dataset.runs[r].log.time_s.back() - dataset.runs[r].log.time_s.front();
  SignalOptions options;
  options.period_s = std::clamp(duration_s / kMostRows, options.period_s, kCoarsestPeriod_s);
  return options;
}

}  // namespace

RunsByUse sort_runs(const Dataset& dataset) {
  std::vector<std::size_t> usable;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    if (has_usable_log(dataset.runs[r])) usable.push_back(r);
  const RunSplit split = split_runs(dataset, usable);
  RunsByUse runs;
  runs.few = usable.size() < kLeastRunsToName || split.diagnosis.size() < kLeastRunsToName - 1;
  runs.options = sampling(dataset, usable);
  const auto logs = [&](const std::vector<std::size_t>& which) {
    return LogSet{.dataset = &dataset, .runs = which, .options = runs.options};
  };
  runs.diagnosis = logs(runs.few ? usable : split.diagnosis);
  runs.validation = logs(runs.few ? usable : split.validation);
  runs.signals = read_signals(logs(usable), 0.0);
  return runs;
}

}  // namespace joulepath
