#include "planner/mission/plan_front.hpp"

#include <algorithm>

#include "model/limits.hpp"

namespace joulepath {

std::vector<FrontStretch> planned_stretches(const Plan& plan) {
  std::vector<FrontStretch> stretches;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches)
      stretches.push_back({stretch.request, stretch.profile.s});
  return stretches;
}

double planned_price_W(const Plan& plan) {
  double least_W = kNoLimit;
  for (const LegPlan& leg : plan.legs)
    if (leg.price_of_time_W > 0) least_W = std::min(least_W, leg.price_of_time_W);
  return std::isinf(least_W) ? 0.0 : least_W;
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
