#include "planner/battery_account.hpp"

#include <algorithm>
#include <cmath>

#include "model/nuisance.hpp"
#include "planner/prescribed_leg.hpp"

namespace joulepath {
namespace {

constexpr double kJoulesPerWh = 3600.0;
constexpr double k95 = 1.959964;  ///< two-sided 95 % of a normal distribution
constexpr double k95OneSided = 1.644854;
constexpr double kStep_s = 0.02;

struct LegLoss {
  double loss_J{};
  double lowest_voltage_V{kNoLimit};
};

void add_sample(LegLoss& loss, const Battery& battery, double power_W, double duration_s) {
  const BatteryLoad load = battery_load(battery, power_W);
  if (!load.possible) return;
  loss.loss_J += load.loss_W * duration_s;
  loss.lowest_voltage_V = std::min(loss.lowest_voltage_V, load.terminal_voltage_V);
}

/// Adds a drive of `duration_s` at the midpoints of steps of 20 ms; power_W(t) is at the terminals.
template <class Power>
void add_drive(LegLoss& loss, const Battery& battery, double duration_s, Power&& power_W) {
  const auto steps = static_cast<std::size_t>(std::ceil(duration_s / kStep_s));
  const double step_s = steps ? duration_s / static_cast<double>(steps) : 0.0;
  for (std::size_t k = 0; k < steps; ++k)
    add_sample(loss, battery, power_W((static_cast<double>(k) + 0.5) * step_s), step_s);
}

LegLoss loss_on(const LegPlan& leg, const Plant& plant) {
  LegLoss loss;
  const Battery& battery = plant.robot.battery;
  for (const StretchPlan& stretch : leg.stretches) {
    const PathMotion path = path_motion(stretch.request);
    add_drive(loss, battery, stretch.profile.duration_s(), [&](double time_s) {
      const ProfileState state = stretch.profile.at_time(time_s);
      const BodyMotion<double> motion =
          PathMotion::body_motion(path.rates(state.s), state.rate, state.acceleration);
      return power_by_cause(plant, motion, path.site(state.s, state.time_s)).total_W();
    });
  }
  if (leg.prescribed)
    add_drive(loss, battery, leg.duration_s, [&](double time_s) {
      const SampledState state = sampled_state(*leg.prescribed, leg.prescribed->time_s.front() + time_s);
      const Site site = site_of(plant.robot.geometry, state.pose, leg.payload.from_kg, state.motion.speed_m_s,
                                state.motion.yaw_rate_rad_s, time_s);
      return power_by_cause(plant, state.motion, site).total_W();
    });
  add_sample(loss, battery, plant.robot.power.standby_W, leg.dwell_s);
  return loss;
}

/// Energy of the planned motion when the robot differs from its file by one uncertain constant.
double energy_with(const Plan& plan, const Plant& plant, const Nuisance& nuisance, double fraction) {
  Plant other = plant;
  apply_nuisance(nuisance, fraction, other.robot);
  if (is_payload_nuisance(nuisance)) other.payload_factor *= 1.0 + fraction;
  double energy_J = 0.0;
  for (const LegPlan& leg : plan.legs) {
    for (const StretchPlan& stretch : leg.stretches) {
      ProfileRequest request = stretch.request;
      request.plant = other;
      energy_J += energy_by_cause(path_motion(request), stretch.profile).total_J();
    }
    if (leg.prescribed) energy_J += prescribed_energy(leg, other, 0.0, leg.duration_s).total_J();
    energy_J += other.robot.power.standby_W * leg.dwell_s;
  }
  return energy_J;
}

}  // namespace

double energy_sigma_J(const Plan& plan, const Plant& plant) {
  double variance_J2 = 0.0;
  for (const Nuisance& nuisance : nuisances_of(plant.robot)) {
    const double difference_J = energy_with(plan, plant, nuisance, nuisance.sigma) -
                                energy_with(plan, plant, nuisance, -nuisance.sigma);
    variance_J2 += 0.25 * difference_J * difference_J;
  }
  return std::sqrt(variance_J2);
}

std::optional<BatteryAccount> battery_account(Plan& plan, const Plant& plant, double start_fraction) {
  plan.energy_sigma_J = energy_sigma_J(plan, plant);
  const Battery& battery = plant.robot.battery;
  if (!std::isfinite(battery.capacity_Wh)) return std::nullopt;
  const double capacity_J = battery.capacity_Wh * kJoulesPerWh;
  BatteryAccount account{.start_fraction = start_fraction,
                         .lowest_voltage_V = battery.open_circuit_voltage_V};
  double drawn_J = 0.0;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    const LegLoss loss = loss_on(plan.legs[k], plant);
    account.loss_J += loss.loss_J;
    account.lowest_voltage_V = std::min(account.lowest_voltage_V, loss.lowest_voltage_V);
    drawn_J += plan.legs[k].energy.total_J() + loss.loss_J;
    account.fraction_after_leg.push_back(start_fraction - drawn_J / capacity_J);
    if (!account.fails_on_leg && account.fraction_after_leg.back() < battery.reserve_fraction)
      account.fails_on_leg = k;
  }
  const double half_width = k95 * plan.energy_sigma_J / capacity_J;
  account.end_fraction = start_fraction - drawn_J / capacity_J;
  account.interval_95 = {account.end_fraction - half_width, account.end_fraction + half_width};
  account.required_capacity_Wh = (drawn_J + k95OneSided * plan.energy_sigma_J) / kJoulesPerWh;
  const double usable_Wh = battery.capacity_Wh * (1.0 - battery.reserve_fraction);
  account.missions_per_charge =
      account.required_capacity_Wh > 0 ? std::floor(usable_Wh / account.required_capacity_Wh) : 0.0;
  return account;
}

std::optional<Infeasibility> battery_too_small(const Plan& plan, const Plant& plant) {
  if (!plan.battery || !plan.battery->fails_on_leg) return std::nullopt;
  const BatteryAccount& account = *plan.battery;
  const double missing_fraction = plant.robot.battery.reserve_fraction - account.end_fraction;
  const LegPlan& leg = plan.legs[*account.fails_on_leg];
  const Pose pose =
      leg.stretches.empty() ? Pose{} : piece_point(leg.stretches.front().request.piece, 0.0).pose;
  return Infeasibility{.constraint = "battery_reserve",
                       .x_m = pose.x_m,
                       .y_m = pose.y_m,
                       .amount = missing_fraction * plant.robot.battery.capacity_Wh,
                       .unit = "Wh",
                       .relaxation = {{"battery_fraction", account.start_fraction + missing_fraction}},
                       .message = "the battery falls below its reserve on the way"};
}

}  // namespace joulepath
