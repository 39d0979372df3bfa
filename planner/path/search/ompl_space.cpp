#include "planner/path/search/ompl_space.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/samplers/InformedStateSampler.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace joulepath {
namespace {

namespace ob = ompl::base;
using RealState = ob::RealVectorStateSpace::StateType;

constexpr double kValidityStep_m = 0.05;

double cost_between(const Point2& a, const Point2& b, const TravelCost& cost) {
  const double length_m = std::hypot(b[0] - a[0], b[1] - a[1]);
  if (!cost.rate || length_m == 0) return cost.least_rate * length_m;
  constexpr double kStep_m = 0.2;
  const int steps = std::max(1, static_cast<int>(std::ceil(length_m / kStep_m)));
  const double heading_rad = std::atan2(b[1] - a[1], b[0] - a[0]);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double t = (i + 0.5) / steps;
    sum += cost.rate(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), heading_rad);
  }
  return sum * length_m / steps;
}

class DiscValidity : public ob::StateValidityChecker {
 public:
  DiscValidity(const ob::SpaceInformationPtr& space, const DiscLineCheck& check)
      : StateValidityChecker(space), check_(check) {}
  bool isValid(const ob::State* state) const override { return check_.point_free(point_of(state)); }

 private:
  DiscLineCheck check_;
};

/// Checks motions cell by cell.
class DiscMotion : public ob::MotionValidator {
 public:
  DiscMotion(const ob::SpaceInformationPtr& space, const DiscLineCheck& check)
      : MotionValidator(space), check_(check) {}
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return check_(point_of(from), point_of(to));
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last) const override {
    if (checkMotion(from, to)) return true;
    last.second = 0;
    if (last.first != nullptr) si_->copyState(last.first, from);
    return false;
  }

 private:
  DiscLineCheck check_;
};

/// Uniform samples; all randomness comes from the request's seed.
class SeededSampler : public ob::RealVectorStateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::uint64_t seed) : RealVectorStateSampler(space) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed));
  }
};

/// Uniform samples of the ellipse of points that can still lie on a cheaper solution [Gammell2014].
class EllipseSampler : public ob::InformedSampler {
 public:
  EllipseSampler(const ob::ProblemDefinitionPtr& problem, unsigned max_calls, const SearchRequest& request,
                 const ob::RealVectorBounds& bounds)
      : InformedSampler(problem, max_calls),
        start_(request.start_m),
        goal_(request.goal_m),
        least_rate_(request.cost.least_rate),
        bounds_(bounds) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(request.seed * 2654435761U + 17));
  }

  bool sampleUniform(ob::State* state, const ob::Cost& max_cost) override {
    double* values = state->as<RealState>()->values;
    for (unsigned attempt = 0; attempt < std::max(numIters_, 1000U); ++attempt) {
      const Point2 p = draw(max_cost.value() / least_rate_);
      if (p[0] < bounds_.low[0] || p[0] > bounds_.high[0] || p[1] < bounds_.low[1] || p[1] > bounds_.high[1])
        continue;
      values[0] = p[0], values[1] = p[1];
      return true;
    }
    return false;
  }
  bool sampleUniform(ob::State* state, const ob::Cost& min_cost, const ob::Cost& max_cost) override {
    for (unsigned attempt = 0; attempt < std::max(numIters_, 1000U); ++attempt)
      if (sampleUniform(state, max_cost) && heuristicSolnCost(state).value() >= min_cost.value()) return true;
    return false;
  }
  bool hasInformedMeasure() const override { return true; }
  double getInformedMeasure(const ob::Cost& cost) const override {
    const double box = (bounds_.high[0] - bounds_.low[0]) * (bounds_.high[1] - bounds_.low[1]);
    const double long_m = cost.value() / least_rate_, foci_m = foci_distance_m();
    if (!std::isfinite(long_m)) return box;
    const double short_m = std::sqrt(std::max(0.0, long_m * long_m - foci_m * foci_m));
    return std::min(box, std::numbers::pi / 4 * long_m * short_m);
  }

 private:
  double foci_distance_m() const { return std::hypot(goal_[0] - start_[0], goal_[1] - start_[1]); }
  Point2 draw(double long_m) {
    const double foci_m = foci_distance_m();
    const double box_m = std::hypot(bounds_.high[0] - bounds_.low[0], bounds_.high[1] - bounds_.low[1]);
    if (!(long_m < box_m * 1.2))
      return {rng_.uniformReal(bounds_.low[0], bounds_.high[0]),
              rng_.uniformReal(bounds_.low[1], bounds_.high[1])};
    const double short_m = std::sqrt(std::max(0.0, long_m * long_m - foci_m * foci_m));
    const double radius = std::sqrt(rng_.uniform01()), angle = rng_.uniformReal(0, 2 * std::numbers::pi);
    const double u = 0.5 * long_m * radius * std::cos(angle), v = 0.5 * short_m * radius * std::sin(angle);
    const double c = foci_m > 0 ? (goal_[0] - start_[0]) / foci_m : 1,
                 s = foci_m > 0 ? (goal_[1] - start_[1]) / foci_m : 0;
    return {0.5 * (start_[0] + goal_[0]) + c * u - s * v, 0.5 * (start_[1] + goal_[1]) + s * u + c * v};
  }

  Point2 start_, goal_;
  double least_rate_;
  ob::RealVectorBounds bounds_;
  ompl::RNG rng_{1};
};

