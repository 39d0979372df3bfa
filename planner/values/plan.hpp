#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/energy.hpp"
#include "planner/values/baseline_result.hpp"
#include "planner/values/leg_state.hpp"
#include "planner/values/mission_request.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_request.hpp"
#include "planner/values/profile_result.hpp"
#include "planner/values/replay_result.hpp"

namespace joulepath {

/// A piece of path that is driven without a stop, as planned.
struct StretchPlan {
  ProfileRequest request;
  Profile profile{};
  SolveSummary summary{};
  ReplayResult replay{};
  EnergyByCause energy{};   ///< while driving
  double battery_loss_J{};  ///< in the internal resistance, while driving
  double lowest_voltage_V{kNoLimit};
  std::vector<double> sigma_shift_J{};  ///< of the energy, per uncertain constant that is one sigma higher
  std::vector<BaselineResult> baselines{};  ///< of the trapezoids that were requested
};

/// A baseline over several stretches, on the same path in the same time; in a later time where no such
/// profile keeps the plan's time. It is compared at its own time: with the least energy in that time.
struct BaselineTotal {
  std::string name{};
  bool feasible{true};
  std::string reason{};  ///< reason why it does not count
  double energy_J{};
  double motion_energy_J{};
  double duration_s{};
  double later_s{};           ///< delay after the plan's time
  double optimum_J{};         ///< least energy on the same path in this baseline's own time
  double optimum_motion_J{};  ///< without standby
  bool late() const { return later_s > 1e-3; }
  std::vector<std::map<std::string, double>> settings{};  ///< per stretch, in order
};

/// A candidate for the path of a leg, driven between the chosen ways of its neighbors, turns at both stops
/// included; where a stop names a heading, with the turns of this leg only.
struct PathAlternative {
  std::string name{};
  double energy_J{};  ///< standby included
  double duration_s{};
  double distance_m{};
  bool chosen{};
};

/// A leg after a step of choosing its way, scored by inner solves at the leg's price of a second.
struct WayImprovement {
  std::string step{};  ///< shortest_route | corners | routes | stops | refinement
  double energy_J{};   ///< standby included
  double duration_s{};
  double cost_J{};  ///< energy and time at its price
};

/// The energy below which no path of any kind leads from stop to stop in the plan's time or less.
struct PathBound {
  std::optional<double> energy_J{};  ///< dwell included; absent where there is a reason
  /// What the bound of the leg with the widest gap rests on: a straight line of the length of the shortest
  /// way, headings at the stops, or a shortest way around corners, which it drives as if it were straight.
  enum class Part { line, headings, corners };
  Part part{};
  std::string reason{};  ///< reason why there is no bound
};

struct LegPlan {
  std::string to{};  ///< station, `path` or `motion`
  std::string path_source{};
  SolveStatus status{SolveStatus::failed};
  PayloadAlongLeg payload{};
  std::vector<StretchPlan> stretches{};
  std::vector<PathPart> parts{};           ///< named by the mission: edges of an order
  std::optional<Trajectory> prescribed{};  ///< a prescribed motion, sampled; no stretches then
  double start_s{};                        ///< departure, from the mission's start
  Pose start_pose{};                       ///< where the robot stands then; a leg without motion stays there
  EffectMemory memory{};                   ///< of the effects, at the departure
  LegState state{};                        ///< of battery and windings, as its motion was planned
  double duration_s{};                     ///< driving
  double dwell_s{};
  double distance_m{};
  double turned_rad{};
  double price_of_time_W{};  ///< 0 where it is driven in least time
  bool in_least_time{};      ///< no price of time is high enough
  EnergyByCause energy{};    ///< driving and dwell
  double lower_bound_J{};    ///< no profiles of these stretches take less energy from departure to departure
  double gap_percent{};  ///< relative to its energy; where it is driven in least time, relative to its time
  std::optional<double> energy_sigma_J{};  ///< 1-sigma, as of the plan
  double charger_W{};                      ///< of the charger at its stop; 0: none
  double charged_J{};                      ///< energy charged there
  std::optional<PathBound> path_bound{};   ///< absent: not asked for
  std::vector<BaselineTotal> baselines{};
  std::vector<PathAlternative> alternatives{};
  std::vector<WayImprovement> improvements{};
};

/// The reason why a mission cannot be driven, and the smallest change found that would make it possible.
struct PlanInfeasibility {
  Infeasibility reason{};
  std::size_t leg{};
  std::string to{};       ///< where the leg leads, as in LegPlan
  double arc_length_m{};  ///< along the leg
  LegState state{};       ///< of battery and windings on the leg
};

/// The chosen order of stops of a mission with `visit:`.
struct VisitOrder {
  std::vector<std::size_t> order{};  ///< indices into MissionRequest::visit
  std::vector<LegRequest> legs{};
  bool exact{};                           ///< false: a beam search, with the bound below
  int planned_orders{};                   ///< in full, this one included
  double energy_J{};                      ///< of the order, from the table of leg energies
  std::optional<double> given_order_J{};  ///< of the stops as listed, where that order is possible
  double lower_bound_J{};                 ///< by the table: the cheapest way into each stop, without payload
  std::optional<Infeasibility> infeasibility{};
};

struct BatteryAccount {
  double start_fraction{};
  double end_fraction{};
  std::optional<std::array<double, 2>> interval_95{};  ///< of the end fraction, from the plan's sigma
  double loss_J{};                                     ///< in the internal resistance
  double charged_J{};                                  ///< at chargers on the way
  double required_capacity_Wh{};  ///< the largest energy between charges: its 95 % upper bound if the plan
                                  ///< has a sigma
  double missions_per_charge{};   ///< infinite for a mission that draws nothing
  double lowest_voltage_V{};
  std::optional<std::size_t> fails_on_leg{};  ///< first leg on which the charge falls below the reserve
  std::vector<double> fraction_after_leg{};
  /// With a curve: the least state of charge on each leg, and the greatest difference of the open-circuit
  /// voltage on a leg from the one that its motion was planned with.
  std::vector<double> least_fraction_on_leg{};
  std::optional<double> voltage_error_V{};
};

/// Temperatures of the windings over a plan.
struct WindingAccount {
  double highest_C{};
  Side side{};                                ///< of the highest temperature
  double above_limit_K{};                     ///< negative where the limit is kept
  std::optional<std::size_t> fails_on_leg{};  ///< first leg on which a winding is too hot
  double fails_at_s{};                        ///< from the mission's start
  double price_of_heat{};                     ///< the greatest of the legs
  /// At most on all legs, where that is for the temperatures' sake.
  std::optional<Sided<double>> planned_current_A{};
  std::vector<Sided<double>> hottest_on_leg_C{};
  std::vector<Sided<double>> after_leg_C{};               ///< after its dwell
  std::vector<Sided<double>> resistance_factor_on_leg{};  ///< mean by copper loss
};

/// A promise of a plan, with the share of drawn robots that keep it.
struct Promise {
  std::string name{};  ///< `arrival`, `reserve`, or a limit's name
  double kept{};
  bool binds{};  ///< a margin is left for it, and used up
};

/// With what probability the promises of a plan are kept together. The robot tracks the planned speed; it is
/// late only where a limit of motors, battery or tires saturates.
struct ConfidenceAccount {
  double asked{};
  std::size_t draws{};     ///< of the robot, from its `uncertainty:`; none of them shaped the plan
  double kept{};           ///< share of the draws that keep all promises
  double kept_at_least{};  ///< one-sided 95 % lower bound of the probability (Clopper-Pearson)
  std::vector<Promise> promises{};
  std::map<std::string, double> limit_shares{};  ///< of the limits, that the plan uses at most
  double reserve_margin{};                       ///< state of charge that the plan leaves above the reserve
  double kept_without{};                         ///< share of draws that the plan without margins keeps
  double energy_without_J{};                     ///< of the plan without margins
  double duration_without_s{};
};

/// The result for a mission.
struct Plan {
  std::string mission{};
  SolveStatus status{SolveStatus::failed};
  std::string message{};
  std::vector<LegPlan> legs{};
  EnergyByCause energy{};
  /// 1-sigma of energy from the robot file's `uncertainty:`; absent where the file states none.
  std::optional<double> energy_sigma_J{};
  bool sigma_has_model_error{};  ///< false: of the constants alone
  double duration_s{};
  double distance_m{};
  double lower_bound_J{};  ///< no profiles of these paths take less; NaN with a leg of least time
  double gap_percent{};
  bool local{};
  std::string solver{};
  int iterations{};
  double replay_energy_J{};
  double worst_violation{};
  std::string worst_limit{};
  std::optional<BatteryAccount> battery{};
  std::optional<WindingAccount> winding{};        ///< absent: the motors state no `thermal`
  std::optional<ConfidenceAccount> confidence{};  ///< absent: not asked for
  std::optional<VisitOrder> visit{};
  std::optional<PathBound> path_bound{};  ///< absent: not asked for
  std::vector<BaselineTotal> baselines{};
  std::optional<PlanInfeasibility> infeasibility{};
};

/// Whether a plan drives its mission within every limit.
[[nodiscard]] inline bool is_driven(const Plan& plan) { return plan.status <= SolveStatus::feasible; }

}  // namespace joulepath
