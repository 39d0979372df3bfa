#include "planner/mission/plan_front.hpp"

#include <algorithm>
#include <cmath>

#include "model/limits.hpp"
#include "planner/mission/mission_time.hpp"

namespace joulepath {
namespace {

bool same_piece(const PathPiece& a, const PathPiece& b) {
  constexpr double kSame = 1e-6;  // m, rad
  const double length = piece_length(a);
  if (travel_sign(a) != travel_sign(b) || turn_sign(a) != turn_sign(b)) return false;
  if (!(std::abs(piece_length(b) - length) <= kSame)) return false;
  for (const double s : {0.0, 0.25 * length, 0.5 * length, 0.75 * length}) {
    const Pose there = piece_point(a, s).pose, other = piece_point(b, std::min(s, piece_length(b))).pose;
    if (!(std::hypot(other.x_m - there.x_m, other.y_m - there.y_m) <= kSame)) return false;
  }
  return true;
}

bool same_ways(const Plan& a, const Plan& b) {
  const std::vector<FrontStretch> ways = planned_stretches(a), others = planned_stretches(b);
  return std::equal(ways.begin(), ways.end(), others.begin(), others.end(),
                    [](const FrontStretch& way, const FrontStretch& other) {
                      return same_piece(way.request.piece, other.request.piece);
                    });
}

bool searched_ways(const Plan& plan) {
  return std::any_of(plan.legs.begin(), plan.legs.end(),
                     [](const LegPlan& leg) { return !leg.alternatives.empty(); });
}

/// Adds the plan of least time and two between it and the plan of least energy, where ways differ.
void add_faster_plans(const MissionRequest& mission, const MissionWorld& world, PlanOptions options,
                      const RouteSpace* space, std::vector<Plan>& plans, std::vector<const char*>& names) {
  options.baselines = options.path_bound = false;
  const double middle_W = middle_price_W(plans.front());
  for (const double price_W : {kNoLimit, middle_W, kCalmer * middle_W}) {
    if (price_W <= 0) continue;
    MissionRequest hurried = mission;
    hurried.objective.minimize =
        std::isinf(price_W) ? Objective::Minimize::time : Objective::Minimize::energy_and_time;
    if (std::isfinite(price_W)) hurried.objective.time_value_W = price_W;
    Plan plan = plan_mission(hurried, world, options, space);
    const auto is_known = [&](const Plan& known) { return same_ways(plan, known); };
    if (!is_driven(plan) || std::any_of(plans.begin(), plans.end(), is_known)) continue;
    plans.push_back(std::move(plan));
    names.push_back(std::isinf(price_W) ? "least_time" : "between");
  }
}

}  // namespace

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

MissionFront mission_front(const MissionRequest& mission, const MissionWorld& world,
                           const PlanOptions& options, std::size_t points, bool open) {
  const std::optional<RouteSpace> space = route_space(mission, world);
  const RouteSpace* floor = space ? &*space : nullptr;
  MissionFront all{.plans = {plan_mission(mission, world, options, floor)}};
  if (!is_driven(all.plans.front())) return all;
  std::vector<const char*> names{"least_energy"};
  if (searched_ways(all.plans.front())) add_faster_plans(mission, world, options, floor, all.plans, names);
  const Plan& first = all.plans.front();
  const FrontPoint rest = rest_of(first);
  std::vector<FrontDrive> drives;
  for (const Plan& plan : all.plans) {
    FrontPoint more = rest_of(plan);
    more.duration_s -= rest.duration_s;
    more.energy_J -= rest.energy_J;
    more.motion_energy_J -= rest.motion_energy_J;
    drives.push_back({planned_stretches(plan), more});
  }
  all.front = lowest_front(drives, points, open ? planned_price_W(first) : 0.0);
  for (FrontPoint& point : all.front.points) {
    point = sum_of(point, rest);
    point.ways = names[point.drive];
  }
  return all;
}

}  // namespace joulepath
