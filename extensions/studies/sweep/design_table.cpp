#include "extensions/studies/sweep/design_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "model/number_text.hpp"

namespace joulepath {
namespace {

/// The text of a parameter at a fraction of its range or of its list of levels.
std::string text_at(const SweepParameter& parameter, double fraction) {
  if (parameter.is_range()) return number_text(parameter.at(fraction));
  const auto count = parameter.levels.size();
  return parameter
      .levels[std::min(count - 1, static_cast<std::size_t>(fraction * static_cast<double>(count)))];
}

/// The number of at most 12 digits within the rounding errors of a level: 0.9 in place of 0.8999999999999999.
double without_rounding_error(const SweepParameter& parameter, double level) {
  const double size = parameter.logarithmic ? 4 * std::abs(level)  // errors of pow() grow with the ratio
                                            : std::max(std::abs(parameter.from), std::abs(parameter.to));
  const double error = 4 * std::numeric_limits<double>::epsilon() * size;
  if (std::abs(level) <= error) return 0.0;
  char digits[32];
  const char* end = std::to_chars(digits, digits + sizeof digits, level, std::chars_format::general, 12).ptr;
  double rounded{};
  std::from_chars(digits, end, rounded);
  return std::abs(rounded - level) <= error ? rounded : level;
}

/// A uniform number in [0, 1) with 53 bits; the standard's distributions differ between libraries.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

double SweepParameter::at(double fraction) const {
  if (fraction <= 0) return from;
  if (fraction >= 1) return to;
  return logarithmic ? from * std::pow(to / from, fraction) : from + fraction * (to - from);
}

double SweepParameter::fraction_of(double value) const {
  const double fraction =
      logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
  return std::clamp(fraction, 0.0, 1.0);
}

DesignTable DesignTable::grid(std::vector<SweepParameter> parameters) {
  DesignTable table;
  table.size_ = 1;
  for (SweepParameter& parameter : parameters) {
    if (parameter.is_range()) {
      const double last = static_cast<double>(std::max<std::size_t>(parameter.count, 2) - 1);
      std::vector<std::string> levels;
      for (std::size_t i = 0; i < parameter.count; ++i)
        levels.push_back(
            number_text(without_rounding_error(parameter, parameter.at(static_cast<double>(i) / last))));
      parameter.levels = std::move(levels);
    }
    table.size_ *= parameter.levels.size();
  }
  table.parameters_ = std::move(parameters);
  return table;
}

DesignTable DesignTable::latin_hypercube(std::vector<SweepParameter> parameters, std::size_t count,
                                         std::uint64_t seed) {
  DesignTable table;
  table.size_ = count;
  std::mt19937_64 random(seed);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    std::vector<double> fractions(count);
    for (std::size_t k = 0; k < count; ++k)
      fractions[k] = (static_cast<double>(k) + uniform(random)) / static_cast<double>(count);
    for (std::size_t k = count; k-- > 1;) std::swap(fractions[k], fractions[random() % (k + 1)]);
    table.fractions_.push_back(std::move(fractions));
  }
  table.parameters_ = std::move(parameters);
  return table;
}

std::vector<std::string> DesignTable::at(std::size_t index) const {
  std::vector<std::string> design(parameters_.size());
  for (std::size_t p = parameters_.size(); p-- > 0;) {
    const SweepParameter& parameter = parameters_[p];
    if (!fractions_.empty()) {
      design[p] = text_at(parameter, fractions_[p][index]);
      continue;
    }
    design[p] = parameter.levels[index % parameter.levels.size()];
    index /= parameter.levels.size();
  }
  return design;
}

}  // namespace joulepath
