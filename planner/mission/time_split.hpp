#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace joulepath {

/// Legs that share deadlines. All times count from the start of the mission.
struct TimeSplitRequest {
  std::size_t legs{};
  /// Driving time (s) of a leg at a price (W) of a second; it falls as the price rises. An infinite price
  /// gives the minimum time.
  std::function<double(std::size_t leg, double price_W)> duration_s{};
  /// A time (s) below which no drive of a leg is.
  std::function<double(std::size_t leg)> least_s{};
  std::vector<double> latest_arrival_s{};    ///< per leg; infinite where there is no deadline
  std::vector<double> earliest_arrival_s{};  ///< per leg; 0 if there is none: the robot waits at the stop
  std::vector<double> dwell_s{};             ///< per leg, after arrival
  double lowest_price_W{};                   ///< the price without a binding deadline or window
  double waiting_price_W{};  ///< the price where the robot waits in any case: minus the standby power, nearly
};

/// The price of a second on each leg, and the resulting times.
struct TimeSplit {
  struct Late {
    std::size_t leg{};
    double amount_s{};  ///< the excess of the minimum time over the deadline
  };
  std::vector<double> price_W{};
  std::vector<double> duration_s{};
  std::vector<double> arrival_s{};
  std::optional<Late> late{};  ///< set when a deadline cannot be met at any price
};

/// Shares deadlines and windows of a chain of legs so that the sum of the legs' energies and of the standby
/// energy while waiting is least: legs that can trade time have the same price of a second, the price falls
/// only after a deadline that binds, and rises only after a window whose opening binds.
///
///   minimize sum E_j(T_j) + P0 sum wait_j + floor arrival_n   subject to   earliest_k <= arrival_k <=
///   latest_k
///
/// With convex E_j the multipliers are dE_j/dT_j = -price_j, and prices differ across a stop by the
/// multiplier of its bound only: the path of the arrivals is a taut string between the bounds.
[[nodiscard]] TimeSplit split_time(const TimeSplitRequest& request);

}  // namespace joulepath
