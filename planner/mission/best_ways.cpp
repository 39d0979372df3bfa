#include "planner/mission/best_ways.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

#include "model/config_error.hpp"
#include "planner/mission/mission_time.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr double kHaste = 10;  ///< between prices of time

/// Whether a leg's way is searched.
bool searches(const LegRequest& leg) { return !leg.path && !leg.motion; }

bool minimizes_time(const MissionRequest& mission) {
  return mission.objective.minimize == Objective::Minimize::time;
}

/// Prices of time of the legs whose ways are searched.
std::vector<double> searched_prices_W(const Plan& plan, const MissionRequest& mission) {
  std::vector<double> price_W;
  for (std::size_t k = 0; k < plan.legs.size(); ++k)
    if (searches(mission.legs[k]))
      price_W.push_back(plan.legs[k].in_least_time ? kNoLimit : plan.legs[k].price_of_time_W);
  return price_W;
}

/// Whether the searched legs of a plan pay the price at which their ways were chosen.
bool pays(const Plan& plan, const MissionRequest& mission, double way_price_W) {
  if (minimizes_time(mission)) return true;
  const std::vector<double> price_W = searched_prices_W(plan, mission);
  return !prices_moved(std::vector<double>(price_W.size(), way_price_W), price_W);
}

MissionRequest without_deadlines(MissionRequest mission) {
  mission.objective = {.minimize = Objective::Minimize::energy};
  for (LegRequest& leg : mission.legs) leg.deadline_s.reset();
  return mission;
}

/// The trials of one mission, and the best of them.
class WayTrials {
 public:
  WayTrials(const WaysRequest& request, const PlanOnWays& plan_it) : request_(request), plan_it_(plan_it) {}

  Plan best() {
    const double first_W = first_price_W(mission(), request_.world, request_.plant);
    take({first_W});
    const std::vector<LegRequest>& legs = mission().legs;
    if (!request_.searched || std::none_of(legs.begin(), legs.end(), searches)) return answer();
    if (!best_ || ends_late() || !pays(*best_, mission(), first_W)) try_prices_of_times();
    if (minimizes_time(mission()) || ends_late()) try_least_energy(first_W);
    try_less_haste(first_W);
    if (has_jerk_limit() && ramps_bind()) try_mean_ramps(first_W);
    if (ends_late()) try_more_haste();
    return answer();
  }

 private:
  const MissionRequest& mission() const { return request_.mission; }
  bool ends_late() const { return best_ && best_->infeasibility && is_late(best_->infeasibility->reason); }
  bool has_jerk_limit() const {
    const std::optional<Limits>& limits = request_.world.robot.limits;
    return limits && std::isfinite(limits->jerk_m_s3);
  }
  /// Whether the jerk limit keeps the mean acceleration of a leg's ramps below its limits.
  bool ramps_bind() const {
    if (!has_drive()) return true;
    for (std::size_t k = 0; k < best_->legs.size(); ++k) {
      const Limits limits = limits_along(request_.world.robot, mission().legs[k].payload);
      const double most_m_s2 = std::max(limits.acceleration_m_s2, limits.deceleration_m_s2);
      if (searches(mission().legs[k]) && mean_ramp_m_s2(best_->legs[k].distance_m, limits) < most_m_s2)
        return true;
    }
    return false;
  }
  bool has_drive() const { return best_ && is_driven(*best_); }

  Plan answer() {
    if (!best_) std::rethrow_exception(refused_);
    return *std::move(best_);
  }

  void take(const WayChoice& choice) {
    try {
      Plan other = plan_it_(mission(), choice);
      if (!best_ || is_better(other)) best_ = std::move(other);
    } catch (const ConfigError&) {
      if (!refused_) refused_ = std::current_exception();
    }
  }

  bool is_better(const Plan& other) const {
    if (is_driven(other))
      return !is_driven(*best_) || cost(other, mission().objective) < cost(*best_, mission().objective);
    if (is_driven(*best_) || !other.infeasibility) return false;
    if (!best_->infeasibility) return true;
    const Infeasibility &before = best_->infeasibility->reason, &after = other.infeasibility->reason;
    if (is_late(before) != is_late(after)) return is_late(before);
    return (is_late(after) || after.constraint == before.constraint) && after.amount < before.amount;
  }

  void try_prices_of_times() {
    take({});
    const double middle_W = has_drive() ? middle_price_W(*best_) : 0;
    if (middle_W > 0) take({middle_W});
    if (middle_W > 0 && !minimizes_time(mission())) take({kCalmer * middle_W});
    const auto is_high = [&](double price_W) { return price_W > middle_W; };
    const std::vector<double> price_W =
        has_drive() ? searched_prices_W(*best_, mission()) : std::vector<double>{};
    const bool hurries = ends_late() || std::any_of(price_W.begin(), price_W.end(), is_high);
    if (!minimizes_time(mission()) && hurries) take({kNoLimit});
  }

  void try_least_energy(double first_W, bool mean_ramps = false) {
    MissionRequest cheapest = mission();
    cheapest.objective.minimize = Objective::Minimize::energy;
    if (const double price_W = first_price_W(cheapest, request_.world, request_.plant); price_W != first_W)
      take({price_W, mean_ramps});
  }

  /// The joint program leaves the jerk limit out: its ways suit ramps that are steeper than any drive's.
  void try_mean_ramps(double first_W) {
    take({first_W, true});
    try_least_energy(first_W, true);
  }

  /// The joint program converges worse in the greatest haste, and it knows no limit of jerk.
  void try_less_haste(double first_W) {
    if (!has_drive() || (!minimizes_time(mission()) && !has_jerk_limit())) return;
    const double middle_W = middle_price_W(*best_);
    const std::vector<double> calmer_W =
        minimizes_time(mission()) ? std::vector{kHaste * middle_W, middle_W} : std::vector{first_W / kHaste};
    for (const double price_W : calmer_W)
      if (price_W > 0) take({price_W});
  }

  /// The ways of the mission without its deadlines, in its own time and in the least one.
  void try_more_haste() {
    MissionRequest free = without_deadlines(mission());
    const Plan patient = plan_it_(free, {});
    if (is_driven(patient) && middle_price_W(patient) > 0) take({middle_price_W(patient)});
    free.objective.minimize = Objective::Minimize::time;
    const Plan hasty = plan_it_(free, {});
    for (const double haste : {kHaste, 1.0})
      if (is_driven(hasty) && middle_price_W(hasty) > 0) take({haste * middle_price_W(hasty)});
  }

  WaysRequest request_;
  const PlanOnWays& plan_it_;
  std::optional<Plan> best_{};
  std::exception_ptr refused_{};
};

}  // namespace

Plan plan_on_best_ways(const WaysRequest& request, const PlanOnWays& plan_it) {
  return WayTrials(request, plan_it).best();
}

}  // namespace joulepath
