#include "scenarios/significant.hpp"

#include <charconv>
#include <cmath>

namespace joulepath {

double six_digits(double value) {
  if (!std::isfinite(value) || value == 0) return 0.0;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

std::string significant_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, six_digits(value)).ptr;
  return {buffer, end};
}

}  // namespace joulepath
