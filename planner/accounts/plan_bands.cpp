#include "planner/accounts/plan_bands.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "model/battery_charge.hpp"
#include "model/normal_quantiles.hpp"
#include "model/nuisance_correlation.hpp"
#include "planner/accounts/battery_account.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/accounts/stretch_account.hpp"
#include "planner/accounts/winding_account.hpp"
#include "planner/legs/leg_motion.hpp"

namespace joulepath {
namespace {

/// Half the difference of a column under one sigma more and less of each constant [constants x rows].
using Shifts = std::vector<std::vector<double>>;

/// What one sigma of each constant adds to the drives' power and energy, at the nodes of the energy integral.
struct DriveShifts {
  std::vector<double> time_s{0};
  Shifts power_W{}, energy_J{};
};

DriveShifts drive_shifts(const Plan& plan, const Plant& plant) {
  const std::size_t constants = nuisances_of(plant.robot).size();
  DriveShifts shifts{.power_W = Shifts(constants, {0.0}), .energy_J = Shifts(constants, {0.0})};
  std::vector<double> sum_J(constants);
  const auto add = [&](double time_s, double weight_s, const auto& shift_W) {
    shifts.time_s.push_back(time_s);
    for (std::size_t i = 0; i < constants; ++i) {
      const double watts = shift_W(i), joules = weight_s * watts;
      shifts.power_W[i].push_back(watts);
      shifts.energy_J[i].push_back(sum_J[i] + 0.5 * joules);
      sum_J[i] += joules;
    }
  };
  for (const LegPlan& leg : plan.legs) {
    const UncertainPlant here = uncertain(plant_in(plant, leg.state));
    LegMotion(leg, here.plant).integrate([&](const EnergyNode& node, double elapsed_s) {
      add(leg.start_s + elapsed_s, node.weight_s,
          [&](std::size_t i) { return power_shift_W(here.shifted[i], node); });
    });
  }
  add(plan.duration_s, 0.0, [](std::size_t) { return 0.0; });
  return shifts;
}

/// Columns of power and energy of the whole robot at times; at rest the power's is the standby's.
std::array<Shifts, 2> shifts_at(const std::vector<double>& times_s, const Plan& plan, const Plant& plant,
                                const std::vector<double>& power_W) {
  const DriveShifts drives = drive_shifts(plan, plant);
  const std::vector<std::array<Plant, 2>> shifted = uncertain(plant).shifted;
  std::array<Shifts, 2> columns{Shifts(shifted.size()), Shifts(shifted.size())};
  for (std::size_t row = 0; row < times_s.size(); ++row) {
    const auto after = std::upper_bound(drives.time_s.begin(), drives.time_s.end() - 1, times_s[row]);
    const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - drives.time_s.begin(), 1));
    const double from_s = drives.time_s[k - 1], length_s = drives.time_s[k] - from_s;
    const double share = length_s > 0 ? std::clamp((times_s[row] - from_s) / length_s, 0.0, 1.0) : 1.0;
    const bool rests = power_W[row] == plant.robot.power.standby_W;
    for (std::size_t i = 0; i < shifted.size(); ++i) {
      const double standby_W =
          0.5 * (shifted[i][0].robot.power.standby_W - shifted[i][1].robot.power.standby_W);
      const std::vector<double>&watts = drives.power_W[i], &joules = drives.energy_J[i];
      columns[0][i].push_back(standby_W + (rests ? 0.0 : watts[share < 0.5 ? k - 1 : k]));
      columns[1][i].push_back(standby_W * (times_s[row] - times_s.front()) +
                              std::lerp(joules[k - 1], joules[k], share));
    }
  }
  return columns;
}

/// 1-sigma of each row; nothing where all rows are certain.
std::optional<PlanBand> band(std::vector<double> time_s, std::vector<double> value, const Shifts& shifts,
                             const std::vector<double>& of_model, const Eigen::MatrixXd& correlation) {
  PlanBand result{std::move(time_s), std::move(value), {}};
  for (std::size_t row = 0; row < result.value.size(); ++row) {
    std::vector<double> at_row;
    for (const std::vector<double>& column : shifts) at_row.push_back(column[row]);
    const double model = of_model.empty() ? 0.0 : of_model[row];
    result.sigma.push_back(std::sqrt(variance_of(at_row, model, correlation)));
  }
  const double most = *std::max_element(result.sigma.begin(), result.sigma.end());
  return most > 0 ? std::optional(std::move(result)) : std::nullopt;
}

/// Temperatures along the same motion of a robot with another constant.
std::vector<double> other_windings_C(Plan plan, const Plant& plant, const Nuisance& nuisance, double fraction,
                                     const std::vector<double>& times_s) {
  for (LegPlan& leg : plan.legs)
    for (StretchPlan& stretch : leg.stretches)
      stretch.request.plant = with_error(std::move(stretch.request.plant), nuisance, fraction);
  return winding_temperatures_C(plan, with_error(plant, nuisance, fraction), plan.winding->side, times_s);
}

Shifts winding_shifts_K(const Plan& plan, const Plant& plant, const std::vector<double>& times_s) {
  Shifts shifts;
  for (const Nuisance& nuisance : nuisances_of(plant.robot)) {
    const auto other_C = [&](double fraction) {
      return other_windings_C(plan, plant, nuisance, fraction, times_s);
    };
    std::vector<double> more = other_C(nuisance.sigma);
    const std::vector<double> less = other_C(-nuisance.sigma);
    for (std::size_t row = 0; row < more.size(); ++row) more[row] = 0.5 * (more[row] - less[row]);
    shifts.push_back(std::move(more));
  }
  return shifts;
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
  const Trajectory rows = plan_trajectory_at(plan, plant, times_s);
  const auto [power_W, energy_J] = shifts_at(times_s, plan, plant, rows.battery_power_W);
  const double of_model = plant.robot.model_energy_sigma().value_or(0.0);
  std::vector<double> model_W, model_J;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    model_W.push_back(of_model * (rows.battery_power_W[row] - standby_W));
    model_J.push_back(of_model * (rows.energy_J[row] - standby_W * (times_s[row] - times_s.front())));
  }
  const Eigen::MatrixXd correlation = nuisance_correlation(plant.robot);
  PlanBands bands{.battery_power_W = band(times_s, rows.battery_power_W, power_W, model_W, correlation),
                  .energy_J = band(times_s, rows.energy_J, energy_J, model_J, correlation)};
  if (plan.winding)
    bands.winding_C = band(times_s, winding_temperatures_C(plan, plant, plan.winding->side, times_s),
                           winding_shifts_K(plan, plant, times_s), {}, correlation);
  if (plan.battery && bands.energy_J)
    bands.battery_fraction = charge_band(*bands.energy_J, fractions(plan, rows), plant.robot.battery);
  return bands;
}

}  // namespace joulepath
