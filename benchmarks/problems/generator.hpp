#pragma once

#include <random>

#include "benchmarks/problems/problem.hpp"

namespace joulepath::problems {

inline constexpr const char* kKinds[] = {"straight", "bend", "corners", "tight_corners"};

/// The kinds of problems of a stream.
enum class Part { paths, turns, jerk };

/// Seeded random problems; a problem depends on the seed and on the problems before it only. The time goal is
/// least time: deadlines are set after the solve.
class Generator {
 public:
  Generator(unsigned seed, std::vector<Robot> robots) : random_(seed), robots_(std::move(robots)) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  std::size_t choice(std::size_t count) { return random_() % count; }
  [[nodiscard]] Problem next(std::size_t index, Part part);

 private:
  PathPiece turn();
  /// Wide robots turn less tightly, so lengths grow with the track.
  Knots straight();
  Knots bend(double scale);
  Knots corners(double radius_m);
  void vary_limits(Limits& limits);

  std::mt19937 random_;
  std::vector<Robot> robots_;
};

}  // namespace joulepath::problems
