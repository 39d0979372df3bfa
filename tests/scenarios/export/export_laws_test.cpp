// An export reads back as the plan, and each file keeps the laws of the robot by itself: what a reader of one
// file can check against physics, with a robot whose sides differ in every constant.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "planner/path/geometry/path.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/mission_files/path_file.hpp"
#include "tests/scenarios/export/lopsided_plan.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath::testing {
namespace {

using Json = nlohmann::json;

double stamp_s(const Json& item) {
  const Json& stamp = item["header"]["stamp"];
  return stamp["sec"].get<double>() + 1e-9 * stamp["nanosec"].get<double>();
}

void expect_planned_pose(const Json& pose, std::size_t k) {
  const double heading_rad =
      2 * std::atan2(pose["orientation"]["z"].get<double>(), pose["orientation"]["w"].get<double>());
  ASSERT_NEAR(pose["position"]["x"].get<double>(), lopsided_rows().position_x_m[k], 1e-9) << "row " << k;
  ASSERT_NEAR(pose["position"]["y"].get<double>(), lopsided_rows().position_y_m[k], 1e-9) << "row " << k;
  ASSERT_NEAR(wrapped_angle_rad(heading_rad - lopsided_rows().heading_rad[k]), 0, 1e-9) << "row " << k;
}

TEST(ExportLaws, APathHasThePlansPoses) {
  const Json path = Json::parse(export_nav2_path(lopsided_plan().input("p.json")).files.at(0).content);
  ASSERT_GT(path["poses"].size(), 200u);
  for (const Json& pose : path["poses"]) {
    const auto& times_s = lopsided_rows().time_s;
    const auto at = std::lower_bound(times_s.begin(), times_s.end(), stamp_s(pose) - 1e-6);
    ASSERT_NE(at, times_s.end());
    expect_planned_pose(pose["pose"], static_cast<std::size_t>(at - times_s.begin()));
  }
}

/// Other programs' paths have the same form, so one of ours is read as any of them.
TEST(ExportLaws, APathIsReadBackWithItsLengthTurnsAndEnds) {
  const ScratchDirectory scratch;
  const PlannedCurves& plan = lopsided_plan();
  for (const Export& written :
       {export_nav2_path(plan.input("p.json")), export_trajectory(plan.input("t.json"))}) {
    const std::string file = scratch.write("p.json", written.files.at(0).content);
    const Path path = path_from(Document::load(file));
    EXPECT_NEAR(path.distance_m(), plan.plan.distance_m, 1e-3 * plan.plan.distance_m);
    EXPECT_NEAR(path.start().heading_rad, lopsided_rows().heading_rad.front(), 1e-6);
    EXPECT_NEAR(wrapped_angle_rad(path.end().heading_rad - lopsided_rows().heading_rad.back()), 0, 1e-6);
    EXPECT_NEAR(path.end().x_m, lopsided_rows().position_x_m.back(), 1e-6);
    EXPECT_EQ(read_any_file(file).kind, "path");
    EXPECT_EQ(read_waypoints(file).distance_m(), path.distance_m());
  }
}

/// Speeds move the poses, accelerations the speeds, and efforts do the work of the wheels.
TEST(ExportLaws, ATrajectoryKeepsKinematicsAndWork) {
  const Json points =
      Json::parse(export_trajectory(lopsided_plan().input("t.json")).files.at(0).content)["points"];
  ASSERT_EQ(points.size(), lopsided_rows().size());
  const auto at = [&](std::size_t k, const char* kind, const char* part, const char* axis) {
    return points[k][kind][part][axis].get<double>();
  };
  double turned_rad_s = 0, moved_m = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    expect_planned_pose(points[k]["pose"], k);
    ASSERT_NEAR(stamp_s(points[k]), lopsided_rows().time_s[k], 1e-8);
    double work_W = 0;
    for (const Side side : kSides)
      work_W += lopsided_rows().wheel_torque_Nm[side][k] * lopsided_rows().wheel_speed_rad_s[side][k];
    const double v = at(k, "velocity", "linear", "x"), w = at(k, "velocity", "angular", "z");
    ASSERT_NEAR(at(k, "effort", "force", "x") * v + at(k, "effort", "torque", "z") * w, work_W, 1e-6)
        << "row " << k;
    if (k == 0) continue;
    const double dt = stamp_s(points[k]) - stamp_s(points[k - 1]);
    const auto mean = [&](const char* kind, const char* part, const char* axis) {
      return 0.5 * (at(k, kind, part, axis) + at(k - 1, kind, part, axis));
    };
    const double dx = lopsided_rows().position_x_m[k] - lopsided_rows().position_x_m[k - 1];
    const double dy = lopsided_rows().position_y_m[k] - lopsided_rows().position_y_m[k - 1];
    const double heading = 0.5 * (lopsided_rows().heading_rad[k] + lopsided_rows().heading_rad[k - 1]);
    ASSERT_NEAR(dx * std::cos(heading) + dy * std::sin(heading), mean("velocity", "linear", "x") * dt, 2e-4)
        << "row " << k;
    moved_m += mean("velocity", "linear", "x") * dt;
    turned_rad_s +=
        std::abs(w - at(k - 1, "velocity", "angular", "z") - mean("acceleration", "angular", "z") * dt);
    ASSERT_NEAR(v - at(k - 1, "velocity", "linear", "x"), mean("acceleration", "linear", "x") * dt, 0.5 * dt)
        << "row " << k;
  }
  EXPECT_NEAR(moved_m, lopsided_plan().plan.distance_m, 1e-3);
  EXPECT_LT(turned_rad_s,
            0.5);  // jumps of the yaw acceleration at the ends of pieces; its sign turned: above 8
}

