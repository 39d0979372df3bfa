#include "extensions/onboard/planned_pieces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "planner/path/geometry/path.hpp"
#include "scenarios/mission_files/plan_robot.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

constexpr double kStep_s = 0.05;

/// A trajectory as plans write it: headings from -pi to pi.
class Written {
 public:
  void rest(int samples) {
    for_each(samples, [](double) { return Twist<double>{}; });
  }
  void turn(double angle_rad, double duration_s) {
    const int samples = static_cast<int>(std::lround(duration_s / kStep_s));
    for_each(samples, [&](double u) { return Twist<double>{0, 2 * angle_rad / duration_s * bump(u)}; });
  }
  void straight(double way_m, double duration_s) {
    const int samples = static_cast<int>(std::lround(duration_s / kStep_s));
    for_each(samples, [&](double u) { return Twist<double>{2 * way_m / duration_s * bump(u), 0}; });
  }
  const std::string& text() const { return text_; }
  Pose pose{1.0, 2.0, 2.5};

 private:
  static double bump(double u) { return std::sin(std::numbers::pi * u) * std::sin(std::numbers::pi * u); }

  template <class Motion>
  void for_each(int samples, Motion&& motion) {
    for (int k = 0; k <= samples; ++k) {
      const Twist<double> now = motion(static_cast<double>(k) / samples);
      if (k == 0 && time_s_ > 0) continue;
      const Twist<double> before = motion((k - 0.5) / samples);
      if (k > 0) {
        time_s_ += kStep_s;
        pose.heading_rad += kStep_s * before.yaw_rate_rad_s;
        pose.x_m += kStep_s * before.speed_m_s * std::cos(pose.heading_rad);
        pose.y_m += kStep_s * before.speed_m_s * std::sin(pose.heading_rad);
        arc_m_ += kStep_s * std::abs(before.speed_m_s);
      }
      char line[256];
      std::snprintf(line, sizeof line, "%.4f,%.9f,%.9f,%.9f,%.9f,%.9f,5,%.9f,0,0\n", time_s_, now.speed_m_s,
                    now.yaw_rate_rad_s, pose.x_m, pose.y_m, wrapped_angle_rad(pose.heading_rad), arc_m_);
      text_ += line;
    }
  }

  double time_s_{}, arc_m_{};
  std::string text_{
      "time_s,linear_speed_m_s,angular_speed_rad_s,position_x_m,position_y_m,heading_rad,payload_kg,arc_"
      "length_m,"
      "curvature_per_m,leg\n"};
};

TEST(PlannedDrives, AreThePiecesBetweenStops) {
  Written written;
  const Pose start = written.pose;
  written.turn(2.0, 3);  // through pi
  written.straight(2, 5);
  written.rest(20);
  written.turn(-3.5, 5);
  written.straight(-1, 4);
  const ScratchDirectory directory;
  const std::string file = directory.write("trajectory.csv", written.text());
  const PlannedDrives plan =
      read_planned_drives(std::filesystem::path(file).parent_path().string(),
                          read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml"));
  ASSERT_EQ(plan.drives.size(), 4u);
  Pose pose = start;
  const double lengths[] = {2.0, 2.0, 3.5, 1.0}, begins_s[] = {0, 3, 9, 14};
  for (std::size_t k = 0; k < 4; ++k) {
    const PathPiece& piece = plan.drives[k].request.piece;
    EXPECT_EQ(is_turn(piece), k % 2 == 0);
    EXPECT_NEAR(piece_length(piece), lengths[k], 2e-3) << k;
    EXPECT_NEAR(plan.drives[k].start_s, begins_s[k], kStep_s + 1e-9) << k;
    const Pose begin = piece_point(piece, 0).pose;
    EXPECT_NEAR(std::hypot(begin.x_m - pose.x_m, begin.y_m - pose.y_m), 0, 2e-3) << k;
    pose = piece_point(piece, piece_length(piece)).pose;
  }
  EXPECT_NEAR(wrapped_angle_rad(pose.heading_rad - written.pose.heading_rad), 0, 2e-3);
  EXPECT_NEAR(pose.x_m, written.pose.x_m, 3e-3);
  EXPECT_NEAR(pose.y_m, written.pose.y_m, 3e-3);
}

TEST(PlannedDrives, OfAnotherRobotAreRefused) {
  Written written;
  written.straight(2, 5);
  const ScratchDirectory directory;
  const std::string folder =
      std::filesystem::path(directory.write("trajectory.csv", written.text())).parent_path().string();
  const std::string robots = JOULEPATH_SOURCE_DIR "/scenarios/robots/";
  const Robot robot = read_robot(robots + "nomad_super_scout.yaml");
  const PlanRobot said = plan_robot(robot);
  (void)directory.write("plan.json", R"({"schema": "joulepath/plan/1", "robot": {"name": ")" + said.name +
                                         R"(", "fingerprint": ")" + said.fingerprint + R"("}})");
  EXPECT_EQ(read_planned_drives(folder, robot).drives.size(), 1u);
  Robot renamed = robot;
  renamed.name = "number 7";
  renamed.uncertainty["payload_kg"] = 0.5;
  EXPECT_EQ(read_planned_drives(folder, renamed).drives.size(), 1u) << "the same robot";
  Robot changed = robot;
  changed.geometry.wheel_radius_m.left *= 1.001;
  EXPECT_THROW((void)read_planned_drives(folder, changed), ConfigError);
  EXPECT_THROW((void)read_planned_drives(folder, read_robot(robots + "amr_150kg.yaml")), ConfigError);
  (void)directory.write("plan.json", R"({"schema": "joulepath/plan/1"})");
  EXPECT_EQ(read_planned_drives(folder, changed).drives.size(), 1u) << "written without its robot";
}

}  // namespace
}  // namespace joulepath
