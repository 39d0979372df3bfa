#include "diagnosis/signals/resolution.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

constexpr double kLeast = 1e-7;  ///< in the unit of the channel, where all readings are zero

/// Root mean square of a channel over all runs that have it.
template <class Channel>
double root_mean_square(const std::vector<RunSignals>& signals, Channel&& channel) {
  double square = 0, count = 0;
  for (const RunSignals& run : signals) {
    const Eigen::VectorXd& values = channel(run);
    square += values.squaredNorm();
    count += static_cast<double>(values.size());
  }
  return count > 0 ? std::sqrt(square / count) : 0.0;
}

}  // namespace

std::array<double, kChannelCount> resolution_floor(const std::vector<RunSignals>& signals) {
  const auto rms = [&](auto&& channel) { return std::max(kLeast, root_mean_square(signals, channel)); };
  std::array<double, kChannelCount> floor{};
  for (Side side : kSides) {
    const std::size_t s = side == Side::left ? 0 : 1;
    floor[kCurrentLeft + s] =
        kResolution * rms([&](const RunSignals& r) -> const auto& { return r.motor_current_A[side]; });
    floor[kWindingLeft + s] =
        kVoltageResolution * rms([&](const RunSignals& r) -> const auto& { return r.motor_voltage_V[side]; });
  }
  floor[kDriverPower] =
      kResolution * rms([](const RunSignals& r) -> const auto& { return r.battery_power_W; });
  floor[kSupplyVoltage] =
      kVoltageResolution * rms([](const RunSignals& r) -> const auto& { return r.battery_voltage_V; });
  floor[kGyro] = kResolution * rms([](const RunSignals& r) -> const auto& { return r.gyro_yaw_rate_rad_s; });
  floor[kHeading] = kResolution * rms([](const RunSignals& r) -> const auto& { return r.heading_rad; });
  floor[kPositionX] = kResolution * rms([](const RunSignals& r) -> const auto& { return r.x_m; });
  floor[kPositionY] = kResolution * rms([](const RunSignals& r) -> const auto& { return r.y_m; });
  floor[kPositionX] = floor[kPositionY] = std::max(floor[kPositionX], floor[kPositionY]);
  return floor;
}

}  // namespace joulepath
