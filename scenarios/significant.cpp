#include "scenarios/significant.hpp"

#include <cmath>
#include <cstdio>

namespace joulepath {

double six_digits(double value) {
  if (!std::isfinite(value) || value == 0) return 0.0;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

std::string four_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace joulepath
