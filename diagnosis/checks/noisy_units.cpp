#include "diagnosis/checks/noisy_units.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

#include "diagnosis/checks/faults.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/local_fit.hpp"
#include "model/log_columns.hpp"
#include "model/printable.hpp"
// Design: docs/decisions/0500-data-checks.md
namespace joulepath {
namespace {

using NoiseOfRuns = std::vector<std::map<std::string, double>>;  ///< by column

NoiseOfRuns noise_of_runs(const Dataset& dataset) {
  NoiseOfRuns noise(dataset.runs.size());
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    for (const LogColumn& column : log_columns())
      if (const std::vector<double>& values = column.of(dataset.runs[r].log); values.size() >= kLeastSamples)
        noise[r][column.name] = noise_of(values);
  return noise;
}

/// Noise of a run's column over the median of the other runs; none where too few runs have it, where another
/// run is nearly as noisy, and where the column has no noise: third differences then show the motion.
std::optional<double> noise_ratio(const NoiseOfRuns& noise, std::size_t run, const std::string& column) {
  const auto own = noise[run].find(column);
  std::vector<double> others;
  for (std::size_t r = 0; r < noise.size(); ++r)
    if (const auto at = noise[r].find(column); r != run && at != noise[r].end()) others.push_back(at->second);
  if (own == noise[run].end() || others.size() + 1 < kLeastRunsToName) return {};
  const auto middle = others.begin() + static_cast<std::ptrdiff_t>(others.size() / 2);
  std::ranges::nth_element(others, middle);
  const double most = std::ranges::max(others), median = *middle;
  if (median < kLeastSensorNoise || own->second < kNoiseApart * most) return {};
  return own->second / median;
}

bool has_noise_of_unit(const NoiseOfRuns& noise, std::size_t run, const Fault& fault) {
  return std::ranges::all_of(fault.columns, [&](const ColumnRepair& repair) {
    const std::optional<double> ratio = noise_ratio(noise, run, repair.column);
    return ratio && *ratio * repair.scale > 1 / kOddRatio && *ratio * repair.scale < kOddRatio;
  });
}

}  // namespace

std::vector<DataCheck> noisy_units(const Dataset& dataset) {
  const NoiseOfRuns noise = noise_of_runs(dataset);
  std::vector<DataCheck> checks;
  for (std::size_t r = 0; r < dataset.runs.size(); ++r) {
    std::optional<Fault> found;  // left and right together rather than one of them
    for (const Fault& fault : possible_faults(dataset.runs[r]))
      if (fault.kind == "unit" && fault.columns.front().scale * kLeastNoiseOfUnit <= 1 &&
          (!found || fault.columns.size() > found->columns.size()) && has_noise_of_unit(noise, r, fault))
        found = fault;
    if (!found) continue;
    const std::string& column = found->columns.front().column;
    checks.push_back({.runs = {r},
                      .run = dataset.runs[r].name,
                      .channel = found->channel,
                      .kind = found->kind,
                      .evidence = "noise of " + column + ": " +
                                  four_digits(noise_ratio(noise, r, column).value_or(0)) +
                                  " times that of the other runs",
                      .columns = found->columns});
  }
  return checks;
}

}  // namespace joulepath
