#pragma once

#include <algorithm>
#include <limits>

namespace joulepath {

/// Least value of f on the square [-4, 0]^2 (natural logarithms of shares of the largest accelerations): a
/// coarse scan, then a pattern search about its best point until the steps are 1e-3. Infinite values are
/// skipped.
struct PatternMinimum {
  double x{};
  double y{};
  double value{std::numeric_limits<double>::infinity()};
};

template <class Function>
[[nodiscard]] PatternMinimum pattern_search(const Function& f) {
  PatternMinimum best;
  const auto sample = [&](double x, double y) {
    x = std::min(0.0, x);
    y = std::min(0.0, y);
    const double value = f(x, y);
    if (!(value < best.value)) return false;
    best = {x, y, value};
    return true;
  };
  for (double x = 0; x > -4.0; x -= 0.5)
    for (double y = 0; y > -4.0; y -= 0.5) sample(x, y);
  if (best.value == std::numeric_limits<double>::infinity()) return best;
  constexpr struct {
    double x, y;
  } kWays[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
  for (double step = 0.25; step > 1e-3;) {
    const PatternMinimum from = best;
    bool better = false;
    for (const auto& way : kWays) better |= sample(from.x + step * way.x, from.y + step * way.y);
    if (!better) step /= 2;
  }
  return best;
}

}  // namespace joulepath
