#include "planner/values/profile_result.hpp"

namespace joulepath {

const char* solve_status_name(SolveStatus status) {
  switch (status) {
    case SolveStatus::optimal:
      return "optimal";
    case SolveStatus::feasible:
      return "feasible";
    case SolveStatus::infeasible:
      return "infeasible";
    case SolveStatus::failed:
      break;
  }
  return "failed";
}

}  // namespace joulepath
