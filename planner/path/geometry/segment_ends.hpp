#pragma once

#include <variant>

#include "planner/path/geometry/curve.hpp"

namespace joulepath {

inline PathPoint begin_of(const CurveSegment& segment) {
  return std::visit([](const auto& s) { return s.at(0); }, segment);
}

inline PathPoint end_of(const CurveSegment& segment) {
  return std::visit([](const auto& s) { return s.at(s.length_m()); }, segment);
}

}  // namespace joulepath
