#pragma once

#include <array>
#include <vector>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The electrical channels come late: they are stamped on arrival, or buffered.
struct TimeMisalignment {
  double delay_s{};

  static constexpr EffectInfo info{.name = "time_misalignment",
                                   .kind = "instruments",
                                   .stage = Stage::instrument,
                                   .law = "motor voltage and current channels show the value of delay_s ago",
                                   .validity = "logs only; delays shorter than the run",
                                   .source = "-",
                                   .gazebo = "sensor latency of the log",
                                   .mujoco = "sensor delay of the log"};
  static constexpr auto parameters() {
    return std::array{EffectParameter<TimeMisalignment>{
        "delay_s", "s", -5, 5, 0.05, "age of the electrical readings", &TimeMisalignment::delay_s}};
  }

  void distort(Trajectory& log) const {
    for (Side side : kSides) {
      delay(log.time_s, log.motor_voltage_V[side]);
      delay(log.time_s, log.motor_current_A[side]);
    }
  }

 private:
  /// Value at time_s - delay_s by linear interpolation, held at the ends.
  void delay(const std::vector<double>& time_s, std::vector<double>& channel) const {
    if (channel.empty()) return;
    const std::vector<double> original = channel;
    std::size_t k = 0;
    for (std::size_t i = 0; i < channel.size(); ++i) {
      const double t = time_s[i] - delay_s;
      while (k + 2 < time_s.size() && time_s[k + 1] <= t) ++k;
      const double u = (t - time_s[k]) / (time_s[k + 1] - time_s[k]);
      channel[i] = u <= 0   ? original[k]
                   : u >= 1 ? original[k + 1]
                            : original[k] + u * (original[k + 1] - original[k]);
    }
  }
};

}  // namespace joulepath
