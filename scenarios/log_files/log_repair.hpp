#pragma once

#include <map>
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

/// The time in which readings tell a channel: from the first to the last, and one usual step on either side.
struct KnownTime {
  double begin_s{}, end_s{};

  /// `times`: at least two.
  explicit KnownTime(const std::vector<double>& times);
  [[nodiscard]] bool covers(double time_s) const { return begin_s <= time_s && time_s <= end_s; }
};

/// What holds before a channel's first reading and after its last.
enum class Ends {
  held,    ///< the reading
  unknown  ///< NaN; a channel of one reading is none
};

/// Replaces NaN by interpolation between neighbors; returns the number of values that it filled in, or that
/// an emptied channel has.
std::size_t fill_missing(const std::vector<double>& times, std::vector<double>& values, Ends ends);

/// Equal readings in a row, zeros aside (a robot at rest).
struct Hold {
  double from_s{};
  double to_s{};
  std::size_t length{};
};

/// The holds of a channel. A log of a day has millions of them: the short ones are only counted.
struct Holds {
  std::size_t count{};
  std::map<std::size_t, std::size_t> count_of_length{};
  std::vector<Hold> of_reported_length{};
  bool fine_steps{};  ///< almost every change brings a new value; examined where holds are reported or usual

  [[nodiscard]] std::size_t median_length() const;
};

/// Of a channel's own readings: what fills the rows between them says nothing of its sensor.
[[nodiscard]] Holds holds_of(const std::vector<double>& times, const std::vector<double>& readings);
using HoldsOfChannel = std::map<std::string, Holds>;

/// Clock jumps, held values, channels slower than the log: artifacts that affect this run. `of_own_readings`:
/// of channels that are interpolated in the trajectory.
[[nodiscard]] std::vector<LogArtifact> find_artifacts(Trajectory& trajectory,
                                                      const HoldsOfChannel& of_own_readings,
                                                      const std::string& run);

}  // namespace joulepath
