#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "planner/accounts/stretch_account.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// State of charge along a plan, with the loss in the internal resistance; absent where the robot file gives
/// no capacity. At legs with a charger the battery charges during the dwell, up to a fraction. The 95 %
/// interval comes from the robot file's uncertainty, propagated to the energy to first order; without one
/// there is none. Missions per charge are counted down to the reserve, at the upper bound where the interval
/// holds the model's own error, else at the expected energy. Sets the plan's sigmas and the charged energy of
/// its legs.
[[nodiscard]] std::optional<BatteryAccount> battery_account(Plan& plan, const UncertainPlant& plant,
                                                            double start_fraction,
                                                            double charge_to_fraction = 1.0);

/// Part of the standby power (W) that the charger at a leg's stop feeds.
[[nodiscard]] double fed_W(const LegPlan& leg, double standby_W);

/// Time (s) at rest on the battery: waits, and the dwell except where a charger feeds the robot.
[[nodiscard]] double resting_s(const LegPlan& leg, double standby_W);

/// The least state of charge on all legs of a mission, which has one.
[[nodiscard]] double least_fraction(const BatteryAccount& account);

/// The verdict where the state of charge falls below the reserve.
[[nodiscard]] std::optional<Infeasibility> battery_too_small(const Plan& plan, const Plant& plant);

/// The verdict on a battery that cannot feed a robot that only stands (W of standby); nothing if it can.
[[nodiscard]] std::optional<Infeasibility> battery_too_weak(const Robot& robot, const Pose& pose);

/// Whether the whole mission is planned with another robot.
using PlansBy = std::function<bool(const Robot&)>;

/// A verdict on `battery_power` whose limit is the battery itself, U^2/(4 R), and not the one that the robot
/// file states for the payload of the leg, names an internal resistance with which the mission was planned.
void blame_battery(Plan& plan, const Robot& robot, const PayloadAlongLeg& payload, const PlansBy& plans);

/// A verdict on the battery's voltage or its charging power offers keys of the robot file instead of these
/// values: an internal resistance or a greatest charge current with which the mission was planned.
void name_battery_keys(Plan& plan, const Robot& robot, const PlansBy& plans);

/// Replaces what the message of a plan's verdict tells, where it does.
void tell_anew(Plan& plan, const std::string& told, const std::string& now);

/// 1-sigma of the energy (J) of a plan and of each of its legs, from the entries of `uncertainty:` with their
/// correlations, each propagated through the power model along the planned motion by central differences, and
/// the model's own error. Errors of the legs are correlated, so the plan's sigma is above
/// the root sum of squares of the legs. Where all constants are exact, or none is stated, nothing is set.
void find_energy_sigmas(Plan& plan, const UncertainPlant& plant);

/// Variance of a quantity from its changes at one sigma of each uncertain constant, and from the model's own
/// error of it.
[[nodiscard]] double variance_of(const std::vector<double>& shifts, double of_model,
                                 const Eigen::MatrixXd& correlation);

}  // namespace joulepath
