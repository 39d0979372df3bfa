#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "extensions/nav2/exports.hpp"
#include "extensions/nav2/leg_settings.hpp"
#include "extensions/nav2/speed_grid.hpp"
#include "extensions/vda5050/order_json.hpp"
#include "extensions/vda5050/order_mission.hpp"
#include "planner/accounts/edge_energy.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/controller/planned_speed.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/mission_files/map_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

/// A planned mission with all inputs of an export.
struct Planned {
  MissionRequest mission{};
  MissionWorld world{};
  Plan plan{};
  Plant plant{};

  explicit Planned(MissionRequest request) : mission(std::move(request)) {
    mission.robot_file = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";
    world = read_world(mission);
    plan = plan_mission(mission, world, {.solver = SolverChoice::fast, .nodes = 60, .accuracy = 1e-3});
    plant = make_plant(world.robot);
  }
  ExportInput input(const std::string& file) const { return {mission, world, plan, plant, file, {}}; }
};

/// The paper's curve, a turn and a straight; a dwell between them, and more time than the robot needs.
const Planned& curves() {
  static const Planned planned = [] {
    LegRequest curve{.path = PathRequest{.bezier_m = {{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}},
                     .payload = {5.7, 5.7},
                     .dwell_s = 5};
    LegRequest back{.path = PathRequest{.bezier_m = {{{{0, 0}, {-1, 0}, {-3, 0}, {-4, 0}}}}},
                    .payload = {1, 1}};
    return Planned({.name = "curves", .legs = {curve, back}, .objective = {.deadline_s = 40}});
  }();
  return planned;
}

const Planned& order() {
  static const Planned planned = [] {
    MissionRequest mission{.name = "order",
                           .order_file = JOULEPATH_SOURCE_DIR "/scenarios/orders/warehouse_v2.json"};
    follow_order(mission);
    return Planned(mission);
  }();
  return planned;
}

double relative(double a, double b) { return std::abs(a - b) / std::abs(b); }

TEST(Export, RowsOfEdgesAddUpToThePlan) {
  for (const Planned* planned : {&curves(), &order()}) {
    double energy_J = 0, duration_s = 0, distance_m = 0;
    for (const EdgeEnergy& edge : edge_energies(planned->plan, planned->plant)) {
      EXPECT_NEAR(edge.start_s, duration_s, 1e-9);
      energy_J += edge.energy.total_J();
      duration_s += edge.duration_s;
      distance_m += edge.distance_m;
    }
    EXPECT_LT(relative(energy_J, planned->plan.energy.total_J()), 1e-7);
    EXPECT_LT(relative(duration_s, planned->plan.duration_s), 1e-9);
    EXPECT_LT(relative(distance_m, planned->plan.distance_m), 1e-9);
  }
  const Json table = Json::parse(export_edges(order().input("edges.json")).files.at(0).content);
  EXPECT_EQ(table["edges"][0]["edge"], "dock_n13");
  const std::string csv = export_edges(order().input("edges.csv")).files.at(0).content;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<long>(table["edges"].size()) + 1);
}

TEST(Export, LastRowOfTheTrajectoryIsThePlansEnergy) {
  for (const Planned* planned : {&curves(), &order()}) {
    const Trajectory motion = plan_trajectory(planned->plan, planned->plant);
    EXPECT_LT(relative(motion.energy_J.back(), planned->plan.energy.total_J()), 1e-7);
  }
}

