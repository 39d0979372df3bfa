#pragma once

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include "planner/path/search/search.hpp"

namespace joulepath {

/// The search space of a request for OMPL: R^2 within the map, disc checks, samplers seeded by the request.
[[nodiscard]] ompl::base::SpaceInformationPtr ompl_space(const FreeSpace& free_space,
                                                         const SearchRequest& request);

/// Minimizes the travel cost of a request; its informed sampler draws from the ellipse of possible
/// improvements.
[[nodiscard]] ompl::base::OptimizationObjectivePtr ompl_objective(
    const ompl::base::SpaceInformationPtr& space, const SearchRequest& request);

[[nodiscard]] inline Point2 point_of(const ompl::base::State* state) {
  const auto* values = state->as<ompl::base::RealVectorStateSpace::StateType>()->values;
  return {values[0], values[1]};
}

}  // namespace joulepath
