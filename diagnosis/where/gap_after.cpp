#include "diagnosis/where/gap_after.hpp"

#include <algorithm>

#include "diagnosis/signals/runs_by_use.hpp"
#include "diagnosis/simulator/simulated_runs.hpp"
#include "diagnosis/where/gap.hpp"
// Design: docs/decisions/0514-the-users-simulator.md
namespace joulepath {
namespace {

std::vector<RunSignals> signals_of(const Dataset& dataset, const std::vector<std::string>& held_out) {
  const ComparedRuns compared = compare_runs(dataset, dataset.robot);
  std::vector<RunSignals> signals = sort_runs(compared.dataset).signals;
  std::erase_if(signals, [&](const RunSignals& run) { return std::ranges::count(held_out, run.name) == 0; });
  return signals;
}

}  // namespace

GapAfter gap_after(const Dataset& before, const Dataset& after, const std::vector<std::string>& held_out,
                   double noise_floor_percent, double battery_floor_percent, std::size_t bootstrap) {
  const std::vector<RunSignals> old_signals = signals_of(before, held_out),
                                new_signals = signals_of(after, held_out), none;
  const ModelPoint model{.robot = before.robot};
  GapAfter result{.gap = measure_gap({.before_signals = old_signals,
                                      .after_signals = new_signals,
                                      .before = model,
                                      .after = ModelPoints(new_signals.size(), model),
                                      .noise_floor_percent = noise_floor_percent,
                                      .battery_floor_percent = battery_floor_percent,
                                      .bootstrap = bootstrap,
                                      .fitted_signals = none,
                                      .fitted = model})};
  for (const RunSignals& run : old_signals) result.runs.push_back(run.name);
  return result;
}

}  // namespace joulepath
