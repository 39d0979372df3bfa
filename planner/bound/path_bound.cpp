#include "planner/bound/path_bound.hpp"

#include <algorithm>
#include <cmath>

#include "model/progress.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/accounts/stretch_account.hpp"
#include "planner/bound/geodesic.hpp"
#include "planner/bound/line_price.hpp"
#include "planner/legs/stretch.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr double kLeastLine_m = 0.05;    ///< a shorter line is bounded by zero
constexpr double kLeastHeading_m = 0.2;  ///< the shortest line that knows headings
constexpr int kMostLines = 4;            ///< that are tried for a leg
constexpr double kLengthRatio = 1.12;    ///< of the lines that know headings, below the long one
constexpr double kHeadingGain_J = 0.01;  ///< that counts
constexpr double kTightBound = 0.9;      ///< of the energy, below which lower prices are tried
constexpr double kLowerPrice = 0.25;     ///< of a price of a second, which is tried next
constexpr double kLeastPrice_W = 1;      ///< after a lower price of a second, 0 is tried

LegEnds ends_of(const LegPlan& leg, const std::optional<double>& start_rad,
                const std::optional<double>& goal_rad, double cost_J) {
  Path path;
  for (const StretchPlan& stretch : leg.stretches) path.pieces.push_back(stretch.request.piece);
  const Pose goal = path.pieces.empty() ? leg.start_pose : path.end();
  return {.start_m = {leg.start_pose.x_m, leg.start_pose.y_m},
          .goal_m = {goal.x_m, goal.y_m},
          .start_rad = start_rad,
          .goal_rad = goal_rad,
          .payload_kg = leg.payload.from_kg,
          .way_at_most_m = leg.distance_m,
          .cost_at_most_J = cost_J};
}

bool path_is_given(const LegPlan& leg) { return leg.path_source == "bezier" || leg.path_source == "given"; }

/// Headings that a mission names at its stops: the start's, then each leg's goal.
std::vector<std::optional<double>> named_headings(const MissionRequest& mission, const Plan& plan) {
  std::vector<std::optional<double>> headings(1);
  if (mission.start.heading_given) headings[0] = mission.start.pose.heading_rad;
  for (const LegPlan& leg : plan.legs) {
    const auto station = mission.stations.find(leg.to);
    const bool is_searched = !leg.prescribed && !path_is_given(leg);
    headings.push_back(is_searched && station != mission.stations.end() ? station->second.heading_rad
                                                                        : std::nullopt);
  }
  return headings;
}

std::string not_covered(const LegPlan& leg, bool least_time) {
  if (leg.prescribed) return "the leg's motion is given";
  if (path_is_given(leg)) return "the leg's path is given";
  if (least_time) return "the plan takes the least time, not the least energy";
  if (leg.payload.from_kg != leg.payload.to_kg) return "the payload changes along the leg";
  for (const StretchPlan& stretch : leg.stretches)
    if (stretch.request.start_rate != 0 || stretch.request.end_rate != 0)
      return "the leg does not begin and end at rest";
  return "";
}

/// What a leg takes between its stops, time at its price included.
double driving_cost_J(const LegPlan& leg, double standby_W, double time_W) {
  return leg.energy.total_J() - standby_W * leg.dwell_s + time_W * leg.duration_s;
}

/// Bounds of a plan's legs, each at a price of a second.
class PlanBounds {
 public:
  PlanBounds(const Plan& plan, const MissionRequest& mission, const Plant& plant, const Robot& robot,
             const RouteSpace* space)
      : plan_(plan),
        headings_(named_headings(mission, plan)),
        least_time_(mission.objective.minimize == Objective::Minimize::time),
        standby_W_(plant.robot.power.standby_W),
        bounds_(plant, robot, space) {}

  const LegBound& find(std::size_t k, double time_W) {
    const auto [found, is_new] = found_.try_emplace({k, time_W});
    if (is_new) found->second = bound(k, time_W);
    return found->second;
  }

 private:
  LegBound bound(std::size_t k, double time_W) {
    const LegPlan& leg = plan_.legs[k];
    if (const std::string reason = not_covered(leg, least_time_); !reason.empty()) return {.reason = reason};
    const double cost_J = driving_cost_J(leg, standby_W_, time_W);
    return bounds_.find(ends_of(leg, headings_[k], headings_[k + 1], cost_J), time_W);
  }

  const Plan& plan_;
  std::vector<std::optional<double>> headings_;
  bool least_time_{};
  double standby_W_{};
  LegBounds bounds_;
  std::map<std::pair<std::size_t, double>, LegBound> found_{};  ///< by leg and price of a second
};

