#include "diagnosis/signals/runs_by_use.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "diagnosis/numerics/folds.hpp"
#include "diagnosis/signals/kernel_width.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/constant_payload.hpp"

namespace joulepath {
namespace {

/// Kind of manoeuvre, payload, and the sum of what was measured as a tie break: rare manoeuvres are spread
/// first.
using Stratum = std::tuple<int, double, double>;

Stratum stratum_of(const Run& run) {
  const Trajectory& log = run.log;
  double turn = 0, forward = 0, backward = 0, sum = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const bool wheels = !log.wheel_speed_rad_s.left.empty();
    const double a = wheels ? log.wheel_speed_rad_s.left[i] : log.linear_speed_m_s[i];
    const double b = wheels ? log.wheel_speed_rad_s.right[i] : log.angular_speed_rad_s[i];
    turn += wheels ? std::abs(b - a) : std::abs(b);
    const double along = wheels ? a + b : a;
    (along < 0 ? backward : forward) += std::abs(along);
    sum += std::abs(a) + std::abs(b);
  }
  const double travelled = forward + backward;
  const int turning = turn > travelled ? 2 : turn > kTurningRun * travelled ? 1 : 0;
  const int kind = turning + (backward > forward ? 3 : 0);
  return {kind, log.payload_kg.empty() ? constant_payload_kg(run) : *std::ranges::max_element(log.payload_kg),
          sum};
}

std::vector<std::size_t> folds_of(const Dataset& dataset, const std::vector<std::size_t>& runs) {
  std::vector<Stratum> strata;
  for (std::size_t r : runs) strata.push_back(stratum_of(dataset.runs[r]));
  return dealt_folds(strata, std::min(kFolds, runs.size()));
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

RunsByUse sort_runs(const Dataset& dataset, const std::set<std::size_t>& left_out) {
  std::vector<std::size_t> usable;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    if (has_usable_log(dataset.runs[r]) && !left_out.contains(r)) usable.push_back(r);
  std::vector<std::size_t> fitted, judged;
  for (std::size_t r : usable) (dataset.runs[r].use == RunUse::validation ? judged : fitted).push_back(r);
  RunsByUse runs;
  runs.few = usable.size() < kLeastRunsToName || fitted.size() < kLeastRunsToName - 1;
  runs.options = sampling(dataset, usable);
  widen_kernel(dataset, usable, runs.options);
  const auto logs = [&](const std::vector<std::size_t>& which) {
    return LogSet{.dataset = &dataset, .runs = which, .options = runs.options};
  };
  runs.diagnosis = logs(runs.few ? usable : fitted);
  runs.validation = logs(runs.few || judged.empty() ? runs.diagnosis.runs : judged);
  if (!runs.few && judged.empty()) runs.fold_of = folds_of(dataset, fitted);
  runs.signals = read_signals(logs(usable), 0.0);
  return runs;
}

std::size_t fold_count(const RunsByUse& runs) {
  return runs.fold_of.empty() ? 0 : *std::ranges::max_element(runs.fold_of) + 1;
}

std::vector<std::size_t> fitted_runs(const RunsByUse& runs, std::size_t fold) {
  std::vector<std::size_t> fitted;
  for (std::size_t r = 0; r < runs.diagnosis.runs.size(); ++r)
    if (runs.fold_of.empty() || runs.fold_of[r] != fold) fitted.push_back(r);
  return fitted;
}

}  // namespace joulepath
