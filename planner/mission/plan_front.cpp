#include "planner/mission/plan_front.hpp"

#include <algorithm>

namespace joulepath {

std::vector<FrontStretch> planned_stretches(const Plan& plan) {
  std::vector<FrontStretch> stretches;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches)
      stretches.push_back(
          {stretch.request, stretch.profile.s, std::max(stretch.summary.status, plan.status)});
  return stretches;
}

FrontPoint rest_of(const Plan& plan) {
  FrontPoint rest{.duration_s = plan.duration_s,
                  .energy_J = plan.energy.total_J(),
                  .motion_energy_J = plan.energy.motion_J()};
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches) {
      rest.duration_s -= stretch.profile.duration_s();
      rest.energy_J -= stretch.energy.total_J();
      rest.motion_energy_J -= stretch.energy.motion_J();
    }
  return rest;
}

FrontPoint sum_of(FrontPoint point, const FrontPoint& rest) {
  point.duration_s += rest.duration_s;
  point.energy_J += rest.energy_J;
  point.motion_energy_J += rest.motion_energy_J;
  return point;
}

}  // namespace joulepath