PathBound path_bound(const LegBound& found, double price_W, double driving_s, double dwell_J) {
  if (!found.reason.empty()) return {.reason = found.reason};
  return {.energy_J = std::max(0.0, found.cost_J - price_W * driving_s) + dwell_J,
          .part = found.around_corners ? PathBound::Part::corners
                  : found.by_headings  ? PathBound::Part::headings
                                       : PathBound::Part::line};
}

}  // namespace

const PowerForm& LegBounds::form(double payload_kg) {
  const auto found = forms_.find(payload_kg);
  if (found != forms_.end()) return found->second;
  return forms_[payload_kg] = power_form(plant_, limits_along(robot_, {payload_kg, payload_kg}), payload_kg);
}

const LineBound& LegBounds::line(double payload_kg, double time_W, double length_m) {
  const auto [found, is_new] = lines_.try_emplace({payload_kg, time_W, length_m});
  if (is_new) found->second = line_bound(form(payload_kg), length_m, time_W);
  return found->second;
}

const RateTable& LegBounds::rates(const LegEnds& leg, double time_W, double length_m) {
  const bool start = leg.start_rad.has_value(), goal = leg.goal_rad.has_value();
  const auto [found, is_new] = rates_.try_emplace({leg.payload_kg, time_W, length_m, start, goal});
  if (is_new) found->second = rate_table(form(leg.payload_kg), length_m, time_W, start, goal);
  return found->second;
}

/// Ways are at least `way_m` long. Each line counts up to the length of the next: the last one without an
/// end, which is where a straight line takes more than is known to be enough.
double LegBounds::with_headings_J(const LegEnds& leg, double time_W, double way_m, double line_J) {
  std::vector<double> lengths_m{long_line_m(form(leg.payload_kg), time_W)};
  while (lengths_m.back() > way_m) lengths_m.push_back(lengths_m.back() / kLengthRatio);
  const HeadingEnds ends{
      {leg.goal_m[0] - leg.start_m[0], leg.goal_m[1] - leg.start_m[1]}, leg.start_rad, leg.goal_rad};
  double bound_J = leg.cost_at_most_J, from_m = way_m, straight_J = line_J;
  int tried = 0;
  for (std::size_t k = lengths_m.size(); k-- > 0 && straight_J < bound_J;) {
    if (++tried > kMostLines) return straight_J;  // a longer way takes more
    const LineBound& straight = line(leg.payload_kg, time_W, lengths_m[k]);
    if (!(straight.per_m_J > 0)) return line_J;
    const double to_m =
        k > 0 ? lengths_m[k - 1] : from_m + std::max(0.0, bound_J - straight.at(from_m)) / straight.per_m_J;
    const double found_J = heading_bound(rates(leg, time_W, lengths_m[k]), ends, from_m, to_m, bound_J);
    bound_J = std::min(bound_J, std::max(found_J, straight_J));
    from_m = to_m;
    straight_J = std::max(straight_J, line(leg.payload_kg, time_W, lengths_m[k > 0 ? k - 1 : 0]).at(to_m));
  }
  return bound_J;
}

LegBound LegBounds::find(const LegEnds& leg, double time_W) {
  if (const std::string& reason = form(leg.payload_kg).not_covered; !reason.empty())
    return {.reason = reason};
  Geodesic way{distance_m(leg.start_m, leg.goal_m), false};
  if (space_) {
    const double radius_m = space_->checker().inscribed_radius_m() + space_->checker().clearance_m();
    way = shortest_way(space_->field(), radius_m, leg.start_m, leg.goal_m, leg.way_at_most_m);
  }
  LegBound bound{.cost_J = 0, .around_corners = way.around_corners};
  if (way.length_m < kLeastLine_m) return bound;
  const double long_m = long_line_m(form(leg.payload_kg), time_W);
  const LineBound& straight = line(leg.payload_kg, time_W, std::min(way.length_m, long_m));
  if (!(straight.per_m_J > 0))
    return {.reason = "the bound finds no energy that a meter takes at the speed of a long drive"};
  const double line_J = straight.at(way.length_m);
  bound.cost_J = line_J;
  if ((leg.start_rad || leg.goal_rad) && way.length_m > kLeastHeading_m && std::isfinite(leg.cost_at_most_J))
    bound.cost_J = std::max(line_J, with_headings_J(leg, time_W, way.length_m, line_J));
  bound.by_headings = bound.cost_J > line_J + kHeadingGain_J;
  return bound;
}

