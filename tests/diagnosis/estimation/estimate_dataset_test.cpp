#include "diagnosis/estimation/estimate_dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/simulation/simulate.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using testing::nomad;

Run simulated_run(const std::vector<EffectSetting>& effects, std::uint64_t seed) {
  SimulationRequest request{.robot = nomad(), .effects = effects, .seed = seed};
  request.reference = timed_motion(request.robot,
                                   {{.profile = MotionProfile::trapezoid, .speed_m_s = 0.6, .distance_m = 5},
                                    {.profile = MotionProfile::spin, .angle_rad = 2.0}},
                                   {.payload_kg = 4})
                          .trajectory;
  request.sensors = typical_sensors();
  return {.name = "run", .log = simulate(request).log};
}

Run prescribed_run(double factor) {
  const PrescribedMotion motion{
      .profile = MotionProfile::constant_ramp, .acceleration_m_s2 = 0.2, .ramp_s = 4, .distance_m = 10};
  const Trajectory t = timed_motion(nomad(), {motion}).trajectory;
  const EnergyEstimate estimate = estimate_energy(make_plant(nomad()), t, {.reach_s = 0.0});
  return {
      .name = "energy only",
      .motion = motion,
      .measured_energy_J = Sided<double>{factor * estimate.counted_J.left, factor * estimate.counted_J.right},
      .payload = {{0.0, 0.0}}};
}

TEST(EstimateDataset, FitnessIsTheShareOfRunsWithinTenPercent) {
  Dataset dataset{.robot = nomad()};
  for (double factor : {1.0, 1.05, 0.95, 1.25}) dataset.runs.push_back(prescribed_run(factor));
  const DatasetEstimate all = estimate_dataset(dataset);
  EXPECT_EQ(all.compared, 4u);
  EXPECT_DOUBLE_EQ(all.fitness, 0.75);
  EXPECT_NEAR(*all.runs[3].error, 1 / 1.25 - 1, 1e-12);
  EXPECT_NEAR(*all.model_error, std::sqrt((std::pow(1 / 1.05 - 1, 2) + std::pow(1 / 0.95 - 1, 2) + 0.04) / 4),
              1e-12);
}

TEST(EstimateDataset, LogsOfTheSameRobotAreWithinAPercentAndOthersAreNot) {
  Dataset same{.robot = nomad()};
  Dataset other{.robot = nomad()};
  for (std::uint64_t seed : {1, 2, 3}) {
    same.runs.push_back(simulated_run({}, seed));
    other.runs.push_back(
        simulated_run({{.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}}}, seed));
  }
  const DatasetEstimate good = estimate_dataset(same);
  const DatasetEstimate bad = estimate_dataset(other);
  EXPECT_LT(std::abs(good.mean_error), 0.01);
  EXPECT_EQ(good.fitness, 1.0);
  EXPECT_LT(bad.mean_error, -0.2);
  EXPECT_EQ(bad.fitness, 0.0);
}

TEST(EstimateDataset, UpperBoundHoldsTheEnergyTheLossAndTheErrors) {
  Dataset dataset{.robot = nomad()};
  dataset.robot.uncertainty = {{"standby_W", 0.1}};
  for (double factor : {1.1, 0.9, 1.0}) dataset.runs.push_back(prescribed_run(factor));
  const DatasetEstimate all = estimate_dataset(dataset);
  const RunEstimate& run = all.runs[0];
  const double duration_s = run.estimate.duration_s;
  EXPECT_NEAR(run.sigma_J, 0.1 * 10 * duration_s,
              0.02 * duration_s);  // the battery's loss grows a little too
  EXPECT_NEAR(run.upper_95_J,
              run.terminals_J + run.estimate.battery_loss_J +
                  1.644854 * std::hypot(run.sigma_J, *all.model_error * run.terminals_J),
              1e-6);
  EXPECT_NEAR(run.capacity_Wh, run.upper_95_J / 3600 / 0.9, 1e-9);
}

TEST(EstimateDataset, NinetyFivePercentOfRobotsStayBelowTheBound) {
  // Robots drawn from the file's uncertainty: their true energy against the bound that the file gives.
  Robot file = nomad();
  file.uncertainty = {{"friction_torque_Nm", 0.05}, {"standby_W", 0.05}, {"chassis_mass_kg", 0.03}};
  Dataset dataset{.robot = file};
  dataset.runs.push_back(prescribed_run(1.0));
  dataset.runs[0].measured_energy_J.reset();
  const double bound_J = estimate_dataset(dataset).runs[0].upper_95_J;
  std::uint64_t state = 12345;
  const auto normal = [&] {  // Box-Muller on a small generator of our own: the same draws everywhere
    const auto uniform = [&] {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      return (static_cast<double>(state >> 11) + 0.5) / 9007199254740992.0;
    };
    const double u = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(6.283185307179586 * uniform());
  };
  int below = 0;
  constexpr int kRobots = 2000;
  const Trajectory motion =
      timed_motion(file, {*dataset.runs[0].motion}, {.sample_period_s = 0.2}).trajectory;
  for (int k = 0; k < kRobots; ++k) {
    Robot robot = file;
    for (Side side : kSides) robot.motor[side].friction_torque_Nm *= 1 + 0.05 * normal();
    robot.power.standby_W *= 1 + 0.05 * normal();
    robot.inertia.chassis_mass_kg *= 1 + 0.03 * normal();
    const EnergyEstimate truth = estimate_energy(make_plant(robot), motion, {.reach_s = 0.0});
    below += truth.by_cause.total_J() + truth.battery_loss_J < bound_J;
  }
  EXPECT_NEAR(static_cast<double>(below) / kRobots, 0.95, 0.015);
}

}  // namespace
}  // namespace joulepath