class TravelObjective : public ob::OptimizationObjective {
 public:
  TravelObjective(const ob::SpaceInformationPtr& space, const SearchRequest& request)
      : OptimizationObjective(space), request_(request) {
    const double rate = request.cost.least_rate;
    const Point2 goal = request.goal_m;
    setCostToGoHeuristic([rate, goal](const ob::State* state, const ob::Goal*) {
      const Point2 p = point_of(state);
      return ob::Cost(rate * std::hypot(goal[0] - p[0], goal[1] - p[1]));
    });
  }
  ob::Cost stateCost(const ob::State*) const override { return ob::Cost(0); }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(cost_between(point_of(from), point_of(to), request_.cost));
  }
  ob::Cost motionCostHeuristic(const ob::State* from, const ob::State* to) const override {
    const Point2 a = point_of(from), b = point_of(to);
    return ob::Cost(request_.cost.least_rate * std::hypot(b[0] - a[0], b[1] - a[1]));
  }
  bool isSymmetric() const override { return !request_.cost.rate; }
  ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& problem,
                                                   unsigned max_calls) const override {
    const auto* space = si_->getStateSpace()->as<ob::RealVectorStateSpace>();
    return std::make_shared<EllipseSampler>(problem, max_calls, request_, space->getBounds());
  }

 private:
  SearchRequest request_;
};

}  // namespace

double polyline_cost(const std::vector<Point2>& polyline_m, const TravelCost& cost) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < polyline_m.size(); ++i)
    sum += cost_between(polyline_m[i], polyline_m[i + 1], cost);
  return sum;
}

ob::SpaceInformationPtr ompl_space(const FreeSpace& free_space, const SearchRequest& request) {
  const auto extent = free_space.field().extent_m();
  const DiscLineCheck check(free_space, request.start_m, request.goal_m, request.cells);
  auto space = std::make_shared<ob::RealVectorStateSpace>(2);
  ob::RealVectorBounds bounds(2);
  bounds.low = {extent.x_min_m, extent.y_min_m};
  bounds.high = {extent.x_max_m, extent.y_max_m};
  space->setBounds(bounds);
  space->setStateSamplerAllocator([seed = request.seed](const ob::StateSpace* s) {
    return std::make_shared<SeededSampler>(s, seed * 2246822519U + 5);
  });
  auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(std::make_shared<DiscValidity>(information, check));
  information->setMotionValidator(std::make_shared<DiscMotion>(information, check));
  information->setStateValidityCheckingResolution(kValidityStep_m / space->getMaximumExtent());
  information->setup();
  return information;
}

ob::OptimizationObjectivePtr ompl_objective(const ob::SpaceInformationPtr& space,
                                            const SearchRequest& request) {
  return std::make_shared<TravelObjective>(space, request);
}

}  // namespace joulepath
