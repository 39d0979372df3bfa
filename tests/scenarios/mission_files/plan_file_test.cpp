// plan.json says nothing about an uncertainty that the robot file does not state.
#include "scenarios/mission_files/plan_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "planner/mission/mission.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

Json plan_json(const Robot& robot) {
  const LegRequest leg{.path = PathRequest{.bezier_m = {{{{0, 0}, {1, 0}, {2, 0.5}, {2, 2}}}}}, .dwell_s = 2};
  const MissionRequest mission{
      .name = "curve",
      .legs = {leg, {.path = PathRequest{.bezier_m = {{{{0, 0}, {0, 1}, {0, 2}, {0, 3}}}}}}}};
  return Json::parse(plan_json_text(
      plan_mission(mission, {.robot = robot},
                   {.solver = SolverChoice::fast, .nodes = 30, .accuracy = 1e-3, .baselines = false})));
}

/// Whether all intervals are there and wider than nothing, or all are null.
void expect_intervals(const Json& plan, bool are_known) {
  std::vector<Json> intervals{plan.at("energy_interval_95_J"),
                              plan.at("legs").at(0).at("energy_interval_95_J"),
                              plan.at("legs").at(1).at("energy_interval_95_J")};
  if (plan.contains("battery")) intervals.push_back(plan.at("battery").at("interval_95"));
  for (const Json& interval : intervals) {
    ASSERT_EQ(interval.is_array(), are_known) << plan.dump(1);
    if (are_known) {
      EXPECT_GT(interval.at(1), interval.at(0));
    }
  }
  EXPECT_EQ(plan.at("energy_sigma_J").is_null(), !are_known);
  EXPECT_EQ(plan.at("uncertainty").get<std::string>().starts_with("unknown"), !are_known);
}

TEST(PlanFile, NoRobotHasAnIntervalThatItsFileDoesNotState) {
  int robots = 0, with_battery = 0;
  for (const auto& file : std::filesystem::directory_iterator(JOULEPATH_SOURCE_DIR "/scenarios/robots")) {
    Robot robot = read_robot(file.path().string());
    const Json plan = plan_json(robot);
    expect_intervals(plan, !robot.uncertainty.empty());
    with_battery += plan.contains("battery");
    robot.uncertainty = {{"chassis_mass_kg", 0.0}};
    expect_intervals(plan_json(robot), false);
    robot.uncertainty = {{"chassis_mass_kg", 0.02}};
    expect_intervals(plan_json(robot), true);
    ++robots;
  }
  EXPECT_GE(robots, 5);
  EXPECT_GE(with_battery, 3);
}

/// One threshold for readers and pages: far above the bound, with no corner that explains it.
TEST(PlanFile, SaysWhichLegsLieFarAboveTheirBound) {
  using Part = PathBound::Part;
  const auto says = [](double bound_J, Part part) {
    LegPlan leg{.to = "dock", .path_bound = PathBound{.energy_J = bound_J, .part = part}};
    leg.energy.copper_J = 100;
    return Json::parse(plan_json_text({.status = SolveStatus::optimal, .legs = {leg}}))
        .at("legs")
        .at(0)
        .at("far_above_path_bound")
        .get<bool>();
  };
  EXPECT_TRUE(says(80, Part::line));
  EXPECT_TRUE(says(80, Part::headings));
  EXPECT_FALSE(says(80, Part::corners));
  EXPECT_FALSE(says(90, Part::line));
  EXPECT_FALSE(Json::parse(plan_json_text({.status = SolveStatus::optimal, .legs = {LegPlan{}}}))
                   .at("legs")
                   .at(0)
                   .contains("far_above_path_bound"));
}

TEST(PlanFile, ACapacityWithoutUncertaintyIsTheExpectedEnergy) {
  Robot robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml");
  const Json known = plan_json(robot);
  robot.uncertainty.clear();
  const Json unknown = plan_json(robot);
  EXPECT_TRUE(known.at("uncertainty").get<std::string>().ends_with("of the model"));
  EXPECT_EQ(unknown.at("energy_J"), known.at("energy_J"));
  EXPECT_EQ(unknown.at("battery").at("end_fraction"), known.at("battery").at("end_fraction"));
  EXPECT_LT(unknown.at("battery").at("required_capacity_Wh"), known.at("battery").at("required_capacity_Wh"));
  EXPECT_NEAR(unknown.at("battery").at("required_capacity_Wh").get<double>() * 3600,
              unknown.at("energy_J").get<double>() + unknown.at("battery_loss_J").get<double>(), 1e-6);
}

/// Relative errors of the source paper's model on straight runs, percent [P1, Table 5].
constexpr std::array kErrorsOfThePaper{7.42,  5.29, 3.82, 7.89, 9.25, 3.13, 0.13, 3.69, 5.11, 8.46,
                                       5.99,  6.70, 0.69, 0.53, 2.85, 7.33, 7.20, 0.75, 0.20, 1.92,
                                       10.86, 8.10, 6.70, 5.33, 0.17, 8.80, 9.85, 6.52, 7.94, 5.04};

/// The paper's runs lie within intervals of the other runs' error, and hardly within those of the constants.
TEST(PlanFile, IntervalsOfTheNomadHoldTheMeasuredRuns) {
  Robot robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml");
  double squares = 0;
  for (double error : kErrorsOfThePaper) squares += error * error;
  const auto runs = static_cast<double>(kErrorsOfThePaper.size());
  EXPECT_NEAR(robot.model_energy_sigma().value(), std::sqrt(squares / runs) / 100, 5e-4);
  const auto half_width_percent = [&] {
    const Json plan = plan_json(robot);
    const double half_J =
        plan.at("energy_interval_95_J").at(1).get<double>() - plan.at("energy_J").get<double>();
    return 100 * half_J / plan.at("motion_energy_J").get<double>();
  };
  const auto held = [&](auto&& width_of) {
    return std::ranges::count_if(kErrorsOfThePaper, [&](double error) { return error < width_of(error); });
  };
  EXPECT_GE(held([&](double error) {
              robot.uncertainty["model_energy"] = std::sqrt((squares - error * error) / (runs - 1)) / 100;
              return half_width_percent();
            }),
            27);
  robot.uncertainty.erase("model_energy");
  const double of_constants = half_width_percent();
  EXPECT_LT(held([&](double) { return of_constants; }), 15);
}

}  // namespace
}  // namespace joulepath
