#include "scenarios/text/significant.hpp"

#include <cmath>

namespace joulepath {

double six_digits(double value) {
  if (!std::isfinite(value) || value == 0) return 0.0;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

}  // namespace joulepath
