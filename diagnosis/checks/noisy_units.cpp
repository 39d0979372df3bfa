#include "diagnosis/checks/noisy_units.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "diagnosis/checks/faults.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/local_fit.hpp"
#include "model/log_columns.hpp"
#include "model/median.hpp"
#include "model/printable.hpp"
// Design: docs/decisions/0500-data-checks.md
namespace joulepath {
namespace {

constexpr double kRounded = 1e-5;  ///< of a value, the rounding of six digits
constexpr double kMostBent = 2.0;  ///< noise of every second sample over that of all: 1 of noise, 4 of motion
constexpr double kMostShared = 0.5;  ///< of a column's noise, what the other columns show as well

using Samples = std::vector<double>;
/// A column of a run.
struct ColumnNoise {
  double noise{}, size{};  ///< standard deviation, and the greatest value
};
using NoiseOfRuns = std::vector<std::map<std::string, ColumnNoise>>;  ///< by column

NoiseOfRuns noise_of_runs(const Dataset& dataset) {
  NoiseOfRuns noise(dataset.runs.size());
  for (std::size_t r = 0; r < dataset.runs.size(); ++r)
    for (const LogColumn& column : log_columns())
      if (const Samples& values = column.of(dataset.runs[r].log); values.size() >= kLeastSamples)
        noise[r][column.name] = {
            noise_of(values),
            std::abs(std::ranges::max(values, {}, [](double value) { return std::abs(value); }))};
  return noise;
}

/// Noise of a run's column over the median of the other runs; none where too few runs have it, where another
/// run is nearly as noisy, and where the column has no noise beyond the rounding of its values.
std::optional<double> noise_ratio(const NoiseOfRuns& noise, std::size_t run, const std::string& column) {
  const auto own = noise[run].find(column);
  Samples others;
  double size = 0;
  for (std::size_t r = 0; r < noise.size(); ++r)
    if (const auto at = noise[r].find(column); r != run && at != noise[r].end())
      others.push_back(at->second.noise), size = std::max(size, at->second.size);
  if (own == noise[run].end() || others.size() + 1 < kLeastRunsToName) return {};
  const double most = std::ranges::max(others), median = upper_median(others);
  if (median < std::max(kLeastSensorNoise, kRounded * size) || own->second.noise < kNoiseApart * most)
    return {};
  return own->second.noise / median;
}

Eigen::VectorXd bends_of(const Samples& values) {
  const auto n = static_cast<Eigen::Index>(values.size());
  const Eigen::Map<const Eigen::VectorXd> of(values.data(), n);
  return of.head(n - 2) - 2 * of.segment(1, n - 2) + of.tail(n - 2);
}

/// Share of a column's second differences that those of the run's other columns explain.
double shared_with_others(const Run& run, const LogColumn& column) {
  const Samples& values = column.of(run.log);
  const Eigen::VectorXd own = bends_of(values);
  std::vector<Eigen::VectorXd> others;
  for (const LogColumn& other : log_columns()) {
    const bool derived = run.wheels_from_body_speeds && other.name.starts_with("wheel_");
    const Samples& of = other.of(run.log);
    if (!other.measured || derived || other.name == column.name || other.name == "time_s" ||
        of.size() != values.size())
      continue;
    const Eigen::VectorXd bends = bends_of(of);
    if (const double norm = bends.norm(); norm > 0 && std::isfinite(norm)) others.push_back(bends / norm);
  }
  if (others.empty() || !(own.squaredNorm() > 0)) return 0;
  const auto count = std::ssize(others);
  Eigen::MatrixXd rows(own.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) rows.col(k) = others[static_cast<std::size_t>(k)];
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(rows);
  const double left = (own - rows * solver.solve(own)).squaredNorm() / own.squaredNorm();
  return 1 - left * static_cast<double>(own.size()) / static_cast<double>(own.size() - count);
}

/// Noise jumps from sample to sample, by as much from one to the next but one, and each column by itself.
/// Motion bends, over two samples four times as much, and shows in several columns.
bool is_noise(const Run& run, const LogColumn& column) {
  const Samples& values = column.of(run.log);
  Samples every_second;
  for (std::size_t i = 0; i < values.size(); i += 2) every_second.push_back(values[i]);
  return noise_of(every_second) < kMostBent * noise_of(values) &&
         shared_with_others(run, column) < kMostShared;
}

bool has_noise_of_unit(const Dataset& dataset, const NoiseOfRuns& noise, std::size_t run,
                       const Fault& fault) {
  return std::ranges::all_of(fault.columns, [&](const ColumnRepair& repair) {
    const std::optional<double> ratio = noise_ratio(noise, run, repair.column);
    return ratio && *ratio * repair.scale > 1 / kOddRatio && *ratio * repair.scale < kOddRatio &&
           is_noise(dataset.runs[run], *find_log_column(repair.column));
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
          (!found || fault.columns.size() > found->columns.size()) &&
          has_noise_of_unit(dataset, noise, r, fault))
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
