#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-overflow"  // GCC 12 is wrong about copies of a std::variant
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "model/limit_table.hpp"
#include "planner/motion/replay.hpp"
#include "planner/path/shape/bezier_chain.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

const PathPiece kCurve = Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})});
const PathPiece kBackward = straight_piece({}, 3, Direction::reverse);
const PathPiece kTurn = TurnInPlace{{}, -2.5};

ProfileRequest fastest_drive(const PathPiece& piece) {
  Robot robot = testing::nomad();
  robot.power.standby_W = 10;
  return {.piece = piece,
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .time = {TimeMode::minimum_time},
          .nodes = 80,
          .solver = SolverChoice::fast};
}

struct Tightened {
  std::string limit;
  std::function<void(ProfileRequest&)> tighten;

  friend std::ostream& operator<<(std::ostream& stream, const Tightened& one) { return stream << one.limit; }
};

Tightened limit(const std::string& name, double value) {
  const Limit& row = *limit_named(name);
  return {name, [&row, value](ProfileRequest& request) {
            if (row.field != nullptr)
              request.limits.*row.field = value;
            else
              for (const Side side : kSides) request.plant.robot.motor[side].*row.rating = value;
          }};
}

/// The fastest drive without and with the limit, by both solvers, with a dense check.
void expect_costs_time_and_holds(const PathPiece& piece, const Tightened& one) {
  const ProfileResult free = solve_profile(fastest_drive(piece));
  ProfileRequest request = fastest_drive(piece);
  one.tighten(request);

  const ReplayResult ignored = replay(request, *free.profile);  // the free drive exceeds the limit
  EXPECT_EQ(ignored.limit, one.limit);
  EXPECT_GT(ignored.worst_violation, 0.01);

  for (const SolverChoice solver : {SolverChoice::fast, SolverChoice::ipopt}) {
    request.solver = solver;
    const ProfileResult kept = solve_profile(request);
    ASSERT_TRUE(kept.profile) << kept.summary.message
                              << (kept.infeasibility ? kept.infeasibility->message : "");
    EXPECT_GT(kept.profile->duration_s(), 1.005 * free.profile->duration_s());
    EXPECT_TRUE(replay(request, *kept.profile).valid()) << replay(request, *kept.profile).worst_violation;
  }
}

class EveryLimit : public ::testing::TestWithParam<Tightened> {};
class EveryLimitBackward : public ::testing::TestWithParam<Tightened> {};
class EveryLimitOfATurn : public ::testing::TestWithParam<Tightened> {};

TEST_P(EveryLimit, CostsTimeAndHoldsBetweenTheNodes) { expect_costs_time_and_holds(kCurve, GetParam()); }
TEST_P(EveryLimitBackward, CostsTimeAndHoldsBetweenTheNodes) {
  expect_costs_time_and_holds(kBackward, GetParam());
}
TEST_P(EveryLimitOfATurn, CostsTimeAndHoldsBetweenTheNodes) {
  expect_costs_time_and_holds(kTurn, GetParam());
}

const std::vector<Tightened> kOnACurve{limit("speed", 0.5),
                                       limit("acceleration", 0.2),
                                       limit("deceleration", 0.2),
                                       limit("lateral_acceleration", 0.1),
                                       limit("yaw_rate", 0.3),
                                       limit("yaw_acceleration", 0.1),
                                       limit("wheel_acceleration", 2),
                                       limit("traction", 0.04),
                                       limit("motor_power", 5),
                                       limit("battery_power", 20),
                                       limit("motor_current", 0.5),
                                       limit("motor_voltage", 6),
                                       limit("battery_voltage", 6)};
const std::vector<Tightened> kInATurn{
    limit("yaw_rate", 0.8),       limit("yaw_acceleration", 0.7), limit("wheel_acceleration", 2),
    limit("traction", 0.02),      limit("motor_power", 1.2),      limit("battery_power", 12),
    limit("motor_current", 0.35), limit("motor_voltage", 3),      limit("battery_voltage", 3)};

const std::vector<Tightened> kDrivenBackward{limit("reverse_speed", 0.4), limit("acceleration", 0.2),
                                             limit("deceleration", 0.2)};

INSTANTIATE_TEST_SUITE_P(OfTheRobotFile, EveryLimit, ::testing::ValuesIn(kOnACurve),
                         [](const auto& one) { return one.param.limit; });
INSTANTIATE_TEST_SUITE_P(OfTheRobotFile, EveryLimitBackward, ::testing::ValuesIn(kDrivenBackward),
                         [](const auto& one) { return one.param.limit; });
INSTANTIATE_TEST_SUITE_P(OfTheRobotFile, EveryLimitOfATurn, ::testing::ValuesIn(kInATurn),
                         [](const auto& one) { return one.param.limit; });

/// Jerk is tested in jerk_test.cpp, the charging power with robots that recover energy in
/// battery_charge_test.cpp.
TEST(EveryLimitOfTheTable, IsTightenedAbove) {
  for (const Limit& row : kLimits) {
    if (row.value == nullptr || row.name == "jerk" || row.name == "charge_power") continue;
    const auto tightens = [&](const Tightened& one) { return one.limit == row.name; };
    EXPECT_TRUE(std::any_of(kOnACurve.begin(), kOnACurve.end(), tightens) ||
                std::any_of(kDrivenBackward.begin(), kDrivenBackward.end(), tightens))
        << row.name;
  }
}

/// Nothing bounds the speed at the straight start of the bend; a coarse grid must not bound it either.
TEST(NoLimitOfSpeed, CostsACoarseGridLittle) {
  const auto cost_J = [](int nodes) {
    ProfileRequest request = fastest_drive(Curve({BezierSegment({{{0, 0}, {1, 0}, {2, 0}, {2.5, 0.5}}})}));
    request.limits.speed_m_s = kNoLimit;
    request.time = {TimeMode::free_time};
    request.nodes = nodes;
    const Profile profile = *solve_profile(request).profile;
    return replay(request, profile).energy_J + request.plant.robot.power.standby_W * profile.duration_s();
  };
  EXPECT_LT(cost_J(20), 1.02 * cost_J(160));
}

}  // namespace
}  // namespace joulepath
