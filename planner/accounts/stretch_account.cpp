#include "planner/accounts/stretch_account.hpp"

#include <algorithm>
#include <cmath>

#include "model/nuisance.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/motion/replay.hpp"
#include "planner/values/answer_fields.hpp"

namespace joulepath {

namespace {

struct DriveAccount {
  ReplayResult replay{};
  EnergyByCause energy{};
  double battery_loss_J{};
  double lowest_voltage_V{};
  std::vector<double> sigma_shift_J{};
};

template <class Archive>
void each_field(Archive& archive, DriveAccount& value) {
  auto& [replay, energy, battery_loss_J, lowest_voltage_V, sigma_shift_J] = value;
  archive(replay, energy, battery_loss_J, lowest_voltage_V, sigma_shift_J);
}

/// Accounts for the nodes of the energy integral in one pass, for all constants.
DriveAccount drive_account(const ProfileRequest& request, const Profile& profile,
                           const UncertainPlant& plant) {
  const PathMotion motion = path_motion(request);
  DriveAccount account{.replay = replay(request, profile),
                       .sigma_shift_J = std::vector<double>(plant.shifted.size(), 0.0)};
  EnergySum sum(request.plant);
  integrate_profile(motion, profile, 0.0, profile.duration_s(), [&](const EnergyNode& node) {
    sum.add(node);
    for (std::size_t i = 0; i < plant.shifted.size(); ++i)
      account.sigma_shift_J[i] += node.weight_s * power_shift_W(plant.shifted[i], node);
  });
  account.energy = sum.by_cause();
  account.energy.standby_J += request.plant.robot.power.standby_W * profile.wait_s;
  account.battery_loss_J = sum.battery_loss_J();
  account.lowest_voltage_V = sum.lowest_voltage_V();
  return account;
}

}  // namespace

Plant with_error(Plant plant, const Nuisance& nuisance, double fraction) {
  apply_nuisance(nuisance, fraction, plant.robot);
  if (is_payload_nuisance(nuisance)) plant.payload_factor *= 1.0 + fraction;
  return plant;
}

UncertainPlant uncertain(Plant plant) {
  UncertainPlant all{.plant = std::move(plant)};
  for (const Nuisance& nuisance : nuisances_of(all.plant.robot))
    all.shifted.push_back(
        {with_error(all.plant, nuisance, nuisance.sigma), with_error(all.plant, nuisance, -nuisance.sigma)});
  return all;
}

double power_shift_W(const std::array<Plant, 2>& shifted, const EnergyNode& node) {
  const auto power_W = [&](const Plant& other) {
    return drive_power_W(other, energy_node(other, node.instant, node.time_s));
  };
  return 0.5 * (power_W(shifted[0]) - power_W(shifted[1]));
}

void account_for(StretchPlan& stretch, const UncertainPlant& plant, const SharedAnswers& answers) {
  DriveAccount account = remembered(
      answers, "stretch account", [&] { return drive_account(stretch.request, stretch.profile, plant); },
      stretch.request, stretch.profile);
  stretch.replay = std::move(account.replay);
  stretch.energy = std::move(account.energy);
  stretch.battery_loss_J = account.battery_loss_J;
  stretch.lowest_voltage_V = account.lowest_voltage_V;
  stretch.sigma_shift_J = std::move(account.sigma_shift_J);
}

double gap_percent(double energy_J, double bound_J) {
  return 100 * (energy_J - bound_J) / std::max(1e-9, std::abs(energy_J));
}

void bound_wait(StretchPlan& stretch, double wait_s, double price_W) {
  const double standby_W = stretch.request.plant.robot.power.standby_W;
  SolveSummary& summary = stretch.summary;
  if (wait_s == 0 || std::isnan(summary.lower_bound_J)) return;
  summary.lower_bound_J += (standby_W - std::max(0.0, price_W + standby_W)) * wait_s;
  summary.gap_percent = gap_percent(stretch.energy.total_J(), summary.lower_bound_J);
}

}  // namespace joulepath
