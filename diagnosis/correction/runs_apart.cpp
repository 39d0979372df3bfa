#include "diagnosis/correction/runs_apart.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {

std::vector<RunPower> run_powers(const Examination& x, const Validation& v,
                                 const std::vector<std::size_t>& more) {
  LogSet logs = x.runs.diagnosis;
  const auto add = [&](std::size_t r) {
    if (std::ranges::count(logs.runs, r) == 0) logs.runs.push_back(r);
  };
  std::ranges::for_each(x.runs.validation.runs, add);
  std::ranges::for_each(more, add);
  const std::vector<RunSignals> signals = read_signals(logs, channel_delay_s(v.fitted.state));
  const std::vector<RunEnergy> energies =
      run_energies(signals, ModelPoints(signals.size(), x.point_of(v.fitted.state)));
  std::vector<RunPower> powers;
  for (std::size_t r = 0; r < signals.size(); ++r) {
    const double duration_s = signals[r].period_s * static_cast<double>(signals[r].size());
    if (duration_s > 0 && energies[r].measured_J != 0)
      powers.push_back({logs.runs[r], energies[r].measured_J / duration_s, energies[r].predicted_J / duration_s});
  }
  return powers;
}

std::set<std::size_t> runs_apart(std::vector<RunPower> powers, double ratio, double noise_floor_percent) {
  const std::size_t most = std::max<std::size_t>(1, powers.size() / 10);
  if (powers.size() < most + kLeastRunsToName) return {};
  std::ranges::sort(powers, std::ranges::greater{}, &RunPower::gap_W);
  double mean_W = 0;
  for (const RunPower& power : powers) mean_W += std::abs(power.measured_W) / static_cast<double>(powers.size());
  const double least_W = mean_W * std::max(kLeastApart, noise_floor_percent / 100);
  for (std::size_t k = 1; k <= most; ++k) {
    if (powers[k - 1].gap_W() < std::max(least_W, ratio * powers[k].gap_W())) continue;
    std::set<std::size_t> apart;
    for (std::size_t r = 0; r < k; ++r) apart.insert(powers[r].run);
    return apart;
  }
  return {};
}

}  // namespace joulepath
