#pragma once

#include <functional>
#include <optional>

#include "model/plant.hpp"
#include "planner/values/mission_request.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// How ways are chosen.
struct WayChoice {
  std::optional<double> price_W{};  ///< of time; without one, the prices that the mission's times lead to
  bool mean_ramps{};                ///< WaySteps::mean_ramps
};

using PlanOnWays = std::function<Plan(const MissionRequest& mission, const WayChoice& choice)>;

/// Legs that are given, and what their ways are chosen in.
struct WaysRequest {
  const MissionRequest& mission;
  const MissionWorld& world;
  const Plant& plant;
  bool searched{};  ///< whether ways are searched on a floor
};

/// The best plan over several choices of ways. First come the ways of the mission without its times, which a
/// deadline that does not bind leaves as they are. Where times raise or lower prices, the ways at those
/// prices are tried, too, and the others of a front: those between least energy and least time and, at prices
/// above, those of least time. The least time is tried on those of least energy and of less haste, too: the
/// joint program tells small differences of time badly. Under a jerk limit ways for mean ramps are tried,
/// too.
///
/// Of two drives the cheaper one is better; of two verdicts one that is not late, then the one that misses
/// the same limit by less. A choice whose plan the mission's keys refuse (ConfigError) counts only where no
/// choice has a plan; then it is thrown. Design: docs/decisions/0210-ways.md
[[nodiscard]] Plan plan_on_best_ways(const WaysRequest& request, const PlanOnWays& plan_it);

}  // namespace joulepath
