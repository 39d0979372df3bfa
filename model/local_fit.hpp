#pragma once

#include <vector>

namespace joulepath {

/// Value and slope of a noisy channel at its samples.
struct LocalFit {
  std::vector<double> value{};
  std::vector<double> slope{};
};

/// Least-squares parabola through the samples within +/- `reach_s` of each sample (at least the two
/// neighbors); works on any increasing times. Exact for parabolas.
[[nodiscard]] LocalFit fit_locally(const std::vector<double>& time_s, const std::vector<double>& values,
                                   double reach_s);

/// Standard deviation of white noise on a smooth channel, from the median size of its second differences
/// (a robust measure: corners and steps do not count).
[[nodiscard]] double noise_of(const std::vector<double>& values);
/// The same of the readings of a channel that may be lines between them, at even distances.
[[nodiscard]] double noise_of_readings(const std::vector<double>& values);

}  // namespace joulepath
