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
#include "scenarios/any_file.hpp"
#include "scenarios/mission_files/map_file.hpp"
#include "tests/scenarios/export/continuous_plans.hpp"
#include "tests/scenarios/export/planned_curves.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath::testing {
namespace {

using Json = nlohmann::json;

const Planned& order() {
  static const Planned planned = [] {
    MissionRequest mission{.name = "order",
                           .order_file = JOULEPATH_SOURCE_DIR "/scenarios/orders/warehouse_v2.json"};
    follow_order(mission);
    return Planned(mission);
  }();
  return planned;
}

TEST(Export, EdgesOfAnOrderHaveItsNamesAndAddUp) {
  const Json table = Json::parse(export_edges(order().input("edges.json")).files.at(0).content);
  EXPECT_EQ(table["edges"][0]["edge"], "dock_n13");
  double energy_J = 0;
  for (const Json& edge : table["edges"]) energy_J += edge["energy_J"].get<double>();
  EXPECT_NEAR(energy_J, order().plan.energy.total_J(), 1e-7 * energy_J);
}

TEST(ContinuousPlan, AnOrderBeginsAndStopsWhereThePlanDoes) {
  const ScratchDirectory scratch;
  for (const PlannedMission& plan : continuous_plans()) {
    if (std::any_of(plan.plan.legs.begin(), plan.plan.legs.end(),
                    [](const LegPlan& leg) { return leg.prescribed.has_value(); }))
      continue;
    const std::string text = export_vda5050(plan.input(scratch.at("o.json"))).files[0].content;
    const auto driven = std::count_if(plan.plan.legs.begin(), plan.plan.legs.end(),
                                      [](const LegPlan& leg) { return leg.distance_m > 0; });
    if (driven > 0) {
      MissionRequest back{.order_file = scratch.write("o.json", text)};
      follow_order(back);
      EXPECT_GE(std::ssize(back.legs), driven) << plan.name << ": no stop is lost";
    }
    const Json order = Json::parse(text);
    const Json& place = order["nodes"][0]["nodePosition"];
    const Trajectory motion = plan_trajectory(plan.plan, plan.plant);
    EXPECT_NEAR(place["x"].get<double>(), motion.position_x_m[0], 1e-9) << plan.name;
    EXPECT_NEAR(place["theta"].get<double>(), wrapped_angle_rad(motion.heading_rad[0]), 1e-9) << plan.name;
  }
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
}  // namespace joulepath::testing
