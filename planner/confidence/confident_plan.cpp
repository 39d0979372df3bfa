#include "planner/confidence/confident_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "model/config_error.hpp"
#include "model/printable.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/state_offers.hpp"
#include "planner/accounts/winding_account.hpp"
#include "planner/confidence/promises.hpp"
#include "planner/legs/on_ways.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kDraws = 4000;  ///< of one sample; more where the confidence is near 1
constexpr double kFailuresSeen = 45;  ///< draws that fail at the asked confidence, at least
constexpr int kRounds = 8, kTrials = 4;
constexpr double kRoughly = 1e-2;  ///< accuracy of plans that only serve to find margins
constexpr double kClose = 0.006;   ///< share of draws that a plan may keep beyond its aim
/// The plan without margins and each trial are judged once: together they are wrong with at most 5 %.
constexpr double kErrorOfOne = 0.05 / (1 + kTrials);
/// Of model_energy: friction of the whole mission stands for what the model lacks, and draws of more would
/// leave none.
constexpr double kMostUnknown = 0.25;
constexpr double kDoubtSigmas = 3.3;  ///< of a sample's share, between what is asked and what is aimed at

std::size_t draws_for(double confidence) {
  return std::max(kDraws, static_cast<std::size_t>(std::ceil(kFailuresSeen / (1 - confidence))));
}

/// The share of draws to aim at, so that a fresh sample shows the confidence that is asked for.
double aim_for(double confidence, std::size_t draws) {
  const double sigma = std::sqrt(confidence * (1 - confidence) / static_cast<double>(draws));
  return std::min(confidence + kDoubtSigmas * sigma, 1 - 2 / static_cast<double>(draws));
}

std::string percent(double share) { return four_digits(100 * share) + " %"; }

/// What is told about the choice of ways, from the plan that chose them.
void take_choices(Plan& plan, const Plan& chosen) {
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    plan.legs[k].to = chosen.legs[k].to;
    plan.legs[k].path_source = chosen.legs[k].path_source;
    plan.legs[k].alternatives = chosen.legs[k].alternatives;
    plan.legs[k].improvements = chosen.legs[k].improvements;
  }
  plan.visit = chosen.visit;
}

bool is_too_late(const Plan& plan) { return plan.infeasibility && is_late(plan.infeasibility->reason); }

/// The verdict on a mission that cannot be planned whatever is asked for.
Plan without_confidence(Plan plain) {
  if (plain.infeasibility) {
    plain.infeasibility->reason.message += "; this is without the confidence that is asked for";
    plain.message = plain.infeasibility->reason.message;
  }
  return plain;
}

Margins between(const Margins& a, const Margins& b) {
  Margins middle;
  for (std::size_t i = 0; i < kUsedLimits; ++i) middle.share[i] = 0.5 * (a.share[i] + b.share[i]);
  middle.reserve = 0.5 * (a.reserve + b.reserve);
  return middle;
}

/// Whether margins are within a tenth of larger ones.
bool are_close(const Margins& smaller, const Margins& larger) {
  constexpr double kPart = 0.9;
  for (std::size_t i = 0; i < kUsedLimits; ++i)
    if (1 - smaller.share[i] < kPart * (1 - larger.share[i])) return false;
  return smaller.reserve >= kPart * larger.reserve;
}

/// A mission whose plan is found in rounds.
class ConfidentPlanner {
 public:
  ConfidentPlanner(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                   const Planning& planning)
      : mission_(mission),
        world_(world),
        options_(options),
        planning_(planning),
        plant_(make_plant(world.robot)),
        confidence_(*mission.objective.confidence),
        draws_(draws_for(confidence_)),
        aim_(aim_for(confidence_, draws_)),
        judge_(mission, world_.robot, plant_, draws_) {}

