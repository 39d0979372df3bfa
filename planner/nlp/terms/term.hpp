#pragma once

#include <concepts>
#include <string_view>

#include "planner/nlp/interval/jerk_interval.hpp"
#include "planner/nlp/interval/segment.hpp"

namespace joulepath::nlp {

/// Bounds of a row; infinite if there is no limit.
struct Bounds {
  double low{-kNoLimit};
  double high{kNoLimit};
};

constexpr Bounds within(double size) { return {-size, size}; }

/// A family of rows of each segment. A row depends on two neighboring nodes only. `name` is the limit's key
/// without its unit. To add one, write its file and list it in formulation.hpp.
template <class T>
concept SegmentTerm = requires(const T& term, const Interval<double>& plain, const Interval<Jet>& jet,
                               const Interval<Range>& range, const JerkInterval<JerkJet>& with_jerk,
                               std::size_t row) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::rows } -> std::convertible_to<std::size_t>;
  { term.bounds(plain.segment, row) } -> std::same_as<Bounds>;
  { term(plain, row) } -> std::same_as<double>;
  { term(jet, row) } -> std::same_as<Jet>;
  { term(range, row) } -> std::same_as<Range>;
  { term(with_jerk, row) } -> std::same_as<JerkJet>;
};

/// Rows that exist per limit point and side: row = 2 point + side.
inline constexpr std::size_t kSidedRows = 2 * kLimitPoints;
constexpr std::size_t point_of(std::size_t row) { return row / 2; }
constexpr Side side_of(std::size_t row) { return row % 2 == 0 ? Side::left : Side::right; }

}  // namespace joulepath::nlp
