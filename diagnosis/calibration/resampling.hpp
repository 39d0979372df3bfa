#pragma once

#include <functional>
#include <vector>

namespace joulepath::calibration {

/// Mean-square deviations of estimates under leaving out one unit (a run) at a time.
struct Resampled {
  std::vector<double> standard_deviation{};
};

/// Delete-one jackknife: sigma^2 = (n - 1)/n sum (theta_(i) - mean)^2. `estimate(i)` leaves unit i out. Runs
/// whose own friction or temperature differs make the estimates differ: such scatter is in the result, other
/// than in the covariance of a fit to samples.
[[nodiscard]] Resampled jackknife(std::size_t units,
                                  const std::function<std::vector<double>(std::size_t)>& estimate);

/// 97.5 % quantile of Student's t.
[[nodiscard]] double student_t_975(double degrees_of_freedom);

}  // namespace joulepath::calibration
