#include "planner/confidence/promises.hpp"

#include <algorithm>
#include <cmath>

#include "planner/confidence/lateness.hpp"

namespace joulepath {

PlanDemands PromiseJudge::demands_of(const Plan& plan) const {
  return {plan,
          robot_,
          plant_,
          {.start_fraction = mission_.start.battery_fraction.value_or(1.0),
           .to_fraction = mission_.charging ? mission_.charging->to_fraction : 0.0}};
}

template <class DemandsOfSome>
Sample PromiseJudge::sample_of(const PlanDemand& nominal, PlantDraws& draws,
                               const DemandsOfSome& demands_of_some) const {
  constexpr std::size_t kTogether = 64;
  Sample sample{.nominal = nominal};
  while (sample.drawn.size() < draws_) {
    const std::size_t count = std::min(kTogether, draws_ - sample.drawn.size());
    for (const PlanDemand& demand : demands_of_some(draws.next_errors(count))) {
      const bool kept = keeps_limits(demand) && keeps_reserve(demand, robot_.battery.reserve_fraction);
      sample.kept += kept ? 1 : 0;
      sample.drawn.push_back(demand);
    }
  }
  return sample;
}

Sample PromiseJudge::estimated(const Plan& plan) const {
  const PlanDemands demands = demands_of(plan);
  PlantDraws draws(robot_, plant_, 0);
  return sample_of(demands.nominal(), draws,
                   [&](const Eigen::MatrixXd& errors) { return demands.estimate(errors); });
}

Sample PromiseJudge::judged(const Plan& plan, std::uint64_t seed) const {
  const PlanDemands demands = demands_of(plan);
  PlantDraws draws(robot_, plant_, seed);
  Sample sample = sample_of(demands.nominal(), draws,
                            [&](const Eigen::MatrixXd& errors) { return demands.of(errors, draws); });
  sample.seed = seed;
  return sample;
}

const std::vector<LegRequest>& PromiseJudge::legs_of(const Plan& plan) const {
  return plan.visit ? plan.visit->legs : mission_.legs;
}

bool PromiseJudge::has_deadline(const Plan& plan) const {
  const std::vector<LegRequest>& legs = legs_of(plan);
  return mission_.objective.deadline_s ||
         std::any_of(legs.begin(), legs.end(), [](const LegRequest& leg) { return leg.deadline_s; });
}

/// Whether a draw that saturates arrives in time at every stop with a deadline. A prescribed motion that may
/// be the one that saturates counts as late.
bool PromiseJudge::arrives(const Plan& plan, const PlanDemands& demands, const PlantDraw& draw) const {
  constexpr double kRounding_s = 1e-3;
  const std::vector<LegRequest>& legs = legs_of(plan);
  const DrawnPlant drawn = demands.plant_of(draw);
  double late_s = 0;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    const LegPlan& leg = plan.legs[k];
    if (leg.prescribed) return false;
    const Plant plant = drawn.on(leg, k);
    const Limits limits = demands.limits_on(k, plant);
    for (const StretchPlan& stretch : leg.stretches)
      late_s = std::max(0.0, late_s + lateness_s(stretch, plant, limits) - stretch.profile.wait_s);
    double due_s = kNoLimit;
    if (legs.size() == plan.legs.size()) due_s = legs[k].deadline_s.value_or(kNoLimit);
    if (k + 1 == plan.legs.size()) due_s = std::min(due_s, mission_.objective.deadline_s.value_or(kNoLimit));
    if (leg.start_s + leg.duration_s + late_s > due_s + kRounding_s) return false;
  }
  return true;
}

double PromiseJudge::arrival_share(const Plan& plan, const Sample& sample) const {
  const PlanDemands demands = demands_of(plan);
  PlantDraws draws(robot_, plant_, sample.seed);
  std::size_t late = 0;
  for (const PlanDemand& demand : sample.drawn) {
    const PlantDraw draw = draws.next();
    if (!keeps_forces(demand) && !arrives(plan, demands, draw)) ++late;
  }
  return 1 - static_cast<double>(late) / static_cast<double>(draws_);
}

std::vector<Promise> PromiseJudge::promises(const Plan& plan, const Sample& sample,
                                            const Margins& margins) const {
  constexpr double kUsedUp = 1e-4, kHeatUsedUp = 0.02;  // the price of heat is not found exactly
  const double reserve = robot_.battery.reserve_fraction;
  const auto share = [&](const auto& keeps) {
    return static_cast<double>(std::count_if(sample.drawn.begin(), sample.drawn.end(), keeps)) /
           static_cast<double>(draws_);
  };
  std::vector<Promise> promises;
  if (has_deadline(plan)) promises.push_back({"arrival", arrival_share(plan, sample)});
  if (std::isfinite(robot_.battery.capacity_Wh))
    promises.push_back(
        {"reserve", share([&](const PlanDemand& demand) { return keeps_reserve(demand, reserve); }),
         margins.reserve > 0 && sample.nominal.least_fraction < reserve + margins.reserve + kUsedUp});
  for (std::size_t i = 0; i < kUsedLimits; ++i)
    if (sample.nominal.use[i] > 0)
      promises.push_back(
          {used_limit_name(i), share([&](const PlanDemand& demand) { return keeps_limit(demand, i); }),
           margins.share[i] < 1 &&
               sample.nominal.use[i] > margins.share[i] - (i == kWindingLimit ? kHeatUsedUp : kUsedUp)});
  return promises;
}

}  // namespace joulepath