/// Columns of a CSV text by name.
std::map<std::string, std::vector<double>> plotted_columns(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line, cell;
  std::getline(lines, line);
  std::vector<std::string> names;
  for (std::istringstream header(line); std::getline(header, cell, ',');) names.push_back(cell);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    for (const std::string& name : names) {
      std::getline(row, cell, ',');
      columns[name].push_back(std::stod(cell));
    }
  }
  return columns;
}

/// Of each side: U = R i + Kv n w, P = U i, T = Kt n i, and r w = v -+ l yaw rate [P1, Eqs. (2), (14)-(16)].
TEST(ExportLaws, SignalsOfAPlotKeepTheEquationsOfEachMotor) {
  auto of = plotted_columns(export_plotjuggler(lopsided_plan().input("j.csv")).files.at(0).content);
  const Robot& robot = lopsided_plan().world.robot;
  const Geometry& body = robot.geometry;
  ASSERT_EQ(of["time_s"].size(), lopsided_rows().size());
  double energy_J = 0;
  for (std::size_t k = 0; k < of["time_s"].size(); ++k) {
    const double v = of["motion/speed_m_s"][k], w = of["motion/yaw_rate_rad_s"][k];
    for (const Side side : kSides) {
      const std::string name = side == Side::left ? "left/" : "right/";
      const double sign = side == Side::left ? -1 : 1;
      const Motor& motor = robot.motor[side];
      const double volts = of[name + "motor_voltage_V"][k], amperes = of[name + "motor_current_A"][k];
      const double wheel_rad_s = of[name + "wheel_speed_rad_s"][k];
      ASSERT_NEAR(volts, motor.resistance_ohm * amperes + motor.volts_per_speed_V_s_rad() * wheel_rad_s, 1e-6)
          << name << k;
      ASSERT_NEAR(of[name + "motor_power_W"][k], volts * amperes, 1e-6) << name << k;
      ASSERT_NEAR(wheel_rad_s * body.wheel_radius_m[side], v + sign * body.half_track_m * w, 1e-6)
          << name << k;
      ASSERT_NEAR(of[name + "wheel_torque_Nm"][k], motor.torque_per_ampere_Nm_A() * amperes, 1e-6)
          << name << k;
    }
    ASSERT_NEAR(of["motion/curvature_per_m"][k] * v, std::abs(v) > 1e-6 ? w : 0.0, 1e-6) << k;
    if (k > 0)
      energy_J += 0.5 * (of["battery/power_W"][k] + of["battery/power_W"][k - 1]) *
                  (of["time_s"][k] - of["time_s"][k - 1]);
  }
  EXPECT_NEAR(energy_J, of["battery/energy_J"].back(), 2e-3 * energy_J);
  EXPECT_NEAR(of["battery/energy_J"].back(), lopsided_plan().plan.energy.total_J(), 1e-6 * energy_J);
  EXPECT_EQ(of["mission/payload_kg"].front(), 0);
  EXPECT_EQ(of["mission/payload_kg"].back(), 6);
  EXPECT_EQ(of["mission/leg"].back(), 1);
}

/// What all exports have from one function keeps the laws of motion itself: a plan's rows are not only alike.
TEST(ExportLaws, RowsOfAPlanMoveAsTheirSpeedsSay) {
  const Trajectory& rows = lopsided_rows();
  double heading_rad = rows.heading_rad[0];
  for (std::size_t k = 1; k < rows.size(); ++k) {
    const double dt = rows.time_s[k] - rows.time_s[k - 1];
    heading_rad += 0.5 * (rows.angular_speed_rad_s[k] + rows.angular_speed_rad_s[k - 1]) * dt;
    ASSERT_NEAR(wrapped_angle_rad(heading_rad - rows.heading_rad[k]), 0, 5e-3) << k;
    ASSERT_GE(rows.arc_length_m[k] - rows.arc_length_m[k - 1], rows.leg[k] == rows.leg[k - 1] ? -1e-9 : -10)
        << k;
  }
  EXPECT_NEAR(rows.position_x_m.back(), 4, 1e-6);
  EXPECT_NEAR(rows.position_y_m.back(), 0, 1e-6);
}

}  // namespace
}  // namespace joulepath::testing
