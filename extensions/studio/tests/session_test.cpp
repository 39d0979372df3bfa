#include "extensions/studio/answer/session.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "extensions/studio/answer/grid_json.hpp"
#include "extensions/studio/answer/moved_path.hpp"
#include "extensions/studio/answer/path_json.hpp"
#include "model/limit_table.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/json_value.hpp"
#include "tests/support/locations.hpp"

namespace joulepath::studio {
namespace {

using nlohmann::json;

json values_in(const std::string& file) {
  return json::parse(json_of(Document::load(file).root().value()).dump());
}
json nomad() {
  return values_in(std::string(JOULEPATH_SOURCE_DIR) + "/scenarios/robots/nomad_super_scout.yaml");
}

json curve_question(const std::string& mode) {
  return {
      {"mode", mode},
      {"robot", nomad()},
      {"mission",
       {{"robot", "robot.yaml"},
        {"legs",
         {{{"path", {{"bezier_m", {{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}}}, {"payload_kg", 5.7}}}}}}};
}
json answer_to(const json& question, const MissionWorld& floor = {}) {
  return json::parse(Session(floor, ".").answer(question.dump()));
}

/// An empty room of 12 m x 8 m with a pillar.
MissionWorld room() {
  OccupancyGrid grid{.width = 240,
                     .height = 160,
                     .resolution_m = 0.05,
                     .origin = {},
                     .occupancy_percent = {},
                     .file = "room"};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const bool wall = row < 2 || column < 2 || row > 157 || column > 237;
      const bool pillar = row > 60 && row < 100 && column > 100 && column < 120;
      grid.occupancy_percent.push_back(wall || pillar ? 100 : 0);
    }
  return {.map = grid};
}
json room_question(const std::string& mode) {
  return {{"mode", mode},
          {"robot", nomad()},
          {"mission",
           {{"robot", "robot.yaml"},
            {"map", "room.yaml"},
            {"clearance_m", 0.05},
            {"stations",
             {{"a", {{"x_m", 1}, {"y_m", 1}, {"heading_rad", 0}}},
              {"b", {{"x_m", 10.5}, {"y_m", 6.5}}},
              {"c", {{"x_m", 1.5}, {"y_m", 6.5}, {"heading_rad", 3}}}}},
            {"start", {{"station", "a"}}},
            {"legs", {{{"to", "b"}, {"payload_kg", 0}}, {{"to", "c"}, {"payload_kg", 8}, {"dwell_s", 5}}}}}}};
}
/// The room's plan: its search takes longer than all else here.
const json& room_plan() {
  static const json plan = answer_to(room_question("plan"), room());
  return plan;
}
json paths_of(const json& answer) {
  json paths = json::array();
  for (const json& leg : answer.at("legs")) paths.push_back(leg.at("path"));
  return paths;
}

TEST(Session, GivesThePlanOfTheCommand) {
  const json answer = answer_to(curve_question("plan"));
  MissionRequest mission{.name = "mission"};
  mission.legs.push_back(
      {.path = PathRequest{{BezierPoints{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}}, .payload = {5.7, 5.7}});
  const MissionWorld world{
      .robot = read_robot(std::string(JOULEPATH_SOURCE_DIR) + "/scenarios/robots/nomad_super_scout.yaml")};
  const Plan plan = plan_mission(mission, world, {.solver = SolverChoice::fast, .baselines = false});
  EXPECT_DOUBLE_EQ(answer.at("plan").at("energy_J").get<double>(), plan.energy.total_J());
  EXPECT_EQ(answer.at("plan").at("status"), "optimal");
}

TEST(Session, DraftsAreCloseToThePlanAndHaveNoBound) {
  const json plan = answer_to(curve_question("plan")).at("plan"),
             draft = answer_to(curve_question("draft")).at("plan");
  EXPECT_EQ(draft.at("status"), "feasible");
  EXPECT_TRUE(draft.at("lower_bound_J").is_null());
  EXPECT_NEAR(draft.at("energy_J").get<double>(), plan.at("energy_J").get<double>(),
              5e-3 * plan.at("energy_J").get<double>());
}

TEST(Session, MotionEndsWithThePlansEnergyAndNamesLimitsThatBind) {
  const json answer = answer_to(curve_question("plan")), &motion = answer.at("motion");
  EXPECT_NEAR(motion.at("energy_J").back().get<double>(), answer.at("plan").at("energy_J").get<double>(),
              1e-6);
  bool binds = false;
  for (std::size_t row = 0; row < motion.at("limit").size(); ++row) {
    EXPECT_LE(motion.at("limit_use")[row].get<double>(), 1 + 2e-6);
    const int limit = motion.at("limit")[row].get<int>();
    EXPECT_EQ(limit >= 0, motion.at("limit_use")[row].get<double>() >= 0.995);
    if (limit < 0) continue;
    binds = true;
    EXPECT_NE(limit_named(answer.at("limits")[static_cast<std::size_t>(limit)].get<std::string>()), nullptr);
  }
  EXPECT_TRUE(binds);
}

/// The interval at the plan's end is that of the plan's energy; a robot without uncertainty has none.
TEST(Session, IntervalsEndWithThatOfThePlansEnergy) {
  json question = curve_question("bands");
  const json paths = paths_of(answer_to(curve_question("plan")));
  question["paths"] = paths;
  const json answer = answer_to(question), &energy = answer.at("bands").at("energy_J"),
             &power = answer.at("bands").at("battery_power_W");
  const json& interval = answer.at("plan").at("energy_interval_95_J");
  EXPECT_NEAR(energy.at("low").back().get<double>(), interval[0].get<double>(), 1e-6);
  EXPECT_NEAR(energy.at("high").back().get<double>(), interval[1].get<double>(), 1e-6);
  EXPECT_LT(energy.at("low").back().get<double>(), 0.99 * energy.at("high").back().get<double>());
  for (const json& band : {energy, power}) {
    ASSERT_EQ(band.at("time_s").size(), band.at("low").size());
    for (std::size_t row = 0; row < band.at("low").size(); ++row)
      EXPECT_LE(band.at("low")[row].get<double>(), band.at("high")[row].get<double>());
  }
  question["robot"].erase("uncertainty"), question["robot"].erase("uncertainty_correlations");
  EXPECT_EQ(answer_to(question).at("bands"), json::object());
  EXPECT_FALSE(answer_to(curve_question("plan")).contains("bands"));
}

TEST(Session, CausesOfAClassicProfileAddUpToItsEnergy) {
  json question = room_question("classics");
  question["paths"] = paths_of(room_plan());
  const json answer = answer_to(question, room());
  std::size_t driven = 0;
  for (const json& classic : answer.at("classics")) {
    if (!classic.at("feasible").get<bool>()) continue;
    ++driven;
    double sum_J = 0;
    for (const auto& [name, joules] : classic.at("energy_by_cause_J").items())
      if (joules.is_number()) sum_J += joules.get<double>();
    EXPECT_NEAR(sum_J, classic.at("energy_J").get<double>(), 1e-6 * sum_J) << classic.at("name");
  }
  EXPECT_GE(driven, 4u);
}

TEST(Session, NothingBindsAndNothingIsDrawnDuringADwell) {
  const json &answer = room_plan(), &motion = answer.at("motion"), &leg = answer.at("plan").at("legs")[1];
  const double from_s = leg.at("start_s").get<double>() + leg.at("duration_s").get<double>();
  double first_s = -1;
  for (std::size_t row = 0; row < motion.at("time_s").size(); ++row) {
    const double time_s = motion.at("time_s")[row].get<double>();
    if (time_s <= from_s + 1e-9) continue;
    if (first_s < 0) first_s = time_s;
    EXPECT_EQ(motion.at("limit")[row], -1) << time_s;
    for (const char* key :
         {"linear_speed_m_s", "linear_acceleration_m_s2", "wheel_torque_left_Nm", "wheel_torque_right_Nm"})
      EXPECT_EQ(motion.at(key)[row].get<double>(), 0.0) << key << " at " << time_s;
  }
  EXPECT_NEAR(first_s, from_s, 1e-5) << "lines to the dwell's end would show a torque that is not there";
  EXPECT_NEAR(motion.at("time_s").back().get<double>(), from_s + 5, 1e-9);
}

TEST(Session, PathsThatWerePlannedGiveThePlanAgain) {
  const MissionWorld floor = room();
  const json& plan = room_plan();
  ASSERT_TRUE(plan.contains("legs")) << plan.dump();
  json question = room_question("paths");
  question["paths"] = paths_of(plan);
  const json again = answer_to(question, floor);
  EXPECT_NEAR(again.at("plan").at("energy_J").get<double>(), plan.at("plan").at("energy_J").get<double>(),
              1e-9 * plan.at("plan").at("energy_J").get<double>());
  EXPECT_TRUE(again.at("legs")[0].at("blocked").is_null());
}

TEST(Session, PathsFollowAStopThatMovesAndCollisionsAreShown) {
  const MissionWorld floor = room();
  json question = room_question("paths");
  question["paths"] = paths_of(room_plan());
  question["mission"]["stations"]["b"] = {{"x_m", 10.0}, {"y_m", 5.0}};
  const json moved = answer_to(question, floor), &m = moved.at("motion");
  std::size_t row = 0;
  while (m.at("leg")[row + 1] == 0) ++row;
  EXPECT_NEAR(m.at("position_x_m")[row].get<double>(), 10.0, 1e-3);
  EXPECT_NEAR(m.at("position_y_m")[row].get<double>(), 5.0, 1e-3);
  question["mission"]["stations"]["b"] = {{"x_m", 5.5}, {"y_m", 4.0}};  // inside of the pillar
  EXPECT_FALSE(answer_to(question, floor).at("legs")[0].at("blocked").is_null());
}

TEST(Session, FrontHasThePlanBetweenItsEnds) {
  json question = curve_question("front");
  question["points"] = 6;
  const json answer = answer_to(question), &front = answer.at("front");
  ASSERT_GE(front.size(), 2U);
  for (std::size_t k = 1; k < front.size(); ++k) {
    EXPECT_GT(front[k].at("duration_s"), front[k - 1].at("duration_s"));
    EXPECT_LT(front[k].at("energy_J"), front[k - 1].at("energy_J"));
  }
  EXPECT_NEAR(front.back().at("energy_J").get<double>(), answer.at("plan").at("energy_J").get<double>(),
              1e-3 * answer.at("plan").at("energy_J").get<double>());
}

TEST(Session, NoClassicProfileTakesLessInTheSameTime) {
  const json answer = answer_to(curve_question("classics"));
  EXPECT_GE(answer.at("classics").size(), 3U);
  for (const json& classic : answer.at("classics")) {
    if (!classic.at("feasible").get<bool>()) continue;
    const double optimum_J = classic.at("optimum_J").get<double>();
    EXPECT_GE(classic.at("energy_J").get<double>(), optimum_J * (1 - 1e-5)) << classic.at("name");
  }
}

TEST(Session, ReturnsErrorsInsteadOfThrowing) {
  json question = curve_question("plan");
  question["mission"]["legs"][0]["payload"] = 3;
  EXPECT_NE(answer_to(question).at("error").at("message").get<std::string>().find("payload_kg"),
            std::string::npos);
  question = curve_question("plan");
  question["robot"]["limits"]["speed_m_s"] = -1;
  EXPECT_FALSE(answer_to(question).at("error").at("key").get<std::string>().empty());
  question = room_question("draft");
  EXPECT_TRUE(answer_to(question, room()).contains("error"));  // a way was never searched
  for (const char* text : {"", "[]", "{}", "{\"mode\": 3}", "{\"mission\": [], \"robot\": 4}"})
    EXPECT_TRUE(json::parse(Session({}, ".").answer(text)).contains("error")) << text;
  question = room_question("paths");
  question["paths"] = {{{{"reverse", false}, {"segments", {{{"arc", {0, 0, 0, -1, 0, 0}}}}}}}, nullptr};
  EXPECT_TRUE(answer_to(question, room()).contains("error"));
}

TEST(PathJson, ReadsBackToTheLastBit) {
  const json& plan = room_plan();
  for (const json& leg : plan.at("legs")) EXPECT_EQ(path_json(path_from(leg.at("path"))), leg.at("path"));
}

TEST(GridJson, ReadsBackAsTheSameGrid) {
  MissionWorld world = room();
  world.keepout = world.map;
  world.keepout->occupancy_percent[7] = kUnknownCell;
  world.speed_mask = SpeedMask{*world.map, SpeedMask::Kind::absolute, 2.0, -0.02};
  const MissionWorld back = floor_from(floor_json(world));
  EXPECT_EQ(back.map->occupancy_percent, world.map->occupancy_percent);
  EXPECT_EQ(back.keepout->occupancy_percent, world.keepout->occupancy_percent);
  EXPECT_EQ(back.speed_mask->kind, SpeedMask::Kind::absolute);
  EXPECT_DOUBLE_EQ(back.speed_mask->multiplier, -0.02);
}

TEST(MovedPath, KeepsCurvatureContinuousAndMeetsBothHeadings) {
  const Path path = path_from(room_plan().at("legs")[1].at("path"));
  const Pose start{9.0, 5.0, 0.3};
  const auto moved = moved_path(path, {.pose = start}, {.x_m = 2.0, .y_m = 5.5, .heading_rad = -1.0});
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->start().x_m, 9.0, 1e-9);
  EXPECT_NEAR(wrapped_angle_rad(moved->start().heading_rad - 0.3), 0.0, 1e-9);
  EXPECT_NEAR(moved->end().x_m, 2.0, 1e-9);
  EXPECT_NEAR(moved->end().y_m, 5.5, 1e-9);
  EXPECT_NEAR(wrapped_angle_rad(moved->end().heading_rad + 1.0), 0.0, 1e-9);
}

}  // namespace
}  // namespace joulepath::studio
