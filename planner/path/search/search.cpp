#include "planner/path/search/search.hpp"

#include <ompl/base/ScopedState.h>
#include <ompl/base/goals/GoalState.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/util/Console.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>

#include "planner/path/search/ompl_space.hpp"
// Design: docs/decisions/0201-routes-and-floor.md
// Method: [Sucan2012], [Gammell2015]
namespace joulepath {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// Ends a search by counting: at the budget of iterations, when the best cost no longer improves, or when
/// many batches of samples found no way.
class Budget {
 public:
  Budget(const SearchRequest& request, const ob::PlannerPtr& planner) : request_(request) {
    for (const auto& [name, value] : planner->getPlannerProgressProperties())
      if (name.rfind("best cost", 0) == 0)
        best_cost_ = value;
      else if (name.rfind("current free states", 0) == 0)
        samples_ = value;
  }

  bool spent() {
    if (++iterations_ >= request_.max_iterations) return true;
    if (iterations_ % kLookEvery != 0 || !best_cost_) return false;
    const double cost = std::strtod(best_cost_().c_str(), nullptr);
    if (!std::isfinite(cost)) return samples_ && std::strtol(samples_().c_str(), nullptr, 10) > kMostSamples;
    if (cost < (1 - kSettled) * settled_cost_) settled_cost_ = cost, settled_at_ = iterations_;
    return iterations_ - settled_at_ > request_.patience;
  }
  unsigned iterations() const { return iterations_; }

 private:
  static constexpr unsigned kLookEvery = 32;
  static constexpr double kSettled = 0.002;
  static constexpr long kMostSamples = 6000;

  const SearchRequest& request_;
  std::function<std::string()> best_cost_{}, samples_{};
  unsigned iterations_{};
  double settled_cost_{std::numeric_limits<double>::infinity()};
  unsigned settled_at_{};
};

/// OMPL draws the seeds of its internal random numbers from one generator per process. This mutex lets one
/// thread at a time set that generator and construct a planner.
std::mutex& seeding_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct Setup {
  ob::ProblemDefinitionPtr problem{};
  ob::PlannerPtr planner{};
};

Setup set_up(const FreeSpace& free_space, const SearchRequest& request) {
  const std::lock_guard lock(seeding_mutex());
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(request.seed % 4294967291U + 1));
  const ob::SpaceInformationPtr space = ompl_space(free_space, request);
  auto problem = std::make_shared<ob::ProblemDefinition>(space);
  ob::ScopedState<ob::RealVectorStateSpace> start(space), goal(space);
  for (unsigned i = 0; i < 2; ++i) start[i] = request.start_m[i], goal[i] = request.goal_m[i];
  problem->setStartAndGoalStates(start, goal, 1e-6);
  problem->setOptimizationObjective(ompl_objective(space, request));
  auto planner = std::make_shared<og::BITstar>(space);
  planner->setSamplesPerBatch(200);
  planner->setProblemDefinition(problem);
  planner->setup();
  return {problem, planner};
}

}  // namespace

SearchResult search_polyline(const FreeSpace& space, const SearchRequest& request) {
  SearchResult result;
  const Point2 &a = request.start_m, &b = request.goal_m;
  const DiscLineCheck free(space, a, b, request.cells);
  if (!free.point_free(a) || !free.point_free(b)) return result;  // OMPL waits for another end without end
  if (!request.cost.rate && free(a, b)) {
    result.polyline_m = {a, b};
    result.cost = polyline_cost(result.polyline_m, request.cost);
    return result;
  }
  const Setup setup = set_up(space, request);
  Budget budget(request, setup.planner);
  setup.planner->solve(ob::PlannerTerminationCondition([&budget] { return budget.spent(); }));
  result.iterations = budget.iterations();
  if (!setup.problem->hasExactSolution()) return result;
  for (const ob::State* state : setup.problem->getSolutionPath()->as<og::PathGeometric>()->getStates())
    result.polyline_m.push_back(point_of(state));
  result.polyline_m.front() = a;
  result.polyline_m.back() = b;
  result.cost = polyline_cost(result.polyline_m, request.cost);
  return result;
}

}  // namespace joulepath
