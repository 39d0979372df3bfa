// Poses, times, energies and the battery's charge of a plan follow each other without a jump, in every
// export: the robot cannot be elsewhere at the next instant, whatever legs do not drive.
#include "model/watt_hours.hpp"
#include "planner/accounts/edge_energy.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "tests/scenarios/export/continuous_plans.hpp"

namespace joulepath::testing {
namespace {

using Json = nlohmann::json;

constexpr double kMostPower_W = 400;  // 8 A at 24 V on both sides

TEST(ContinuousPlan, RowsOfEveryExportFollowEachOtherAndTheStartIsTheMissions) {
  for (const PlannedMission& plan : continuous_plans()) {
    ASSERT_LE(plan.plan.status, SolveStatus::feasible) << plan.name << ": " << plan.plan.message;
    const ExportInput input = plan.input("x.json");
    const double duration_s = plan.plan.duration_s;
    const Trajectory motion = plan_trajectory(plan.plan, plan.plant);
    expect_continuous(rows_of(motion), duration_s, plan.name + ", trajectory.csv");
    expect_continuous(rows_of(plan_nodes(plan.plan, plan.plant).rows), duration_s,
                      plan.name + ", profile.csv");
    expect_continuous(rows_of(Json::parse(export_nav2_path(input).files[0].content)["poses"]), duration_s,
                      plan.name + ", nav2_path", true);
    expect_continuous(rows_of(Json::parse(export_trajectory(input).files[0].content)["points"]), duration_s,
                      plan.name + ", trajectory", true);
    const Pose& start = plan.mission.start.pose;
    EXPECT_NEAR(motion.position_x_m[0], start.x_m, 1e-9) << plan.name;
    EXPECT_NEAR(motion.position_y_m[0], start.y_m, 1e-9) << plan.name;
  }
}

TEST(ContinuousPlan, RowsOfEdgesBeginWhereTheOnesBeforeEnd) {
  for (const PlannedMission& plan : continuous_plans()) {
    const std::vector<EdgeEnergy> edges = edge_energies(plan.plan, plan.plant);
    ASSERT_FALSE(edges.empty());
    EXPECT_NEAR(edges[0].from.x_m, plan.mission.start.pose.x_m, 1e-9) << plan.name;
    double now_s = 0;
    for (std::size_t k = 0; k < edges.size(); ++k) {
      EXPECT_NEAR(edges[k].start_s, now_s, 1e-9) << plan.name << " row " << k;
      now_s += edges[k].duration_s;
      if (k == 0) continue;
      const Pose &end = edges[k - 1].to, &begin = edges[k].from;
      EXPECT_NEAR(begin.x_m, end.x_m, 1e-6) << plan.name << " row " << k;
      EXPECT_NEAR(begin.y_m, end.y_m, 1e-6) << plan.name << " row " << k;
      EXPECT_NEAR(wrapped_angle_rad(begin.heading_rad - end.heading_rad), 0, 1e-6)
          << plan.name << " row " << k;
    }
    EXPECT_NEAR(now_s, plan.plan.duration_s, 1e-9) << plan.name;
  }
}

/// A plan's rows begin with it and end with its energy, whatever its first leg is.
TEST(ContinuousPlan, RowsOfNodesHoldTheWholePlan) {
  for (const PlannedMission& plan : continuous_plans()) {
    const Trajectory nodes = plan_nodes(plan.plan, plan.plant).rows;
    ASSERT_FALSE(nodes.time_s.empty()) << plan.name;
    EXPECT_EQ(nodes.time_s.front(), 0.0) << plan.name;
    EXPECT_NEAR(nodes.time_s.back(), plan.plan.duration_s, 1e-9) << plan.name;
    EXPECT_EQ(nodes.energy_J.front(), 0.0) << plan.name;
    EXPECT_NEAR(nodes.energy_J.back(), plan.plan.energy.total_J(), 1e-6 * plan.plan.energy.total_J())
        << plan.name;
  }
}

TEST(ContinuousPlan, EnergyAndChargeFollowEachOther) {
  for (const PlannedMission& plan : continuous_plans()) {
    const Trajectory motion = plan_trajectory(plan.plan, plan.plant);
    for (std::size_t k = 1; k < motion.size(); ++k)
      ASSERT_LE(std::abs(motion.energy_J[k] - motion.energy_J[k - 1]),
                kMostPower_W * (motion.time_s[k] - motion.time_s[k - 1]) + 1e-6)
          << plan.name << " row " << k;
    ASSERT_TRUE(plan.plan.battery) << plan.name;
    const BatteryAccount& battery = *plan.plan.battery;
    double charge_J =
        (battery.start_fraction - battery.end_fraction) * plan.plant.robot.battery.capacity_Wh * kJoulesPerWh;
    EXPECT_NEAR(charge_J, plan.plan.energy.total_J() + battery.loss_J, 1e-6 * charge_J) << plan.name;
    EXPECT_EQ(battery.fraction_after_leg.back(), battery.end_fraction) << plan.name;
  }
}

}  // namespace
}  // namespace joulepath::testing