TEST(Export, RosMessagesEndWithThePlan) {
  const Plan& plan = curves().plan;
  const Json trajectory = Json::parse(export_trajectory(curves().input("t.json")).files.at(0).content);
  const Json path = Json::parse(export_nav2_path(curves().input("p.json")).files.at(0).content);
  const auto time_of = [](const Json& item) {
    const Json& stamp = item["header"]["stamp"];
    return stamp["sec"].get<double>() + 1e-9 * stamp["nanosec"].get<double>();
  };
  EXPECT_NEAR(time_of(trajectory["points"].back()), plan.duration_s, 1e-8);
  EXPECT_NEAR(time_of(path["poses"].back()), plan.duration_s, 1e-8);
  double distance_m = 0;
  const Json& points = trajectory["points"];
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const auto speed = [&](std::size_t i) { return points[i]["velocity"]["linear"]["x"].get<double>(); };
    distance_m += 0.5 * (speed(k) + speed(k + 1)) * (time_of(points[k + 1]) - time_of(points[k]));
    const Json& q = points[k]["pose"]["orientation"];
    EXPECT_NEAR(std::hypot(q["z"].get<double>(), q["w"].get<double>()), 1, 1e-12);
  }
  EXPECT_NEAR(distance_m, plan.distance_m, 0.01 * plan.distance_m);
}

TEST(Export, PlotJugglerHasOneColumnPerName) {
  const std::string csv = export_plotjuggler(curves().input("j.csv")).files.at(0).content;
  const auto line = [&](std::size_t from) { return csv.substr(from, csv.find('\n', from) - from); };
  const std::string header = line(0), row = line(header.size() + 1);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_EQ(header.find("time_s"), 0u);
}

TEST(Export, ControllerKeepsItsLimitsAndThePlansTime) {
  const Planned& planned = curves();
  const std::vector<LegSettings> settings = leg_settings(planned.plan);
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_TRUE(settings[1].turn);
  for (const LegSettings& leg : settings) {
    EXPECT_LE(leg.drive->rate, 1.0);
    EXPECT_LE(leg.drive->acceleration, 0.5);
    EXPECT_LE(leg.drive->deceleration, 0.5);
  }
  const ControlledDrive drive = drive_with(planned.plan, settings);
  EXPECT_EQ(drive.broken_limit, "");
  EXPECT_LE(drive.duration_s, planned.plan.duration_s * (1 + 1e-6));
  EXPECT_GT(drive.duration_s, 0.97 * planned.plan.duration_s);
  const ControllerLoss loss = loss_of(planned.plan, drive);
  ASSERT_TRUE(loss.plan_time);
  EXPECT_GT(loss.plan_time->lost_J(), 0);
  EXPECT_GT(loss.own_time.lost_J(), -1e-4 * loss.own_time.optimum_J);
  // Tuned for this time they lose less than a drive at the robot's limits that waits afterwards.
  const ControllerLoss fastest = loss_of(planned.plan, drive_by_controller(planned.plan, fastest_settings));
  EXPECT_LT(loss.plan_time->lost_J(), fastest.plan_time->lost_J());
}

TEST(Export, OrderOfAPlanReadsBackAsItsWay) {
  const ScratchDirectory scratch;
  const Export written = export_vda5050(curves().input(scratch.at("order.json")));
  MissionRequest back{.order_file = scratch.write("order.json", written.files.at(0).content)};
  follow_order(back);
  ASSERT_EQ(back.legs.size(), 2u);
  EXPECT_EQ(back.legs[0].dwell_s, 5);
  double distance_m = 0;
  for (const LegRequest& leg : back.legs) distance_m += leg.path->ready->distance_m();
  EXPECT_NEAR(distance_m, curves().plan.distance_m, 1e-3);
  const PathPiece& planned = curves().plan.legs[0].stretches[0].request.piece;
  ASSERT_EQ(back.legs[0].path->ready->pieces.size(), 1u);
  const PathPiece& read = back.legs[0].path->ready->pieces[0];
  for (int i = 0; i <= 100; ++i) {
    const Pose a = piece_point(planned, piece_length(planned) * i / 100).pose;
    const Pose b = piece_point(read, piece_length(read) * i / 100).pose;
    EXPECT_LT(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), 2e-3);
  }
  EXPECT_TRUE(written.loss->plan_time);
  EXPECT_GT(written.loss->own_time.lost_J(), 0);
}