  Plan plan() {
    Plan plain = planning_.plan(mission_, world_, options_);
    if (!is_driven(plain) && offers_) planning_.offer(plain, mission_, world_, options_);
    if (!is_driven(plain)) return without_confidence(std::move(plain));
    Sample sample = judge_.judged(plain, ++seed_);
    account_ = {.asked = confidence_,
                .draws = draws_,
                .kept_without = sample.share(),
                .energy_without_J = plain.energy.total_J(),
                .duration_without_s = plain.duration_s};
    if (is_shown(sample)) return with_account(std::move(plain), sample);
    drive_on_ways_of(std::move(plain));
    std::optional<Refused> refused = find_margins();
    const bool hardly = refused.has_value();
    for (int trial = 0; trial < kTrials; ++trial, aim_ = std::min(aim_ + kClose, 1.0)) {
      const Margins kept_too_little = margins_;
      if (trial > 0) tighten(margins_for(sample.drawn, sample.nominal, reserve(), aim_));
      Plan plan = plan_with(margins_, options_);
      while (!is_driven(plan) && is_too_late(plan) && take_margins_of_fastest())
        plan = plan_with(margins_, options_);
      if (!is_driven(plan) && !refused) refused = {plan, margins_, &given_};
      if (!is_driven(plan) && (trial == 0 || hardly)) break;
      if (!is_driven(plan)) plan = plan_between(kept_too_little);
      if (!is_driven(plan)) break;
      if (has_fixed_ways_) take_choices(plan, chosen_);
      sample = judge_.judged(plan, ++seed_);
      if (is_shown(sample)) return with_account(std::move(plan), sample);
      chosen_.confidence = account_;
      chosen_.confidence->promises = judge_.promises(plan, sample, margins_);
    }
    return refused ? as_verdict(*std::move(refused)) : not_shown();
  }

 private:
  /// A verdict, with the margins that a mission was planned with: without what would do instead.
  struct Refused {
    Plan plan{};
    Margins margins{};
    const MissionRequest* mission{};
  };

  /// The legs follow the ways of a plan from now on, except where stops may be inserted.
  void drive_on_ways_of(Plan plan) {
    given_ = on_ways_of(plan, mission_);
    has_fixed_ways_ = !mission_.charging && given_.legs.size() == plan.legs.size();
    chosen_ = std::move(plan);
  }

  Plan plan_with(const Margins& margins, const PlanOptions& options) const {
    return plan_with(margins, options, given_);
  }
  Plan plan_with(const Margins& margins, const PlanOptions& options, const MissionRequest& mission) const {
    return planning_.plan(mission, with(margins), with(margins, options));
  }
  MissionWorld with(const Margins& margins) const {
    MissionWorld world = world_;
    world.robot = with_margins(std::move(world.robot), margins.limit_shares(), margins.reserve);
    return world;
  }
  static PlanOptions with(const Margins& margins, const PlanOptions& options) {
    return with_limit_shares(options, margins.limit_shares());
  }

  /// With margins between those that kept too little and the present ones, which no plan leaves.
  Plan plan_between(const Margins& too_little) {
    Plan plan{.status = SolveStatus::infeasible};
    for (int round = 0; !is_driven(plan) && round < kRounds; ++round)
      plan = plan_with(margins_ = between(too_little, margins_), options_);
    return plan;
  }

  /// Options of plans that only serve to find margins.
  PlanOptions quick() const {
    PlanOptions options = options_;
    options.solver = SolverChoice::fast;
    options.accuracy = std::max(options.accuracy, kRoughly);
    return options;
  }

  /// Sets margins with which a plan keeps the aimed share; a verdict where no plan was found that leaves
  /// them. Where the ways of the plan without margins do not, others are tried once, then the margins of the
  /// fastest drive.
  std::optional<Refused> find_margins() {
    std::optional<Refused> refused = margins_on_ways();
    if (refused && has_fixed_ways_ && !tried_others_) {
      tried_others_ = true;
      Plan other = plan_with(margins_, quick(), mission_);
      if (is_driven(other)) {
        drive_on_ways_of(std::move(other));
        refused = margins_on_ways();
      } else if (mission_.legs.empty()) {  // of stops to visit, whose verdict names their keys
        refused = {std::move(other), margins_, &mission_};
      }
    }
    if (refused && is_too_late(refused->plan) && take_margins_of_fastest()) return std::nullopt;
    return refused;
  }

  /// Margins between those with which a plan keeps too little and those with which it keeps enough, or which
  /// no plan leaves; from the joint quantile where there are none yet.
  std::optional<Refused> margins_on_ways() {
    Plan plan = chosen_;
    double aim = aim_;
    Sample sample = judge_.estimated(plan);
    Margins too_little;
    std::optional<Margins> enough, too_much;
    std::optional<Refused> refused;
    for (int round = 0; round < kRounds; ++round) {
      if (enough || too_much)
        margins_ = between(too_little, enough ? *enough : *too_much);
      else
        margins_ = margins_for(sample.drawn, sample.nominal, reserve(), aim);
      plan = plan_with(margins_, quick());
      if (!is_driven(plan)) {
        too_much = margins_;
        refused = {std::move(plan), margins_, &given_};
        if (are_close(too_little, *too_much)) break;
        continue;
      }
      sample = judge_.estimated(plan);
      const double share = sample.share();
      if (share >= aim_ && share <= aim_ + kClose) return std::nullopt;
      (share < aim_ ? too_little : enough.emplace()) = margins_;
      aim = std::clamp(aim + aim_ - share, confidence_, 1.0);
    }
    if (enough)
      margins_ = *enough;
    else if (too_much)
      margins_ = *too_much;
    return enough ? std::nullopt : refused;
  }

