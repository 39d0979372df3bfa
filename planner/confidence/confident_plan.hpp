#pragma once

#include <functional>

#include "planner/legs/stretch.hpp"
#include "planner/values/plan.hpp"

// Design: docs/decisions/0400-visits-and-charging.md
namespace joulepath {

/// Plans a mission without regard to its `objective.confidence`, without baselines and bound over all paths;
/// and adds to such a verdict what would do instead, by plans of its own.
using PlanOnce = std::function<Plan(const MissionRequest&, const MissionWorld&, const PlanOptions&)>;
using OfferOnce = std::function<void(Plan&, const MissionRequest&, const MissionWorld&, const PlanOptions&)>;
struct Planning {
  PlanOnce plan;
  OfferOnce offer;
};

/// Throws ConfigError where a mission asks for a confidence and the robot states no `uncertainty:`, or no
/// `model_energy` in it.
void need_uncertainty(const MissionRequest& mission, const Robot& robot);

/// The share of drawn robots that keep all promises of a plan, with its one-sided 95 % lower bound
/// (Clopper-Pearson). `mission`: its start and chargers.
struct KeptShare {
  double kept{};
  double kept_at_least{};
};
[[nodiscard]] KeptShare kept_share(const Plan& plan, const MissionRequest& mission, const Robot& robot,
                                   double confidence);

/// A plan that keeps its deadlines, the battery's reserve and the limits of motors, battery and tires
/// together with the mission's confidence, for robots drawn from the file's `uncertainty:`. Where the plan
/// without margins does not keep them, its ways are driven again with margins: the joint quantile of the
/// draws' demands, found anew for each plan until it stays. Fresh draws then decide. A mission that cannot be
/// planned with the margins is a verdict. Throws ConfigError as need_uncertainty() does.
[[nodiscard]] Plan confident_plan(const MissionRequest& mission, const MissionWorld& world,
                                  const PlanOptions& options, const Planning& planning);

}  // namespace joulepath
