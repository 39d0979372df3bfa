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

Eigen::VectorXd since_start(const Eigen::VectorXd& channel) {
  return channel.size() > 0 ? Eigen::VectorXd(channel.array() - channel[0]) : channel;
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
  // From where each run starts: whatever the frame of a pose is.
  floor[kHeading] = kResolution * rms([](const RunSignals& r) { return since_start(r.heading_rad); });
  floor[kPositionX] = floor[kPositionY] =
      kResolution * std::hypot(rms([](const RunSignals& r) { return since_start(r.x_m); }),
                               rms([](const RunSignals& r) { return since_start(r.y_m); }));
  return floor;
}

}  // namespace joulepath