  /// The margins of the fastest drive on these ways that keeps the confidence, for times near its own: found
  /// roughly at first, then as a plan of least time finds them. False where there is none.
  bool take_margins_of_fastest() {
    if (fastest_tried_ == 2) return false;
    const bool roughly = fastest_tried_++ == 0;
    MissionRequest fastest = given_;
    fastest.objective = {.minimize = Objective::Minimize::time, .confidence = confidence_};
    for (LegRequest& leg : fastest.legs) leg.deadline_s.reset(), leg.duration_s.reset();
    ConfidentPlanner planner(fastest, world_, roughly ? quick() : options_, planning_);
    if (roughly) planner.aim_ = std::min(aim_ + kClose, 1.0);
    planner.seed_ = seed_;
    planner.offers_ = false;
    if (!is_driven(planner.plan())) return false;
    margins_ = planner.margins_;
    seed_ = planner.seed_;
    return true;
  }

  /// What the model says of a plan whose margins were found by derivatives and are not enough.
  void tighten(const Margins& by_model) {
    for (std::size_t i = 0; i < kUsedLimits; ++i)
      margins_.share[i] = std::min(margins_.share[i], by_model.share[i]);
    margins_.reserve = std::max(margins_.reserve, by_model.reserve);
  }

  double reserve() const { return world_.robot.battery.reserve_fraction; }
  bool is_shown(const Sample& sample) const {
    return joulepath::is_shown(sample.kept, draws_, confidence_, kErrorOfOne);
  }

  Plan with_account(Plan plan, const Sample& sample) {
    // The accounts of battery and windings are those of their own limits.
    if (margins_.reserve > 0 && plan.battery)
      plan.battery = battery_account(plan, uncertain(plant_), plan.battery->start_fraction,
                                     mission_.charging ? mission_.charging->to_fraction : 0.0);
    if (plan.winding) plan.winding = winding_account(plan, plant_);
    account_.kept = sample.share();
    account_.kept_at_least = kept_at_least(sample.kept, draws_, kErrorOfOne);
    account_.limit_shares = margins_.limit_shares();
    account_.reserve_margin = margins_.reserve;
    account_.promises = judge_.promises(plan, sample, margins_);
    plan.confidence = account_;
    return plan;
  }

  /// What keeps a mission from being planned with this confidence, and a little more; empty: nothing.
  std::string refusal_of(const MissionRequest& mission, const MissionWorld& world) const {
    ConfidentPlanner planner(mission, world, quick(), planning_);
    planner.aim_ = std::min(aim_ + kClose, 1.0);
    planner.offers_ = false;
    const Plan plan = planner.plan();
    if (is_driven(plan)) return "";
    return plan.infeasibility ? plan.infeasibility->reason.constraint : plan.message;
  }

  /// A value that a verdict offers, or one near it with which the mission is planned; none where all are in
  /// vain.
  std::optional<double> promised_value(const std::string& key, double offered, const Refused& refused) const {
    const bool less_is_more = key == "payload_kg" || key == "internal_resistance_ohm";
    const double most = key == "battery_fraction" ? 1.0 : kNoLimit;
    for (const double more : {1.0, 1.05, 1.15, 1.4}) {
      const double value = less_is_more ? offered / more : std::min(offered * more, most);
      MissionRequest mission = *refused.mission;
      MissionWorld world = world_;
      if (!take_offer(key, value, mission, world.robot)) return value;
      const std::string refusal = refusal_of(mission, world);
      if (refusal.empty()) return value;
      if (value == most || refusal != refused.plan.infeasibility->reason.constraint) break;
    }
    return std::nullopt;
  }

