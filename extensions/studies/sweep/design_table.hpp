#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace joulepath {

/// A parameter of a study: levels, or a range that is divided into levels.
struct SweepParameter {
  std::string name{};
  std::vector<std::string> levels{};  ///< empty: the range below
  double from{};
  double to{};
  std::size_t count{};  ///< levels of the range on a grid
  bool logarithmic{};   ///< the range is divided by equal ratios; both ends are then positive

  [[nodiscard]] bool is_range() const { return levels.empty(); }
  /// True for a range, even after a grid divided it into levels.
  [[nodiscard]] bool has_ends() const { return to > from; }
  /// The value at a fraction of the range, 0 to 1.
  [[nodiscard]] double at(double fraction) const;
  [[nodiscard]] double fraction_of(double value) const;
};

/// The designs of a study, each a text per parameter; numbers parse back to the same bits.
class DesignTable {
 public:
  /// Every combination of the levels; the last parameter changes fastest.
  static DesignTable grid(std::vector<SweepParameter> parameters);

  /// `count` designs; the values of each parameter fill `count` equal parts of its range, one in each
  /// [McKay1979]. Levels are used equally often. The seed determines all values.
  static DesignTable latin_hypercube(std::vector<SweepParameter> parameters, std::size_t count,
                                     std::uint64_t seed);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::vector<std::string> at(std::size_t index) const;
  [[nodiscard]] const std::vector<SweepParameter>& parameters() const { return parameters_; }

  /// The most designs that a study may have.
  static constexpr std::size_t kMost = 10'000'000;

 private:
  std::vector<SweepParameter> parameters_{};
  std::size_t size_{};
  std::vector<std::vector<double>> fractions_{};  ///< of a hypercube: per parameter, per design
};

}  // namespace joulepath
