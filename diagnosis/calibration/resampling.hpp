#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

namespace joulepath::calibration {

/// With fewer units no interval is reported.
inline constexpr std::size_t kFewestUnits = 4;

/// Scatter of estimates from leaving out one unit (a run) at a time.
struct Resampled {
  std::vector<double> standard_deviation{};
  Eigen::MatrixXd covariance{};
};

/// Delete-one jackknife: C = (n - 1)/n sum (theta_(i) - mean)(theta_(i) - mean)^T. `estimate(i)` leaves unit
/// i out. The result includes the scatter between runs (friction, temperature), which the covariance of a fit
/// to samples does not include.
[[nodiscard]] Resampled jackknife(std::size_t units,
                                  const std::function<std::vector<double>(std::size_t)>& estimate);

}  // namespace joulepath::calibration
