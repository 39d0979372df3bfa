#pragma once

#include <functional>

#include "planner/values/plan.hpp"

// What a verdict offers where another state of the battery or of the windings would do. Design:
// docs/decisions/0400-visits-and-charging.md
namespace joulepath {

/// Whether a mission is planned with a state of charge at its start.
using PlansWithFraction = std::function<bool(double)>;

/// Adds to the verdict on a mission that a fuller battery may drive the least `battery_fraction`, in
/// hundredths, with which it was planned; a verdict on the battery itself gets no other relaxation then.
/// For batteries with a curve.
void offer_charge(Plan& plan, const Robot& robot, double start_fraction, const PlansWithFraction& plans);

/// Whether a mission is planned with a battery of this capacity (Wh).
using PlansWithCapacity = std::function<bool(double)>;

/// Adds the capacity with which a mission that falls below the reserve was planned, to 2 %. For batteries
/// with a curve whose verdict has no other relaxation.
void offer_capacity(Plan& plan, const Robot& robot, const PlansWithCapacity& plans);

/// Whether a changed mission is planned.
using PlansMission = std::function<bool(const MissionRequest&)>;

/// Adds to the verdict on windings that are too hot the least dwell at every stop and the greatest payload
/// with which the mission was planned: to 10 %, and in steps of 5 %. `mission` is the one that was asked for.
void offer_cooling(Plan& plan, const MissionRequest& mission, const PlansMission& plans);

/// Plans a mission with a robot.
using PlanWith = std::function<Plan(const MissionRequest&, const Robot&)>;

/// Plans what the verdict of one place offers for a limit or a time. Where another place refuses that plan,
/// it offers what is enough there; an offer that leads to no plan is withdrawn.
void prove_offers(Plan& plan, const MissionRequest& mission, const Robot& robot, const PlanWith& plan_with);

/// What the message of a verdict tells of its offers.
[[nodiscard]] std::string offers_text(const Infeasibility& verdict, const MissionRequest& mission);

/// Gives a mission or its robot what a verdict offers under a key; false where it is neither's: a deadline.
[[nodiscard]] bool take_offer(const std::string& key, double value, MissionRequest& mission, Robot& robot);

}  // namespace joulepath
