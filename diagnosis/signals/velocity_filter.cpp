#include "diagnosis/signals/velocity_filter.hpp"

#include <cmath>
// Design: docs/decisions/0501-motion.md
namespace joulepath {

std::vector<double> behind_velocity_filter(std::vector<double> channel, const std::vector<double>& time_s,
                                           double time_constant_s) {
  if (channel.empty() || time_constant_s <= 0) return channel;
  double before = channel.front();
  for (std::size_t i = 1; i < channel.size(); ++i) {
    const double length = (time_s[i] - time_s[i - 1]) / time_constant_s, kept = std::exp(-length),
                 mean = (1 - kept) / length, now = channel[i];
    channel[i] = kept * channel[i - 1] + (mean - kept) * before + (1 - mean) * now;
    before = now;
  }
  return channel;
}

std::vector<double> before_velocity_filter(const std::vector<double>& filtered,
                                           const std::vector<double>& time_s, double time_constant_s) {
  if (filtered.size() < 2 || time_constant_s <= 0) return filtered;
  std::vector<double> given(filtered.size());  // in the period that ends with a sample
  for (std::size_t i = 1; i < given.size(); ++i) {
    const double kept = std::exp(-(time_s[i] - time_s[i - 1]) / time_constant_s);
    given[i] = (filtered[i] - kept * filtered[i - 1]) / (1 - kept);
  }
  given.front() = given[1];
  for (std::size_t i = 0; i + 1 < given.size(); ++i) given[i] = 0.5 * (given[i] + given[i + 1]);
  return given;
}

}  // namespace joulepath
