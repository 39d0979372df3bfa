#include "planner/bound/path_bound.hpp"

#include <algorithm>
#include <cmath>

#include "planner/bound/geodesic.hpp"
#include "planner/bound/line_price.hpp"
#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

constexpr double kLeastLine_m = 0.05;  ///< a shorter line is bounded by zero

LegEnds ends_of(const LegPlan& leg) {
  Path path;
  for (const StretchPlan& stretch : leg.stretches) path.pieces.push_back(stretch.request.piece);
  const Pose goal = path.pieces.empty() ? leg.start_pose : path.end();
  return {
      {leg.start_pose.x_m, leg.start_pose.y_m}, {goal.x_m, goal.y_m}, leg.payload.from_kg, leg.distance_m};
}

std::string not_covered(const LegPlan& leg, bool least_time) {
  if (leg.prescribed) return "the leg's motion is given";
  if (leg.path_source == "bezier" || leg.path_source == "given") return "the leg's path is given";
  if (least_time) return "the plan takes the least time, not the least energy";
  if (leg.payload.from_kg != leg.payload.to_kg) return "the payload changes along the leg";
  for (const StretchPlan& stretch : leg.stretches)
    if (stretch.request.start_rate != 0 || stretch.request.end_rate != 0)
      return "the leg does not begin and end at rest";
  return "";
}

LegBound bound_of(LegBounds& bounds, const LegPlan& leg, bool least_time, double time_W) {
  LegBound found{.reason = not_covered(leg, least_time)};
  return found.reason.empty() ? bounds.find(ends_of(leg), time_W) : found;
}

PathBound path_bound(const LegBound& found, double price_W, double driving_s, double dwell_J) {
  if (!found.reason.empty()) return {.reason = found.reason};
  return {.energy_J = std::max(0.0, found.cost_J - price_W * driving_s) + dwell_J,
          .part = found.around_corners ? PathBound::Part::corners : PathBound::Part::line};
}

}  // namespace

const PowerForm& LegBounds::form(double payload_kg) {
  const auto found = forms_.find(payload_kg);
  if (found != forms_.end()) return found->second;
  return forms_[payload_kg] = power_form(plant_, limits_along(robot_, {payload_kg, payload_kg}), payload_kg);
}

double LegBounds::line_J(double payload_kg, double time_W, double way_m) {
  if (way_m < kLeastLine_m) return 0;
  const double length_m = std::min(way_m, long_line_m(form(payload_kg), time_W));
  const auto [found, is_new] = lines_.try_emplace({payload_kg, time_W, length_m});
  if (is_new) found->second = line_bound(form(payload_kg), length_m, time_W);
  return found->second.at(way_m);
}

LegBound LegBounds::find(const LegEnds& leg, double time_W) {
  if (const std::string& reason = form(leg.payload_kg).not_covered; !reason.empty())
    return {.reason = reason};
  Geodesic way{distance_m(leg.start_m, leg.goal_m), false};
  if (space_) {
    const double radius_m = space_->checker().inscribed_radius_m() + space_->checker().clearance_m();
    way = shortest_way(space_->field(), radius_m, leg.start_m, leg.goal_m, leg.way_at_most_m);
  }
  return {.cost_J = line_J(leg.payload_kg, time_W, way.length_m), .around_corners = way.around_corners};
}

void add_path_bounds(Plan& plan, const MissionRequest& mission, const MissionWorld& world, const Plant& plant,
                     const RouteSpace* space) {
  if (plan.status > SolveStatus::feasible || plan.legs.empty()) return;
  LegBounds bounds(plant, world.robot, space);
  const bool least_time = mission.objective.minimize == Objective::Minimize::time;
  const double standby_W = plant.robot.power.standby_W;
  double driving_s = 0, spent_J = 0, lowest_W = kNoLimit, highest_W = 0;
  for (LegPlan& leg : plan.legs) {
    const double price_W = std::max(0.0, leg.price_of_time_W);
    leg.path_bound = path_bound(bound_of(bounds, leg, least_time, price_W), price_W, leg.duration_s,
                                standby_W * leg.dwell_s);
    driving_s += leg.duration_s, spent_J += price_W * leg.duration_s;
    lowest_W = std::min(lowest_W, price_W), highest_W = std::max(highest_W, price_W);
  }
  // One price for all legs, any price being valid: other plans may share the time of the mission otherwise.
  const double price_W = driving_s > 0 ? std::clamp(spent_J / driving_s, lowest_W, highest_W) : 0;
  LegBound sum;
  double dwell_s = 0;
  for (std::size_t k = 0; k < plan.legs.size() && sum.reason.empty(); ++k) {
    const LegBound leg = bound_of(bounds, plan.legs[k], least_time, price_W);
    if (!leg.reason.empty()) sum.reason = "leg " + std::to_string(k) + ": " + leg.reason;
    sum.cost_J += leg.cost_J, sum.around_corners |= leg.around_corners;
    dwell_s += plan.legs[k].dwell_s;
  }
  plan.path_bound = path_bound(sum, price_W, driving_s, standby_W * dwell_s);
}

}  // namespace joulepath
