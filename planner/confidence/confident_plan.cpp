#include "planner/confidence/confident_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "model/config_error.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/confidence/lateness.hpp"
#include "planner/confidence/margins.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kDraws = 4000;  ///< of one sample; more where the confidence is near 1
constexpr double kFailuresSeen = 30;  ///< draws that fail at the asked confidence, at least
constexpr int kRounds = 5, kSamples = 4;
constexpr double kNear = 0.02;        ///< error of a share by derivatives, by far
constexpr double kClose = 0.006;      ///< share of draws that a plan may keep beyond its aim
constexpr double kDoubtSigmas = 2.4;  ///< of a sample's share, between what is asked and what is aimed at

std::size_t draws_for(double confidence) {
  return std::max(kDraws, static_cast<std::size_t>(std::ceil(kFailuresSeen / (1 - confidence))));
}

/// The share of draws to aim at, so that a fresh sample shows the confidence that is asked for.
double aim_for(double confidence, std::size_t draws) {
  const double sigma = std::sqrt(confidence * (1 - confidence) / static_cast<double>(draws));
  return std::min(confidence + kDoubtSigmas * sigma, 1 - 2 / static_cast<double>(draws));
}

/// The mission whose legs follow the ways of a plan; the mission itself where it may insert stops.
MissionRequest on_ways_of(const Plan& plan, const MissionRequest& mission) {
  MissionRequest given = mission;
  if (plan.visit) given.legs = plan.visit->legs, given.visit.clear();
  if (mission.charging || given.legs.size() != plan.legs.size()) return mission;
  for (std::size_t k = 0; k < given.legs.size(); ++k) {
    if (given.legs[k].motion) continue;
    Path path;
    for (const StretchPlan& stretch : plan.legs[k].stretches) path.pieces.push_back(stretch.request.piece);
    given.legs[k].path = PathRequest{.frame = PathRequest::Frame::map, .ready = std::move(path)};
  }
  return given;
}

/// What is told about the choice of ways, from the plan that chose them.
void take_choices(Plan& plan, const Plan& chosen) {
  if (plan.legs.size() != chosen.legs.size()) return;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    plan.legs[k].to = chosen.legs[k].to;
    plan.legs[k].path_source = chosen.legs[k].path_source;
    plan.legs[k].alternatives = chosen.legs[k].alternatives;
    plan.legs[k].improvements = chosen.legs[k].improvements;
  }
  plan.visit = chosen.visit;
}

/// What draws of the robot make of a plan.
struct Sample {
  std::vector<PlanDemand> drawn{};
  PlanDemand nominal{};
  std::size_t kept{};
  double share() const { return static_cast<double>(kept) / static_cast<double>(drawn.size()); }
};

/// A mission whose plan is found in rounds.
class ConfidentPlanner {
 public:
  ConfidentPlanner(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                   const PlanOnce& plan_once)
      : mission_(mission),
        world_(world),
        options_(options),
        plan_once_(plan_once),
        plant_(make_plant(world.robot)),
        confidence_(*mission.objective.confidence),
        draws_(draws_for(confidence_)),
        aim_(aim_for(confidence_, draws_)) {}

  Plan plan() {
    Plan plain = plan_once_(mission_, world_, options_);
    if (plain.status > SolveStatus::feasible) return plain;
    account_ = {.asked = confidence_,
                .draws = draws_,
                .energy_without_J = plain.energy.total_J(),
                .duration_without_s = plain.duration_s};
    Sample sample = estimated_sample(plain);
    account_.kept_without = sample.share();
    if (sample.share() >= confidence_ - kNear) {
      const Sample judged = fresh_sample(plain);
      account_.kept_without = judged.share();
      if (is_shown(judged.kept, draws_, confidence_)) return with_account(std::move(plain), judged);
    }
    given_ = on_ways_of(plain, mission_);
    for (int trial = 0; trial < kSamples; ++trial) {
      if (const auto refused = find_margins(plain))
        if (!is_too_late(*refused) || !take_margins_of_fastest()) return as_verdict(*refused, plain);
      Plan plan = plan_with(margins_, options_);
      if (plan.status > SolveStatus::feasible) return as_verdict(std::move(plan), plain);
      sample = fresh_sample(plan);
      if (is_shown(sample.kept, draws_, confidence_)) {
        take_choices(plan, plain);
        return with_account(std::move(plan), sample);
      }
      aim_ = std::min(aim_ + kClose, 1.0);
    }
    return not_shown(std::move(plain));
  }