TEST(Export, OrderKeepsWhatItSaidAndItsSpeedsAreNeverRaised) {
  const Json asked = Json::parse(read_text_file(order().mission.order_file));
  const Export written = export_vda5050(order().input("o.json"));
  const Json slower = Json::parse(written.files.at(0).content);
  EXPECT_EQ(slower["nodes"], asked["nodes"]);
  for (std::size_t k = 0; k < asked["edges"].size(); ++k) {
    const double cap = slower["edges"][k]["maxSpeed"].get<double>();
    EXPECT_GT(cap, 0);
    EXPECT_LE(cap, asked["edges"][k].value("maxSpeed", 1.0));
  }
  EXPECT_EQ(written.files.at(1).name, "o.loss.json");
}

/// Highest planned speed in each cell that the path crosses, sampled independently.
/// But for the rounding to the next of 100 values.
TEST(Export, SpeedMaskAllowsNoMoreThanThePlanDrives) {
  const ScratchDirectory scratch;
  const Planned& planned = curves();
  const Export written = export_speed_mask(planned.input(scratch.at("mask.yaml")));
  for (const ExportFile& file : written.files)
    scratch.write(std::filesystem::path(file.name).filename().string(), file.content);
  const OccupancyGrid grid = read_map(scratch.at("mask.yaml"));
  const std::string& yaml = written.files.at(0).content;
  const double multiplier = std::stod(yaml.substr(yaml.find("multiplier: ") + 12));
  const SpeedMask mask{grid, SpeedMask::Kind::absolute, 0.0, multiplier};
  struct Crossing {
    double highest_m_s{}, length_m{};
  };
  std::map<std::pair<int, int>, Crossing> crossings;
  const Trajectory motion = plan_trajectory(planned.plan, planned.plant, 500);
  for (std::size_t k = 1; k < motion.size(); ++k) {
    const auto cell = grid.cell_of(motion.position_x_m[k], motion.position_y_m[k]);
    Crossing& crossing = crossings[{cell.column, cell.row}];
    crossing.highest_m_s = std::max(crossing.highest_m_s, std::abs(motion.linear_speed_m_s[k]));
    crossing.length_m += motion.arc_length_m[k] > motion.arc_length_m[k - 1]
                             ? motion.arc_length_m[k] - motion.arc_length_m[k - 1]
                             : 0.0;
  }
  int checked = 0;
  for (const auto& [cell, crossing] : crossings) {
    if (crossing.length_m < 0.1 * grid.resolution_m) continue;  // only clipped
    ++checked;
    const auto [x_m, y_m] = grid.center_of({cell.first, cell.second});
    const auto cap = mask.speed_cap_m_s(x_m, y_m, 1.0);
    ASSERT_TRUE(cap);
    EXPECT_GT(*cap, 0);
    EXPECT_LE(*cap, crossing.highest_m_s + 2e-3 + multiplier);
  }
  EXPECT_GT(checked, 60);
  EXPECT_GT(written.loss->own_time.lost_J(), 0);
}

TEST(Export, ResultsFollowTheirSchemas) {
  const ScratchDirectory scratch;
  for (const auto& [name, written] :
       {std::pair{"controller.json", export_controller(curves().input("c.json"))},
        {"edges.json", export_edges(order().input("e.json"))}})
    EXPECT_NO_THROW(static_cast<void>(read_any_file(scratch.write(name, written.files.at(0).content))))
        << name;
  const Export mask = export_speed_mask(curves().input("m.yaml"));
  EXPECT_EQ(read_any_file(scratch.write("m.loss.json", mask.files.at(2).content)).kind, "loss");
}

TEST(Export, CapsAtThePlansSpeedsLoseLessThanNone) {
  const Planned& planned = curves();
  const ControlledDrive free = drive_by_controller(planned.plan, fastest_settings);
  const Export capped = export_vda5050(planned.input("x.json"));
  ASSERT_TRUE(capped.loss->plan_time);
  EXPECT_LT(capped.loss->plan_time->lost_J(), loss_of(planned.plan, free).plan_time->lost_J());
}

}  // namespace
}  // namespace joulepath
