// Limits by place, by arc length and by payload, from their files to the plan between its nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/mission/mission.hpp"
#include "planner/motion/path_motion.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/mission_source.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

const std::string kRobot = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";
const std::string kHead = "robot: " + kRobot + "\nobjective: {minimize: time}\n";
/// 8 m along the x axis of the map.
const std::string kLegs = "legs: [{path: {bezier_m: [[[0, 0], [2.5, 0], [5.5, 0], [8, 0]]], frame: map}}]\n";

Plan planned(const MissionSource& source) {
  const MissionRequest mission = read_mission_source(source);
  return plan_mission(mission, read_world(mission),
                      {.solver = SolverChoice::fast, .nodes = 100, .baselines = false});
}

Plan planned(const ScratchDirectory& scratch, const std::string& text) {
  return planned({.file = scratch.write("mission.yaml", text)});
}

/// A dense look at the plan of one leg: place and speed.
template <class Look>
void at_every_place(const Plan& plan, Look&& look) {
  ASSERT_EQ(plan.status, SolveStatus::optimal) << plan.message;
  constexpr int kSamples = 20000;
  for (const StretchPlan& stretch : plan.legs.front().stretches)
    for (int k = 0; k <= kSamples; ++k) {
      const ProfileState state = stretch.profile.at_time(stretch.profile.duration_s() * k / kSamples);
      look(piece_point(stretch.request.piece, state.s).pose, state);
    }
}

/// Columns 10 to 15 of the mask (x from 2 to 3.2 m) have the value 60: 40 % of the limit of 1 m/s.
const std::string kMask = [] {
  std::string text = "P2\n50 10\n255\n";
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 50; ++column) text += column >= 10 && column < 16 ? "102 " : "255 ";
  return text;
}();

TEST(SpeedLimits, AMaskSlowsTheRobotWhereItIsAndNowhereElse) {
  const ScratchDirectory scratch;
  scratch.write("mask.pgm", kMask);
  scratch.write("mask.yaml",
                "image: mask.pgm\nresolution: 0.2\norigin: [0, -1, 0]\nnegate: 0\noccupied_thresh: 1.0\n"
                "free_thresh: 0.0\nmode: scale\n");
  const Plan free = planned(scratch, kHead + kLegs);
  const Plan masked = planned(scratch, kHead + kLegs + "speed_mask: {file: mask.yaml}\n");
  double top_inside = 0, top_before = 0, top_behind = 0;
  at_every_place(masked, [&](const Pose& pose, const ProfileState& state) {
    const double x = pose.x_m;
    double& top = x < 2 - 1e-9 ? top_before : x > 3.2 + 1e-9 ? top_behind : top_inside;
    top = std::max(top, state.rate);
  });
  EXPECT_LE(top_inside, 0.4 * (1 + 1e-6));
  EXPECT_GT(top_inside, 0.4 * (1 - 1e-3)) << "and it is used";
  EXPECT_NEAR(top_before, std::sqrt(0.4 * 0.4 + 2 * 0.5 * 0.82), 0.2) << "it is braked for";
  EXPECT_GT(top_before, 0.9);
  EXPECT_GT(top_behind, 0.99);
  // Down to 0.4 m/s and up again at 0.5 m/s^2, 1.2 m in between (a cell's half earlier, as masks are read).
  const double ramps_m = 2 * (1 - 0.16) / (2 * 0.5), ramps_s = 2 * 0.6 / 0.5;
  const double more_s = ramps_s - ramps_m + 1.2 / 0.4 - 1.2;
  EXPECT_NEAR(masked.duration_s - free.duration_s, more_s, 0.2 * (1 / 0.4 - 1));
  EXPECT_GT(masked.duration_s - free.duration_s, more_s - 1e-3);
}

TEST(SpeedLimits, AZoneByArcLengthCapsItsIntervalExactly) {
  const ScratchDirectory scratch;
  const Plan free = planned(scratch, kHead + kLegs);
  const Plan zoned =
      planned(scratch, kHead + kLegs + "speed_zones: [{leg: 0, from_m: 3, to_m: 4.5, speed_m_s: 0.3}]\n");
  double top_inside = 0;
  at_every_place(zoned, [&](const Pose&, const ProfileState& state) {
    if (state.s >= 3 && state.s <= 4.5) top_inside = std::max(top_inside, state.rate);
  });
  EXPECT_LE(top_inside, 0.3 * (1 + 1e-6));
  const double ramps_m = 2 * (1 - 0.09) / (2 * 0.5), ramps_s = 2 * 0.7 / 0.5;
  EXPECT_NEAR(zoned.duration_s - free.duration_s, ramps_s - ramps_m + 1.5 / 0.3 - 1.5, 2e-3);
}

TEST(SpeedLimits, AnAccelerationBetweenTwoPayloadsIsInterpolatedAndTheTablesEndsHold) {
  const ScratchDirectory scratch;
  const auto largest = [&](double payload_kg) {
    const std::string payload = "payload_kg: " + std::to_string(payload_kg) + "}]\n";
    const Plan plan = planned(scratch, kHead + kLegs.substr(0, kLegs.size() - 3) + ", " + payload);
    double most = 0;
    at_every_place(
        plan, [&](const Pose&, const ProfileState& state) { most = std::max(most, state.acceleration); });
    return most;
  };
  // by_payload of this robot: 0.5 m/s^2 with 0 kg, 0.3 with 10 kg.
  EXPECT_NEAR(largest(0), 0.5, 1e-5);
  EXPECT_NEAR(largest(5), 0.4, 1e-5);
  EXPECT_NEAR(largest(7.5), 0.35, 1e-5);
  EXPECT_NEAR(largest(11), 0.3, 1e-5) << "beyond the last row its value holds";
}

TEST(SpeedLimits, ARoundedCornerIsDrivenWithoutAStopAndASharpOneStops) {
  const ScratchDirectory scratch;
  const auto slowest_inside = [&](const char* radius_m, int pieces) {
    const std::string path =
        scratch.write("path.csv", std::string("x_m,y_m,corner_radius_m\n0,0,\n3,0,") + radius_m + "\n3,3,\n");
    const Plan plan = planned({.file = path, .robot_file = kRobot});
    EXPECT_EQ(plan.legs.front().stretches.size(), static_cast<std::size_t>(pieces));
    double least = 1e9;
    at_every_place(plan, [&](const Pose& pose, const ProfileState& state) {
      if (std::hypot(pose.x_m, pose.y_m) > 0.5 && std::hypot(pose.x_m - 3, pose.y_m - 3) > 0.5)
        least = std::min(least, state.rate);
    });
    return least;
  };
  EXPECT_GT(slowest_inside("0.5", 1), 0.2);
  EXPECT_EQ(slowest_inside("0", 3), 0) << "straight, turn in place, straight";
}

}  // namespace
}  // namespace joulepath
