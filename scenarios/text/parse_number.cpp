#include <charconv>
#include <cmath>

#include "model/number_text.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/significant.hpp"

// Numbers from and to text by <charconv>, which some libraries lack for floating-point numbers.

namespace joulepath {

std::optional<double> parse_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && (text.front() == '-' || text.front() == '+')) return std::nullopt;
  }
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string significant_text(double value) { return number_text(six_digits(value)); }

}  // namespace joulepath
