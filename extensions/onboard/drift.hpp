#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diagnosis/calibration/calibration.hpp"

// Design: docs/decisions/0511-calibration.md
namespace joulepath {

struct DriftSettings {
  double false_alarm_rate{0.01};  ///< probability that the last day is reported although nothing drifted
  std::size_t draws{20000};       ///< of the simulation that finds the threshold
  std::uint64_t seed{1};
};

/// One constant, from the first day (the calibrated one) to the last.
struct ParameterDrift {
  std::string name{}, unit{};
  double reference{};       ///< on the first day
  double value{};           ///< weighted mean from day `since` to the last one
  double standard_error{};  ///< of value - reference
  std::size_t since{};      ///< the day from which on the change shows most
  std::size_t days{};       ///< that determine it, without the first
  double statistic{};       ///< |value - reference| / standard_error
  double threshold{};       ///< of the statistic
  double detectable{};      ///< change since the second day that is found tonight with a probability of 80 %
  bool drifted{};
};

/// A constant that the first or the last day does not determine.
struct NotCompared {
  std::string name{};
  std::vector<std::size_t> days{};  ///< of the first and the last one, those that do not determine it
  std::string why{};                ///< of the first of them, as the calibration says it
  std::string needs{};              ///< runs, manoeuvres or channels that show it
};

struct DriftResult {
  std::vector<ParameterDrift> parameters{};
  std::vector<NotCompared> not_compared{};

  [[nodiscard]] bool drifted() const;
  [[nodiscard]] bool can_tell() const { return !parameters.empty(); }
};

/// Looks for constants that the last day has otherwise than the first one. `days`: each day's calibration,
/// oldest first, at least two.
///
/// For a constant with estimates x_d and standard deviations s_d on days d = 0..n, the statistic is
///   max_k |m_k - x_0| / sqrt(1/W_k + s_0^2),  W_k = sum_{d=k..n} 1/s_d^2,  m_k the weighted mean from day k
///   on,
/// the generalized likelihood ratio for a step at an unknown day. Its threshold is a quantile in simulated
/// days without drift, whose s_d scatter as those of the same number of runs. Each of m constants alone may
/// raise a false alarm with 1 - (1 - rate)^(1/m): that makes the rate for independent constants, and no more
/// than about the rate for others.
[[nodiscard]] DriftResult find_drift(const std::vector<std::vector<CalibratedParameter>>& days,
                                     const DriftSettings& settings = {});

}  // namespace joulepath
