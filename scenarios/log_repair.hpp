#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// Makes a counter that restarts at 0 at `wraps_at` monotonous; returns the number of restarts.
std::size_t unwrap_counter(std::vector<double>& values, double wraps_at);

/// Makes angles continuous (steps below pi).
void unwrap_angle(std::vector<double>& values);

/// Linear interpolation of (times, values) at `at`, held constant outside.
[[nodiscard]] std::vector<double> interpolated(const std::vector<double>& times,
                                               const std::vector<double>& values,
                                               const std::vector<double>& at);

/// Change per second over the sample period that ends at each time; the first sample repeats the second.
[[nodiscard]] std::vector<double> change_per_second(const std::vector<double>& times,
                                                    const std::vector<double>& values);

/// Replaces NaN by interpolation between neighbors; returns their number.
std::size_t fill_missing(const std::vector<double>& times, std::vector<double>& values);

/// Clock jumps, held values, channels slower than the log: artifacts that affect this run.
[[nodiscard]] std::vector<LogArtifact> find_artifacts(Trajectory& trajectory, const std::string& run);

}  // namespace joulepath
