#include "diagnosis/where/gap_ledger.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/numerics/resample.hpp"
#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

GapAmount sum_over(const std::vector<GapAmount>& cell, const std::vector<std::size_t>& runs) {
  GapAmount sum;
  for (std::size_t r : runs) sum.add(cell[r]);
  return sum;
}

}  // namespace

void GapAmount::add(const GapAmount& more) {
  gap_J += more.gap_J, noise_J += more.noise_J, signed_J += more.signed_J, measured_J += more.measured_J;
}

void GapLedger::book(const std::string& axis, const std::string& value, std::size_t run,
                     const GapAmount& amount) {
  std::vector<GapAmount>& cell = axes_[axis][value];
  if (cell.empty()) cell.resize(runs_);
  cell[run].add(amount);
}

std::vector<WhereCell> GapLedger::cells(const std::vector<std::string>& axes, std::size_t bootstrap) const {
  std::vector<WhereCell> all;
  for (const std::string& axis : axes) {
    const auto found = axes_.find(axis);
    if (found == axes_.end()) continue;
    const std::vector<WhereCell> of_axis = cells_of(axis, found->second, bootstrap);
    all.insert(all.end(), of_axis.begin(), of_axis.end());
  }
  return all;
}

std::vector<WhereCell> GapLedger::cells_of(const std::string& axis, const Cells& cells,
                                           std::size_t bootstrap) const {
  const auto shares = [&](const std::vector<std::size_t>& runs, std::vector<double>& share) {
    double total = 0;
    std::size_t k = 0;
    for (const auto& [value, cell] : cells) total += share[k++] = sum_over(cell, runs).excess_J();
    for (double& s : share) s = total > 0 ? s / total : 0.0;
  };
  const bool many = cells.size() > kManyCells;
  std::vector<double> share(cells.size());
  shares(every(runs_), share);
  const std::vector<Range95> intervals =
      bootstrap_intervals(runs_, many ? bootstrap / 4 : bootstrap, cells.size(), shares);
  std::vector<WhereCell> result;
  for (const auto& [value, cell] : cells) {
    const GapAmount sum = sum_over(cell, every(runs_));
    const std::size_t k = result.size();
    WhereCell where{.axis = axis, .value = value, .share_of_gap = share[k], .energy_J = sum.excess_J()};
    if (sum.measured_J > 0) where.bias_percent = 100 * sum.signed_J / sum.measured_J;
    if (!many || share[k] > kNegligibleShare) where.interval_95 = intervals[k];
    result.push_back(std::move(where));
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const WhereCell& a, const WhereCell& b) { return a.share_of_gap > b.share_of_gap; });
  return result;
}

std::string range_text(double low, double high, const char* unit) {
  char text[160];
  std::snprintf(text, sizeof text, "%g to %g %s", low, high, unit);
  return text;
}

std::string number_text(double value, const char* unit) {
  char text[96];
  std::snprintf(text, sizeof text, "%g %s", std::round(100 * value) / 100, unit);
  return text;
}

}  // namespace joulepath