  /// A limit that a plan used a share of is told in full, and what is offered with the value that is enough
  /// for the confidence.
  void keep_what_is_promised(Refused& refused) const {
    Infeasibility& reason = refused.plan.infeasibility->reason;
    const std::string told = offers_text(reason, *refused.mission);
    std::map<std::string, double> offered = std::exchange(reason.relaxation, {});
    for (const auto& [name, share] : refused.margins.limit_shares()) {
      if (name == kWindingTemperature) continue;
      if (reason.constraint == name) reason.amount /= share;
      if (const auto at = offered.find(std::string(limit_named(name)->key)); at != offered.end())
        at->second /= share;
    }
    for (const auto& [key, value] : offered)
      if (const auto promised = promised_value(key, value, refused)) reason.relaxation[key] = *promised;
    tell_anew(refused.plan, told, offers_text(reason, *refused.mission));
  }

  /// Judged again, a plan of what is offered for charge or heat has some slack.
  void give_slack(Refused& refused) const {
    const std::string& constraint = refused.plan.infeasibility->reason.constraint;
    if (constraint != "battery_reserve" && constraint != kWindingTemperature) return;
    const Sample sample = judge_.estimated(chosen_);
    const Margins margins =
        margins_for(sample.drawn, sample.nominal, reserve(), std::min(aim_ + 2 * kClose, 1.0));
    Plan slack = plan_with(margins, quick(), *refused.mission);
    if (slack.infeasibility) refused = {std::move(slack), margins, refused.mission};
  }

  /// A plan that leaves the margins of its promises is not possible: so says its verdict.
  Plan as_verdict(Refused refused) const {
    if (refused.plan.infeasibility && offers_) {
      give_slack(refused);
      planning_.offer(refused.plan, *refused.mission, with(refused.margins), with(refused.margins, quick()));
      keep_what_is_promised(refused);
    }
    Plan plan = std::move(refused.plan);
    if (plan.infeasibility)
      plan.message = plan.infeasibility->reason.message =
          "with " + percent(confidence_) + ": " + plan.infeasibility->reason.message +
          "; the plan without margins keeps its promises with " + percent(account_.kept_without) +
          " of the draws, which shows " + percent(shown_without());
    plan.confidence = account_;
    return plan;
  }

  double shown_without() const {
    const double kept = std::round(account_.kept_without * static_cast<double>(draws_));
    return kept_at_least(static_cast<std::size_t>(kept), draws_, kErrorOfOne);
  }

  Plan not_shown() const {
    Plan plan = chosen_;
    plan.status = SolveStatus::failed;
    plan.message =
        "cannot promise " + percent(confidence_) + ": no plan with margins was found that shows it";
    for (const Promise& promise : plan.confidence->promises)
      if (promise.kept < confidence_)
        plan.message += "; " + promise.name + " is kept with " + percent(promise.kept);
    return plan;
  }

  const MissionRequest& mission_;
  const MissionWorld& world_;
  PlanOptions options_;
  const Planning& planning_;
  Plant plant_;
  double confidence_;
  std::size_t draws_;
  double aim_;
  PromiseJudge judge_;
  std::uint64_t seed_{};    ///< of the last draws that judged; those of 0 find margins
  MissionRequest given_{};  ///< the mission on the ways of `chosen_`
  Plan chosen_{};           ///< without margins
  bool has_fixed_ways_{};
  bool tried_others_{};
  int fastest_tried_{};
  bool offers_{true};
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

KeptShare kept_share(const Plan& plan, const MissionRequest& mission, const Robot& robot, double confidence) {
  const std::size_t draws = draws_for(confidence);
  const Plant plant = make_plant(robot);
  const Sample sample = PromiseJudge(mission, robot, plant, draws).judged(plan, 1);
  return {sample.share(), kept_at_least(sample.kept, draws)};
}

Plan confident_plan(const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options,
                    const Planning& planning) {
  need_uncertainty(mission, world.robot);
  const double unknown = *world.robot.model_energy_sigma();
  if (unknown > kMostUnknown) {
    Plan plan = planning.plan(mission, world, options);
    if (!is_driven(plan)) planning.offer(plan, mission, world, options);
    if (!is_driven(plan)) return without_confidence(std::move(plan));
    plan.status = SolveStatus::failed;
    plan.message = "cannot promise " + percent(*mission.objective.confidence) + ": the model misses " +
                   percent(unknown) + " of the energy of motion (" + printable(mission.robot_file) +
                   ": uncertainty.model_energy), above " + percent(kMostUnknown) +
                   "; `joulepath diagnose` names what it lacks";
    return plan;
  }
  return ConfidentPlanner(mission, world, options, planning).plan();
}

}  // namespace joulepath
