#include "model/channel_delay.hpp"

namespace joulepath {
namespace {

void delay(const std::vector<double>& time_s, double delay_s, std::vector<double>& channel) {
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

}  // namespace

void delay_motor_channels(Trajectory& log, double delay_s) {
  for (Side side : kSides) {
    delay(log.time_s, delay_s, log.motor_voltage_V[side]);
    delay(log.time_s, delay_s, log.motor_current_A[side]);
  }
}

}  // namespace joulepath
