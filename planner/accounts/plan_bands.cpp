#include "planner/accounts/plan_bands.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/battery_charge.hpp"
#include "model/normal_quantiles.hpp"
#include "model/nuisance_correlation.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/accounts/winding_account.hpp"

namespace joulepath {
namespace {

/// Columns of the plan under one sigma more and less of each constant.
using ShiftedColumns = std::vector<std::array<std::vector<double>, 2>>;

/// The same motion of a robot with another constant.
struct OtherRobot {
  Plan plan{};
  Plant plant{};
};

OtherRobot with_error(const Plan& plan, const Plant& plant, const Nuisance& nuisance, double fraction) {
  OtherRobot other{plan, with_error(plant, nuisance, fraction)};
  for (LegPlan& leg : other.plan.legs)
    for (StretchPlan& stretch : leg.stretches)
      stretch.request.plant = with_error(std::move(stretch.request.plant), nuisance, fraction);
  return other;
}

/// 1-sigma of each row; nothing where all rows are certain.
std::optional<PlanBand> band(std::vector<double> time_s, std::vector<double> value,
                             const ShiftedColumns& shifted, const std::vector<double>& of_model,
                             const Eigen::MatrixXd& correlation) {
  PlanBand result{std::move(time_s), std::move(value), {}};
  for (std::size_t row = 0; row < result.value.size(); ++row) {
    std::vector<double> shifts;
    for (const auto& [more, less] : shifted) shifts.push_back(0.5 * (more[row] - less[row]));
    const double model = of_model.empty() ? 0.0 : of_model[row];
    result.sigma.push_back(std::sqrt(variance_of(shifts, model, correlation)));
  }
  const double most = *std::max_element(result.sigma.begin(), result.sigma.end());
  return most > 0 ? std::optional(std::move(result)) : std::nullopt;
}

/// State of charge at each row: from the charge before a leg to that after its driving, by the energy. The
/// charge that a charger adds during a dwell stands at the next leg's begin.
std::vector<double> fractions(const Plan& plan, const Trajectory& rows) {
  std::vector<double> list, before_J;
  double legs_J = 0;
  for (const LegPlan& leg : plan.legs) {
    before_J.push_back(legs_J);
    legs_J += leg.energy.total_J();
  }
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto k = static_cast<std::size_t>(rows.leg[row]);
    const BatteryAccount& battery = *plan.battery;
    const double before = k == 0 ? battery.start_fraction : battery.fraction_after_leg[k - 1];
    const double after =
        plan.legs[k].charged_J > 0 ? battery.least_fraction_on_leg[k] : battery.fraction_after_leg[k];
    const double leg_J = plan.legs[k].energy.total_J();
    const double share = leg_J > 0 ? (rows.energy_J[row] - before_J[k]) / leg_J : 1.0;
    list.push_back(before + (after - before) * share);
  }
  return list;
}

/// Sigma of energies as one of the state of charge: half the distance of its ends.
PlanBand charge_band(const PlanBand& energy, std::vector<double> value, const Battery& battery) {
  PlanBand band{energy.time_s, std::move(value), {}};
  for (std::size_t row = 0; row < band.value.size(); ++row)
    band.sigma.push_back(0.5 * (fraction_after(battery, band.value[row], -energy.sigma[row]) -
                                fraction_after(battery, band.value[row], energy.sigma[row])));
  return band;
}

}  // namespace

std::array<std::vector<double>, 2> ends_95(const PlanBand& band) {
  std::array ends{band.value, band.value};
  for (std::size_t k = 0; k < band.sigma.size(); ++k)
    ends[0][k] -= kNormal95 * band.sigma[k], ends[1][k] += kNormal95 * band.sigma[k];
  return ends;
}

PlanBands plan_bands(const Plan& plan, const Plant& plant, const std::vector<double>& times_s) {
  if (!plan.energy_sigma_J || times_s.empty()) return {};
  const double standby_W = plant.robot.power.standby_W;
  const auto heat_of = [&](const Plan& driven, const Plant& by) {
    return plan.winding ? winding_temperatures_C(driven, by, plan.winding->side, times_s)
                        : std::vector<double>{};
  };
  const Trajectory rows = plan_trajectory_at(plan, plant, times_s);
  const std::vector<double> heat = heat_of(plan, plant);
  ShiftedColumns power_W, energy_J, winding_C;
  for (const Nuisance& nuisance : nuisances_of(plant.robot)) {
    std::array<std::vector<double>, 2> watts, joules, celsius;
    for (const std::size_t side : {0u, 1u}) {
      const OtherRobot other =
          with_error(plan, plant, nuisance, side == 0 ? nuisance.sigma : -nuisance.sigma);
      Trajectory driven = plan_trajectory_at(other.plan, other.plant, times_s);
      watts[side] = std::move(driven.battery_power_W), joules[side] = std::move(driven.energy_J);
      celsius[side] = heat_of(other.plan, other.plant);
    }
    power_W.push_back(std::move(watts)), energy_J.push_back(std::move(joules));
    winding_C.push_back(std::move(celsius));
  }
  const double of_model = plant.robot.model_energy_sigma().value_or(0.0);
  std::vector<double> model_W, model_J;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    model_W.push_back(of_model * (rows.battery_power_W[row] - standby_W));
    model_J.push_back(of_model * (rows.energy_J[row] - standby_W * (times_s[row] - times_s.front())));
  }
  const Eigen::MatrixXd correlation = nuisance_correlation(plant.robot);
  PlanBands bands{.battery_power_W = band(times_s, rows.battery_power_W, power_W, model_W, correlation),
                  .energy_J = band(times_s, rows.energy_J, energy_J, model_J, correlation)};
  if (plan.winding) bands.winding_C = band(times_s, heat, winding_C, {}, correlation);
  if (plan.battery && bands.energy_J)
    bands.battery_fraction = charge_band(*bands.energy_J, fractions(plan, rows), plant.robot.battery);
  return bands;
}

}  // namespace joulepath
