#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

// Method: [Steele2014]
namespace blind {

/// A small counter-based generator (SplitMix64): the same numbers on every machine and library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 0x1234567ULL) { next(); }

  std::uint64_t next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  double uniform() { return (static_cast<double>(next() >> 11) + 0.5) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double log_uniform(double low, double high) { return low * std::exp(std::log(high / low) * uniform()); }
  double sign() { return uniform() < 0.5 ? -1.0 : 1.0; }
  int below(int n) { return static_cast<int>(uniform() * n); }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  /// Student's t with `freedom` degrees of freedom, scaled to unit variance (freedom > 2).
  double student(int freedom) {
    double chi = 0;
    for (int k = 0; k < freedom; ++k) {
      const double x = normal();
      chi += x * x;
    }
    return normal() / std::sqrt(chi / freedom) * std::sqrt((freedom - 2.0) / freedom);
  }

 private:
  std::uint64_t state_;
};

}  // namespace blind
