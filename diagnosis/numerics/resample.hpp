#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

// Method: [Efron1979], [Steele2014]
namespace joulepath {

/// A small deterministic generator (splitmix64) with the same bytes on every platform.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t count) {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<std::size_t>((z ^ (z >> 31)) % count);
  }

 private:
  std::uint64_t state_;
};

/// 95 % intervals of `count` statistics over `draws` resamples of whole runs, with replacement.
/// statistics(runs, values) computes the values of one resample.
template <class Statistics>
std::vector<std::pair<double, double>> bootstrap_intervals(std::size_t runs, std::size_t draws,
                                                           std::size_t count, Statistics&& statistics) {
  std::vector<std::pair<double, double>> intervals(count);
  if (runs == 0 || draws == 0) return intervals;
  Dice dice(20200101);
  std::vector<std::vector<double>> values(count, std::vector<double>(draws));
  std::vector<std::size_t> chosen(runs);
  std::vector<double> drawn(count);
  for (std::size_t d = 0; d < draws; ++d) {
    for (std::size_t& r : chosen) r = dice.below(runs);
    statistics(chosen, drawn);
    for (std::size_t k = 0; k < count; ++k) values[k][d] = drawn[k];
  }
  for (std::size_t k = 0; k < count; ++k) {
    std::sort(values[k].begin(), values[k].end());
    const auto at = [&](double q) {
      return values[k][static_cast<std::size_t>(q * static_cast<double>(draws - 1))];
    };
    intervals[k] = {at(0.025), at(0.975)};
  }
  return intervals;
}

/// 95 % interval of statistic(runs).
template <class Statistic>
std::pair<double, double> bootstrap_interval(std::size_t runs, std::size_t draws, Statistic&& statistic) {
  return bootstrap_intervals(runs, draws, 1,
                             [&](const std::vector<std::size_t>& chosen, std::vector<double>& value) {
                               value[0] = statistic(chosen);
                             })
      .front();
}

}  // namespace joulepath