 private:
  Plan plan_with(const Margins& margins, PlanOptions options) const {
    options = with_limit_shares(std::move(options), margins.limit_shares());
    options.path_bound = false;  // of the mission as asked: plan_mission() adds it
    MissionWorld world = world_;
    world.robot.battery.reserve_fraction += margins.reserve;
    return plan_once_(given_, world, options);
  }

  /// Margins with which a plan keeps the aimed share of one sample; a verdict where no plan leaves them.
  std::optional<Plan> find_margins(const Plan& plain) {
    Plan plan = plain;
    double aim = aim_;
    for (int round = 0; round < kRounds; ++round) {
      const Sample sample = estimated_sample(plan);
      const double share = sample.share();
      if (round > 0 && share >= aim_ && share <= aim_ + kClose) return std::nullopt;
      if (round > 0) aim = std::clamp(aim + aim_ - share, confidence_, 1.0);
      margins_ = margins_for(sample.drawn, sample.nominal, reserve(), aim);
      plan = plan_with(margins_, quick());
      if (plan.status > SolveStatus::feasible) return plan;
    }
    return std::nullopt;
  }

  static bool is_too_late(const Plan& plan) {
    return plan.infeasibility && plan.infeasibility->reason.constraint == "deadline";
  }

  /// The margins of the fastest drive on these ways that keeps the confidence, for a deadline near its time;
  /// false where there is none. The draws that judged it are the next ones that judge here.
  bool take_margins_of_fastest() {
    MissionRequest fastest = given_;
    fastest.objective = {.minimize = Objective::Minimize::time, .confidence = confidence_};
    for (LegRequest& leg : fastest.legs) leg.deadline_s.reset();
    ConfidentPlanner planner(fastest, world_, quick(), plan_once_);
    if (planner.plan().status > SolveStatus::feasible) return false;
    margins_ = planner.margins_;
    seed_ = planner.seed_ - 1;
    return true;
  }

  /// Options of plans that only serve to find margins.
  PlanOptions quick() const {
    PlanOptions options = options_;
    options.solver = SolverChoice::fast;
    options.baselines = options.path_bound = false;
    return options;
  }

  double reserve() const { return world_.robot.battery.reserve_fraction; }

  PlanDemands demands_of(const Plan& plan) const {
    return {plan,
            world_.robot,
            plant_,
            {.start_fraction = mission_.start.battery_fraction.value_or(1.0),
             .to_fraction = mission_.charging ? mission_.charging->to_fraction : 0.0}};
  }

  /// What draws make of a plan, by derivatives. All plans see the same draws, which judge none of them.
  Sample estimated_sample(const Plan& plan) const {
    const PlanDemands demands = demands_of(plan);
    PlantDraws draws(plant_, 0);
    return sample_of(demands, [&] { return demands.estimate(draws.next_sigmas()); });
  }

  /// What draws that shaped no plan make of one, by the model.
  Sample fresh_sample(const Plan& plan) {
    const PlanDemands demands = demands_of(plan);
    PlantDraws draws(plant_, ++seed_);
    return sample_of(demands, [&] { return demands.of(draws.next()); });
  }

  template <class Next>
  Sample sample_of(const PlanDemands& demands, Next&& next) const {
    Sample sample{.nominal = demands.nominal()};
    for (std::size_t i = 0; i < draws_; ++i) {
      const PlanDemand& demand = sample.drawn.emplace_back(next());
      sample.kept += keeps_limits(demand) && keeps_reserve(demand, reserve()) ? 1 : 0;
    }
    return sample;
  }

  /// Whether a draw that saturates arrives in time at every stop with a deadline.
  bool arrives(const Plan& plan, const PlanDemands& demands, const PlantDraw& draw) const {
    const std::vector<LegRequest>& legs = plan.visit ? plan.visit->legs : mission_.legs;
    double late_s = 0;
    const Plant drawn = demands.plant_of(draw);
    for (std::size_t k = 0; k < plan.legs.size(); ++k) {
      const LegPlan& leg = plan.legs[k];
      const Plant plant = plant_in(drawn, leg.state);
      const Limits limits = demands.limits_on(k, plant);
      for (const StretchPlan& stretch : leg.stretches) {
        late_s += lateness_s(stretch, plant, limits);
        late_s = std::max(0.0, late_s - stretch.profile.wait_s);
      }
      const double arrival_s = leg.start_s + leg.duration_s + late_s;
      if (k < legs.size() && legs.size() == plan.legs.size() && legs[k].deadline_s &&
          arrival_s > *legs[k].deadline_s + kLate_s)
        return false;
      if (k + 1 == plan.legs.size() && mission_.objective.deadline_s &&
          arrival_s > *mission_.objective.deadline_s + kLate_s)
        return false;
    }
    return true;
  }

