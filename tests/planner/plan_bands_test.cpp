#include "planner/accounts/plan_bands.hpp"

#include <gtest/gtest.h>

#include "model/normal_quantiles.hpp"
#include "planner/mission/mission.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// A robot whose windings can be heated, with stated errors.
Robot doubtful(std::map<std::string, double> uncertainty) {
  Robot robot = testing::nomad();
  robot.battery.capacity_Wh = 20;
  for (const Side side : kSides)
    robot.motor[side].thermal = {
        .resistance_K_W = 6, .capacity_J_K = 250, .max_winding_C = 155, .ambient_C = 25};
  robot.uncertainty = std::move(uncertainty);
  return robot;
}

Plan two_legs(const Robot& robot) {
  MissionRequest mission{.name = "bands"};
  for (int k = 0; k < 2; ++k)
    mission.legs.push_back(
        {.path = PathRequest{.bezier_m = {{{{0, 0}, {1, 0}, {2, 0}, {4, 0}}}}}, .dwell_s = 6});
  return plan_mission(mission, {.robot = robot},
                      {.solver = SolverChoice::fast, .nodes = 30, .baselines = false});
}

std::vector<double> times_of(const Plan& plan) {
  std::vector<double> times_s;
  for (int k = 0; k <= 400; ++k) times_s.push_back(plan.duration_s * k / 400);
  return times_s;
}

PlanBands bands_of(const Plan& plan, const Robot& robot) {
  return plan_bands(plan, make_plant(robot), times_of(plan));
}

TEST(PlanBands, EndWithTheSigmaOfTheEnergyAndTheIntervalOfTheCharge) {
  Robot robot = doubtful({{"standby_W", 0.1},
                          {"friction_torque_Nm", 0.05},
                          {"viscous_friction_Nm_s_rad", 0.3},
                          {"model_energy", 0.06}});
  robot.uncertainty_correlations = {{"friction_torque_Nm", "viscous_friction_Nm_s_rad", -0.5}};
  const Plan plan = two_legs(robot);
  ASSERT_TRUE(plan.energy_sigma_J && plan.battery && plan.battery->interval_95) << plan.message;
  const PlanBands bands = bands_of(plan, robot);
  ASSERT_TRUE(bands.energy_J && bands.battery_fraction);
  EXPECT_NEAR(bands.energy_J->value.back(), plan.energy.total_J(), 1e-4 * plan.energy.total_J());
  EXPECT_NEAR(bands.energy_J->sigma.back(), *plan.energy_sigma_J, 2e-3 * *plan.energy_sigma_J);
  const auto& [low, high] = *plan.battery->interval_95;
  const double end = bands.battery_fraction->value.back();
  EXPECT_NEAR(end, plan.battery->end_fraction, 1e-3 * (plan.battery->start_fraction - end));
  EXPECT_NEAR(end - kNormal95 * bands.battery_fraction->sigma.back(), low, 3e-3 * (high - low));
  EXPECT_EQ(bands.battery_fraction->sigma.front(), 0.0);
}

TEST(PlanBands, APowerAtRestIsAsSureAsTheStandbyPower) {
  const Robot robot = doubtful({{"standby_W", 0.1}, {"model_energy", 0.06}});
  const Plan plan = two_legs(robot);
  const PlanBands bands = bands_of(plan, robot);
  ASSERT_TRUE(bands.battery_power_W);
  EXPECT_NEAR(bands.battery_power_W->sigma.back(), 0.1 * robot.power.standby_W, 1e-9);
  const auto most =
      std::max_element(bands.battery_power_W->value.begin(), bands.battery_power_W->value.end());
  const double sigma =
      bands.battery_power_W->sigma[static_cast<std::size_t>(most - bands.battery_power_W->value.begin())];
  EXPECT_NEAR(sigma, std::hypot(0.1 * robot.power.standby_W, 0.06 * (*most - robot.power.standby_W)), 1e-9);
}

/// With the current given, the heat is in proportion to the resistance; the mean temperature is low here, so
/// that copper hardly grows in resistance.
TEST(PlanBands, AWindingsRiseIsAsSureAsItsResistance) {
  const Robot robot = doubtful({{"resistance_ohm", 0.03}});
  const Plan plan = two_legs(robot);
  const PlanBands bands = bands_of(plan, robot);
  ASSERT_TRUE(bands.winding_C);
  const double rise_K = bands.winding_C->value.back() - 25;
  ASSERT_GT(rise_K, 0);
  EXPECT_NEAR(bands.winding_C->sigma.back(), 0.03 * rise_K, 0.002 * rise_K);
  EXPECT_NEAR(*std::max_element(bands.winding_C->value.begin(), bands.winding_C->value.end()),
              plan.winding->highest_C, 0.02 * rise_K);
}

/// No constant is uncertain, only the model.
TEST(PlanBands, OfTheModelAloneAreInProportionToTheMotion) {
  const Robot robot = doubtful({{"model_energy", 0.06}});
  const Plan plan = two_legs(robot);
  const PlanBands bands = bands_of(plan, robot);
  ASSERT_TRUE(bands.energy_J);
  EXPECT_NEAR(bands.energy_J->sigma.back(), 0.06 * plan.energy.motion_J(), 1e-4 * plan.energy.motion_J());
}

TEST(PlanBands, NoneWhereNothingIsUncertain) {
  for (const auto& stated :
       {std::map<std::string, double>{}, {{"standby_W", 0.0}, {"resistance_ohm", 0.0}}}) {
    const Robot robot = doubtful(stated);
    const PlanBands bands = bands_of(two_legs(robot), robot);
    EXPECT_FALSE(bands.battery_power_W || bands.energy_J || bands.battery_fraction || bands.winding_C);
  }
}

/// More friction needs more current, which heats.
TEST(PlanBands, FrictionThatIsUncertainMakesTheTemperatureUncertain) {
  const Robot robot = doubtful({{"friction_torque_Nm", 0.1}});
  const Plan plan = two_legs(robot);
  const PlanBands bands = bands_of(plan, robot);
  ASSERT_TRUE(bands.winding_C);
  EXPECT_GT(bands.winding_C->sigma.back(), 0.05 * (bands.winding_C->value.back() - 25));
  EXPECT_EQ(bands.winding_C->time_s, times_of(plan)) << "whatever instants each robot's heat was summed at";
}

/// Only what is uncertain has a band: standby heats no winding.
TEST(PlanBands, NoneOfAQuantityThatIsCertain) {
  const Robot robot = doubtful({{"standby_W", 0.1}});
  const PlanBands bands = bands_of(two_legs(robot), robot);
  EXPECT_TRUE(bands.battery_power_W);
  EXPECT_FALSE(bands.winding_C);
}

}  // namespace
}  // namespace joulepath
