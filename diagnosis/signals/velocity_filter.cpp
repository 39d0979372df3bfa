#include "diagnosis/signals/velocity_filter.hpp"

#include <cmath>
// Design: docs/decisions/0501-motion.md
namespace joulepath {

std::vector<double> behind_velocity_filter(std::vector<double> channel, double period_s,
                                           double time_constant_s) {
  if (channel.empty() || time_constant_s <= 0) return channel;
  const double length = period_s / time_constant_s, kept = std::exp(-length), mean = (1 - kept) / length;
  double before = channel.front();
  for (std::size_t i = 1; i < channel.size(); ++i) {
    const double now = channel[i];
    channel[i] = kept * channel[i - 1] + (mean - kept) * before + (1 - mean) * now;
    before = now;
  }
  return channel;
}

}  // namespace joulepath