  bool has_deadline(const Plan& plan) const {
    const std::vector<LegRequest>& legs = plan.visit ? plan.visit->legs : mission_.legs;
    return mission_.objective.deadline_s ||
           std::any_of(legs.begin(), legs.end(), [](const LegRequest& leg) { return leg.deadline_s; });
  }

  /// The shares of the last sample that keep each promise on its own.
  std::vector<Promise> promises(const Plan& plan, const Sample& sample) const {
    std::vector<Promise> promises;
    const auto share = [&](const auto& keeps) {
      return static_cast<double>(std::count_if(sample.drawn.begin(), sample.drawn.end(), keeps)) /
             static_cast<double>(draws_);
    };
    if (has_deadline(plan)) promises.push_back({"arrival", arrival_share(plan, sample)});
    if (std::isfinite(world_.robot.battery.capacity_Wh))
      promises.push_back(
          {"reserve", share([&](const PlanDemand& d) { return keeps_reserve(d, reserve()); }),
           margins_.reserve > 0 && sample.nominal.least_fraction < reserve() + margins_.reserve + kUsedUp});
    for (std::size_t i = 0; i < kForceLimits; ++i)
      if (sample.nominal.use[i] > 0)
        promises.push_back({std::string(force_limits()[i]->name),
                            share([&](const PlanDemand& d) { return d.use[i] <= 1 + kUsedUp; }),
                            sample.nominal.use[i] > margins_.share[i] - kUsedUp});
    return promises;
  }

  double arrival_share(const Plan& plan, const Sample& sample) const {
    const PlanDemands demands = demands_of(plan);
    PlantDraws draws(plant_, seed_);
    std::size_t late = 0;
    for (const PlanDemand& demand : sample.drawn) {
      const PlantDraw draw = draws.next();
      if (!keeps_limits(demand) && !arrives(plan, demands, draw)) ++late;
    }
    return 1 - static_cast<double>(late) / static_cast<double>(draws_);
  }

  Plan with_account(Plan plan, const Sample& sample) {
    // The account of the battery is that of its own reserve.
    if (margins_.reserve > 0 && plan.battery)
      plan.battery = battery_account(plan, uncertain(plant_), plan.battery->start_fraction,
                                     mission_.charging ? mission_.charging->to_fraction : 0.0);
    account_.kept = sample.share();
    account_.kept_at_least = kept_at_least(sample.kept, draws_);
    account_.limit_shares = margins_.limit_shares();
    account_.reserve_margin = margins_.reserve;
    account_.promises = promises(plan, sample);
    plan.confidence = account_;
    return plan;
  }

  std::string percent(double share) const {
    char text[24];
    std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
    return text;
  }

  /// A plan that leaves the margins of its promises is not possible: so says its verdict.
  Plan as_verdict(Plan refused, const Plan& plain) const {
    if (refused.infeasibility) {
      std::string& message = refused.infeasibility->reason.message;
      message = "with " + percent(confidence_) + ": " + message +
                "; the plan without margins keeps its promises with " + percent(account_.kept_without);
      refused.message = message;
    }
    refused.visit = plain.visit;
    refused.confidence = account_;
    return refused;
  }

  Plan not_shown(Plan plain) const {
    plain.status = SolveStatus::failed;
    plain.message = "cannot promise " + percent(confidence_) +
                    ": no margins were found with which fresh draws of " +
                    "the robot show it; without margins it is " + percent(account_.kept_without);
    plain.confidence = account_;
    return plain;
  }

  static constexpr double kLate_s = 1e-3, kUsedUp = 1e-4;

  const MissionRequest& mission_;
  const MissionWorld& world_;
  PlanOptions options_;
  const PlanOnce& plan_once_;
  Plant plant_;
  double confidence_;
  std::size_t draws_;
  double aim_;
  std::uint64_t seed_{};
  MissionRequest given_{};
  Margins margins_{};
  ConfidenceAccount account_{};
};

}  // namespace

void need_uncertainty(const MissionRequest& mission, const Robot& robot) {
  if (!mission.objective.confidence || robot.model_energy_sigma()) return;
  throw ConfigError({{mission.robot_file, 1, 1},
                     robot.uncertainty.empty() ? "uncertainty" : "uncertainty.model_energy",
                     "nothing, although the mission asks for a confidence",
                     "relative 1-sigmas of the robot's constants, and model_energy among them",
                     "calibrate and diagnose measure them"});
}

Plan confident_plan(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                    const PlanOnce& plan_once) {
  need_uncertainty(mission, world.robot);
  return ConfidentPlanner(mission, world, options, plan_once).plan();
}

}  // namespace joulepath
