#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// |x| <= x_max per wheel, where x is a quantity that a motor's data sheet limits: see Quantity.
template <class Quantity>
struct MotorRating {
  static constexpr std::string_view name = Quantity::name;
  static constexpr std::size_t rows = kSidedRows;

  Bounds bounds(const Segment& segment, std::size_t row) const {
    return within(segment.plant->robot.motor[side_of(row)].*Quantity::rating);
  }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    return Quantity::of(load_at(interval, point_of(row), side_of(row)));
  }
};

}  // namespace joulepath::nlp