namespace {

/// The bound at a price of a second: any price gives a valid one. Under a jerk limit the price is that of the
/// problem with it, and of a plan that hardly meets its deadline any price is: lower ones may give more.
template <class At>
PathBound greatest_bound(const Plan& plan, double price_W, double energy_J, const At& bound_at) {
  PathBound best = bound_at(price_W);
  if (!best.energy_J || !std::isfinite(price_W)) return best;
  if (!limits_jerk(plan) && *best.energy_J >= kTightBound * energy_J) return best;
  while (price_W > 0) {
    price_W = price_W > kLeastPrice_W ? kLowerPrice * price_W : 0;
    const PathBound found = bound_at(price_W);
    if (!found.energy_J || *found.energy_J < *best.energy_J) break;  // the bound is concave in the price
    best = found;
  }
  return best;
}

/// What a leg of a given path or motion takes at least, which other paths of the other legs do not change.
/// The bound of its profile holds at the leg's own price of a second and above; below it a leg gains no more
/// than the difference for each of the mission's `most_s`.
std::optional<double> given_cost_J(const LegPlan& leg, double standby_W, double price_W, double most_s) {
  if (leg.prescribed) return driving_cost_J(leg, standby_W, price_W);
  if (!path_is_given(leg) || !std::isfinite(leg.lower_bound_J)) return std::nullopt;
  const double own_W = std::max(0.0, leg.price_of_time_W);
  return leg.lower_bound_J - standby_W * leg.dwell_s + own_W * leg.duration_s -
         std::max(0.0, own_W - price_W) * most_s;
}

/// All legs at one price, because other plans may share the time of the mission otherwise.
PathBound mission_bound(PlanBounds& bounds, const Plan& plan, double price_W, double standby_W) {
  LegBound sum;
  std::string none;  // the reason where no leg has a bound
  double driving_s = 0, dwell_s = 0, widest_J = -kNoLimit;
  for (const LegPlan& leg : plan.legs) driving_s += leg.duration_s, dwell_s += leg.dwell_s;
  for (std::size_t k = 0; k < plan.legs.size() && sum.reason.empty(); ++k) {
    const LegBound& leg = bounds.find(k, price_W);
    if (!leg.reason.empty()) {
      none = "leg " + leg_text(k, plan.legs[k].to) + ": " + leg.reason;
      if (const std::optional<double> given_J = given_cost_J(plan.legs[k], standby_W, price_W, driving_s))
        sum.cost_J += *given_J;
      else
        sum.reason = none;
      continue;
    }
    sum.cost_J += leg.cost_J;
    if (const double gap_J = driving_cost_J(plan.legs[k], standby_W, price_W) - leg.cost_J; gap_J > widest_J)
      widest_J = gap_J, sum.around_corners = leg.around_corners, sum.by_headings = leg.by_headings;
  }
  if (sum.reason.empty() && widest_J == -kNoLimit) sum.reason = none;
  return path_bound(sum, price_W, driving_s, standby_W * dwell_s);
}

/// What no path takes less than, the given paths do not either.
void raise_to(const PathBound& bound, double energy_J, double& lower_bound_J, double& gap) {
  if (!bound.energy_J || !(*bound.energy_J > lower_bound_J)) return;
  lower_bound_J = *bound.energy_J, gap = gap_percent(energy_J, lower_bound_J);
}

}  // namespace

void add_path_bounds(Plan& plan, const MissionRequest& mission, const MissionWorld& world, const Plant& plant,
                     const RouteSpace* space) {
  if (!is_driven(plan) || plan.legs.empty()) return;
  PlanBounds bounds(plan, mission, plant, world.robot, space);
  const double standby_W = plant.robot.power.standby_W;
  double driving_s = 0, spent_J = 0, lowest_W = kNoLimit, highest_W = 0;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    LegPlan& leg = plan.legs[k];
    const double price_W = std::max(0.0, leg.price_of_time_W);
    leg.path_bound = greatest_bound(plan, price_W, leg.energy.total_J(), [&](double trial_W) {
      return path_bound(bounds.find(k, trial_W), trial_W, leg.duration_s, standby_W * leg.dwell_s);
    });
    raise_to(*leg.path_bound, leg.energy.total_J(), leg.lower_bound_J, leg.gap_percent);
    finish_steps();
    driving_s += leg.duration_s, spent_J += price_W * leg.duration_s;
    lowest_W = std::min(lowest_W, price_W), highest_W = std::max(highest_W, price_W);
  }
  const double price_W = driving_s > 0 ? std::clamp(spent_J / driving_s, lowest_W, highest_W) : 0;
  plan.path_bound = greatest_bound(plan, price_W, plan.energy.total_J(), [&](double trial_W) {
    return mission_bound(bounds, plan, trial_W, standby_W);
  });
  raise_to(*plan.path_bound, plan.energy.total_J(), plan.lower_bound_J, plan.gap_percent);
}

}  // namespace joulepath
