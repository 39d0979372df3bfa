#pragma once

#include "app/plan_results.hpp"
#include "planner/path/geometry/path.hpp"
#include "python/bindings/arrays.hpp"

namespace joulepath::python {

/// A path that Python owns.
struct PathValue {
  Path path{};
};

/// A plan that Python owns, with its trajectory.
struct PlanValue {
  PlanResults results{};
  double cpu_s{};  ///< of this thread inside of the planner, without the conversion of its input
};

}  // namespace joulepath::python
