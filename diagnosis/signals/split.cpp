#include "diagnosis/signals/split.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace joulepath {
namespace {

/// Payload, kind of manoeuvre, and the sum of what was measured as a tie break.
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
  return {log.payload_kg.empty() ? 0.0 : log.payload_kg.front(), kind, sum};
}

}  // namespace

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
    std::vector<std::size_t> order(open.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return strata[a] < strata[b]; });
    for (std::size_t k = 0; k < order.size(); ++k)
      (k % 4 == 2 && usable.size() >= kLeastRuns ? split.validation : split.diagnosis)
          .push_back(open[order[k]]);
  } else {
    split.diagnosis.insert(split.diagnosis.end(), open.begin(), open.end());
  }
  std::sort(split.diagnosis.begin(), split.diagnosis.end());
  std::sort(split.validation.begin(), split.validation.end());
  return split;
}

}  // namespace joulepath
