#pragma once

#include "app/plan/plan_results.hpp"
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
  double cpu_s{};  ///< of this thread inside of C++: mission, plan, trajectory and JSON
};

}  // namespace joulepath::python
