#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace joulepath {

/// A small deterministic generator (splitmix64): results must be the same bytes everywhere.
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

/// 95 % interval of statistic(runs) over `draws` resamples of whole runs, with replacement.
template <class Statistic>
std::pair<double, double> bootstrap_interval(std::size_t runs, std::size_t draws, Statistic&& statistic) {
  if (runs == 0 || draws == 0) return {0.0, 0.0};
  Dice dice(20200101);
  std::vector<double> values;
  std::vector<std::size_t> chosen(runs);
  for (std::size_t d = 0; d < draws; ++d) {
    for (std::size_t& r : chosen) r = dice.below(runs);
    values.push_back(statistic(chosen));
  }
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  };
  return {at(0.025), at(0.975)};
}

}  // namespace joulepath
