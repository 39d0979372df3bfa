#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// |f| <= mu N: the force along the heading at a wheel's contact, N = m g/2.
struct Traction {
  static constexpr std::string_view name = "traction";
  static constexpr std::size_t rows = kSidedRows;
  Limits limits{};

  Bounds bounds(const Segment& segment, std::size_t row) const {
    const Plant& plant = *segment.plant;
    const double stated_kg = segment.limit_points[point_of(row)].site.payload_kg;
    const double load_N = 0.5 * plant.robot.total_mass_kg(plant.payload_kg(stated_kg)) * kGravity_m_s2;
    return within(limits.traction_coefficient * load_N);
  }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    return load_at(interval, point_of(row), side_of(row)).force_N;
  }
};

}  // namespace joulepath::nlp
