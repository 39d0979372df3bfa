#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-overflow"  // GCC 12 is wrong about copies of a std::variant
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/limit_table.hpp"
#include "planner/motion/replay.hpp"
#include "planner/path/shape/bezier_chain.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/planner/nlp/hopeless_requests.hpp"

namespace joulepath {
namespace {

using testing::bezier_run;
using testing::changed;
using testing::hopeless_requests;
using testing::HopelessRequest;
using testing::minimum_s;
using testing::run_on;
using testing::set_both_motors;
using testing::straight_run;
using testing::turn_run;
using testing::within;

/// 10 m at 0.5 m/s^2 and 1 m/s: 2 s up, 8 s at full speed, 2 s down.
TEST(LeastTime, AVerdictNamesTheLimitThatHoldsLongestAndItsShare) {
  ProfileRequest request = straight_run(10);
  request.limits.acceleration_m_s2 = request.limits.deceleration_m_s2 = 0.5;
  request.limits.speed_m_s = 1;
  const std::string message = solve_profile(within(request, TimeMode::time_budget, 5)).summary.message;
  EXPECT_NE(message.find("; speed limits the fastest drive for 67 % of its time"), std::string::npos)
      << message;
  EXPECT_NEAR(std::stod(message.substr(message.rfind("s = ") + 4)), 1.0, 0.01) << message;
}

/// The tangent of this curve nearly vanishes at t = 1/3: its curvature has no bound there, and no step of an
/// integrator resolves it.
TEST(Replay, EndsAtAKinkThatNoStepResolves) {
  for (const double aside_m : {1e-9, 1e-7, 1e-5}) {
    ProfileRequest request = straight_run(1.0);
    request.piece =
        Curve({BezierSegment({{{0, 0}, {1.0 / 3, aside_m}, {-1.0 / 3, 3 * aside_m}, {1, aside_m}}})});
    const double length_m = piece_length(request.piece);
    const ReplayResult result = replay(
        request, profile_from_squares({0, 0.1 * length_m, 0.9 * length_m, length_m}, {0, 0.3, 0.3, 0}));
    EXPECT_GT(result.worst_violation, 1.0) << aside_m;
  }
}

TEST(Verdicts, EveryHopelessInputSaysWhichWhereAndHowMuch) {
  const std::vector<HopelessRequest> cases = hopeless_requests();
  EXPECT_GE(cases.size(), 40u);
  for (const HopelessRequest& c : cases) {
    const ProfileResult result = solve_profile(c.request);
    EXPECT_EQ(result.summary.status, SolveStatus::infeasible) << c.name << ": " << result.summary.message;
    EXPECT_FALSE(result.profile.has_value()) << c.name;
    ASSERT_TRUE(result.infeasibility.has_value()) << c.name;
    const Infeasibility& verdict = *result.infeasibility;
    EXPECT_EQ(verdict.constraint, c.constraint) << c.name << ": " << verdict.message;
    EXPECT_FALSE(verdict.message.empty()) << c.name;
    EXPECT_FALSE(verdict.unit.empty()) << c.name;
    EXPECT_TRUE(std::isfinite(verdict.s) && std::isfinite(verdict.x_m) && std::isfinite(verdict.y_m))
        << c.name;
  }
}

bool relax(ProfileRequest& r, const std::string& key, double value) {
  if (key == "deadline_s" || key == "duration_s")
    r.time.duration_s = value;
  else if (key == "start_speed_m_s")
    r.start_rate = value;
  else if (key == "end_speed_m_s")
    r.end_rate = value;
  else {
    const auto row =
        std::find_if(kLimits.begin(), kLimits.end(), [&](const Limit& limit) { return limit.key == key; });
    if (row == kLimits.end()) return false;
    if (row->rating != nullptr)
      set_both_motors(r, row->rating, value);
    else
      r.limits.*row->field = key == "speed_m_s" ? std::max(r.limits.speed_m_s, value) : value;
    if (key == "speed_m_s")
      for (SpeedCap& cap : r.speed_caps) cap.speed_m_s = std::max(cap.speed_m_s, value);
  }
  return true;
}

/// The offered value plus a thousandth is enough, half of the change is not.
TEST(Verdicts, TheRelaxationWouldDo) {
  int tried = 0;
  for (const HopelessRequest& c : hopeless_requests()) {
    const ProfileResult result = solve_profile(c.request);
    if (!result.infeasibility || result.infeasibility->relaxation.empty()) continue;
    const auto& [key, value] = *result.infeasibility->relaxation.begin();
    ProfileRequest relaxed = c.request;
    const bool less = key == "start_speed_m_s" || key == "end_speed_m_s" || c.name == "too long at speed";
    ASSERT_TRUE(relax(relaxed, key, value * (less ? 0.999 : 1.001))) << key;
    relaxed.time = relaxed.time.mode == TimeMode::free_time ? TimeGoal{TimeMode::minimum_time} : relaxed.time;
    const ProfileResult again = solve_profile(relaxed);
    EXPECT_TRUE(again.profile.has_value())
        << c.name << ": " << key << " = " << value << ": " << again.summary.message;
    if (again.profile) {
      EXPECT_TRUE(replay(relaxed, *again.profile).valid()) << c.name;
    }
    ++tried;
  }
  EXPECT_GE(tried, 38);
}

/// Less than the offered value is not enough, down to 1e-6; below that nothing is offered.
TEST(Verdicts, NoLimitIsRaisedFurtherThanItMustBe) {
  for (const HopelessRequest& c : hopeless_requests()) {
    const ProfileResult result = solve_profile(c.request);
    if (!result.infeasibility || result.infeasibility->relaxation.empty()) continue;
    const auto& [key, value] = *result.infeasibility->relaxation.begin();
    const bool is_limit = std::any_of(kLimits.begin(), kLimits.end(), [&key = key](const Limit& row) {
      return row.key == key && row.name != "jerk";
    });
    if (!is_limit || value <= 1e-6) continue;
    ProfileRequest relaxed = c.request;
    ASSERT_TRUE(relax(relaxed, key, value * 0.999)) << key;
    relaxed.time = {TimeMode::minimum_time};
    EXPECT_FALSE(solve_profile(relaxed).profile.has_value()) << c.name << ": " << key << " = " << value;
  }
}

TEST(Verdicts, AJerkLimitTooLowForTheDeadlineNamesOneThatWouldDo) {
  ProfileRequest request = within(straight_run(), TimeMode::time_budget, 1.02 * minimum_s(straight_run()));
  request.limits.jerk_m_s3 = 0.01;
  const ProfileResult result = solve_profile(request);
  EXPECT_FALSE(result.profile.has_value());
  ASSERT_TRUE(result.infeasibility.has_value());
  EXPECT_EQ(result.infeasibility->constraint, "jerk");
  ASSERT_EQ(result.infeasibility->relaxation.count("jerk_m_s3"), 1u) << result.infeasibility->message;
  request.limits.jerk_m_s3 = result.infeasibility->relaxation.at("jerk_m_s3");
  const ProfileResult relaxed = solve_profile(request);
  ASSERT_TRUE(relaxed.profile.has_value()) << relaxed.summary.message;
  EXPECT_TRUE(replay(request, *relaxed.profile).valid());
  request.limits.jerk_m_s3 *= 0.9;
  EXPECT_FALSE(solve_profile(request).profile.has_value());
}

/// Without any jerk nothing moves. The limit that is offered is the least one, to 2 %.
TEST(Verdicts, AJerkLimitOfZeroNamesTheLeastThatWouldDo) {
  ProfileRequest request = within(straight_run(), TimeMode::time_budget, 1.3 * minimum_s(straight_run()));
  request.limits.jerk_m_s3 = 0;
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.infeasibility.has_value());
  const double offered = result.infeasibility->relaxation.at("jerk_m_s3");
  request.limits.jerk_m_s3 = offered;
  EXPECT_TRUE(solve_profile(request).profile.has_value());
  request.limits.jerk_m_s3 = 0.97 * offered;
  EXPECT_FALSE(solve_profile(request).profile.has_value()) << offered;
}

/// From v the robot stops within v^2/(2 d): the start speed that is offered is the greatest one, to 1e-5.
TEST(Verdicts, TheStartSpeedOfferedIsTheGreatest) {
  for (int i = 1; i <= 12; ++i) {
    ProfileRequest request = straight_run(0.07 * i);
    request.start_rate = 1.0;
    const double greatest_m_s = std::sqrt(2 * request.limits.deceleration_m_s2 * 0.07 * i);
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.infeasibility.has_value()) << i;
    const double offered_m_s = result.infeasibility->relaxation.at("start_speed_m_s");
    EXPECT_LE(offered_m_s, greatest_m_s * (1 + 1e-9)) << i;
    EXPECT_GE(offered_m_s, greatest_m_s * (1 - 1e-5)) << i;
  }
}

/// A heavy robot with strong motors at a voltage that holds it far below its speed limit: from rest to rest a
/// slow drive keeps everything, so no grid is a reason to refuse. On long segments a rate above the steady one
/// needs hard braking, and the tangents of the voltage leave little.
TEST(Verdicts, NoGridRefusesWhatASlowDriveKeeps) {
  ProfileRequest request = straight_run(2);
  Robot& robot = request.plant.robot;
  robot.inertia.chassis_mass_kg = 168;
  for (const Side side : kSides) {
    Motor& motor = robot.motor[side];
    motor = {.gear_ratio = 20,
             .resistance_ohm = 0.12,
             .torque_constant_Nm_A = 0.115,
             .voltage_constant_V_s_rad = 0.115,
             .viscous_friction_Nm_s_rad = 0.02,
             .friction_torque_Nm = 2.2};
  }
  request.limits = {.speed_m_s = 1.5, .acceleration_m_s2 = 0.8, .deceleration_m_s2 = 0.8};
  const double standing_V = 2.2 / (20 * 0.115) * 0.12;
  for (const double jerk_m_s3 : {kNoLimit, 1.0})
    for (const double voltage_V : {1.3 * standing_V, 4.2, 6.0})
      for (const std::size_t nodes : {22u, 30u, 60u, 90u}) {
        set_both_motors(request, &Motor::max_voltage_V, voltage_V);
        request.limits.jerk_m_s3 = jerk_m_s3;
        request.nodes = nodes;
        request.time = {TimeMode::minimum_time};
        const ProfileResult result = solve_profile(request);
        ASSERT_TRUE(result.profile.has_value())
            << voltage_V << " V, jerk " << jerk_m_s3 << ", " << nodes << " nodes: " << result.summary.message;
        EXPECT_TRUE(replay(request, *result.profile).valid()) << voltage_V << " V, " << nodes << " nodes";
      }
}

/// Braking from v without acceleration at both ends takes v/2 (v/d + d/j) at least.
TEST(Verdicts, ASpeedThatTheJerkLimitCannotStopInTimeIsRefused) {
  for (const double length_m : {1.2, 1.7}) {
    ProfileRequest request = straight_run(length_m);
    request.start_rate = 1;
    request.limits.deceleration_m_s2 = 0.5;
    request.limits.jerk_m_s3 = 0.5;
    const double needed_m = 0.5 * (1 / 0.5 + 0.5 / 0.5);
    const ProfileResult result = solve_profile(request);
    ASSERT_EQ(result.profile.has_value(), length_m > needed_m) << length_m << ": " << result.summary.message;
    if (result.profile) continue;
    EXPECT_EQ(result.summary.status, SolveStatus::infeasible);
    request.limits.jerk_m_s3 = result.infeasibility->relaxation.at("jerk_m_s3");
    EXPECT_TRUE(solve_profile(request).profile.has_value());
  }
}

/// What is offered for the problem without the jerk limit is planned with it.
TEST(Verdicts, WhatIsOfferedUnderAJerkLimitIsPlannedWithIt) {
  ProfileRequest request = straight_run(0.8);
  request.start_rate = 1;  // stops within 1 m without a jerk limit
  request.limits.jerk_m_s3 = 1;
  const ProfileResult result = solve_profile(request);
  ASSERT_EQ(result.summary.status, SolveStatus::infeasible) << result.summary.message;
  ASSERT_FALSE(result.infeasibility->relaxation.empty()) << result.summary.message;
  const auto& [key, value] = *result.infeasibility->relaxation.begin();
  ASSERT_TRUE(relax(request, key, value));
  EXPECT_TRUE(solve_profile(request).profile.has_value()) << key << " = " << value;
}

/// Only viscous friction, no standby: every longer time takes less, down to nothing.
TEST(Verdicts, WhereSlowerIsAlwaysCheaperAnOpenTimeIsRefusedAtOnce) {
  for (ProfileRequest request : {straight_run(), bezier_run(), turn_run()}) {
    request.plant.robot.power.standby_W = 0;
    EXPECT_TRUE(solve_profile(request).profile.has_value()) << "dry friction heats the motors";
    for (const Side side : kSides) request.plant.robot.motor[side].friction_torque_Nm = 0;
    const ProfileResult result = solve_profile(request);
    EXPECT_EQ(result.summary.status, SolveStatus::infeasible);
    EXPECT_EQ(result.summary.iterations, 0);
    EXPECT_NE(result.summary.message.find("slower is always cheaper"), std::string::npos);
    EXPECT_TRUE(solve_profile(within(request, TimeMode::time_budget, 40)).profile.has_value());
    request.plant.robot.power.standby_W = 1;
    EXPECT_TRUE(solve_profile(request).profile.has_value());
  }
}

TEST(Verdicts, DegenerateButPossibleInputsArePlanned) {
  std::vector<HopelessRequest> cases;
  const auto add = [&](std::string name, ProfileRequest request) {
    cases.push_back({std::move(name), std::move(request), ""});
  };
  add("a micrometre", straight_run(1e-6));
  add("a millimetre", straight_run(1e-3));
  add("ten kilometres", straight_run(1e4));
  add("exactly the minimum time", within(straight_run(), TimeMode::time_budget, minimum_s(straight_run())));
  add("minimum time and a millionth",
      within(bezier_run(), TimeMode::time_budget, minimum_s(bezier_run()) * (1 + 1e-6)));
  add("minimum time and a thousandth",
      within(bezier_run(), TimeMode::fixed_time, minimum_s(bezier_run()) * (1 + 1e-3)));
  add("very long", within(straight_run(), TimeMode::time_budget, 1e6));
  add("through at speed", changed(straight_run(), [](ProfileRequest& r) { r.start_rate = r.end_rate = 1; }));
  add("a turn by a microradian", run_on(TurnInPlace{{}, 1e-6}));
  add("three whole turns", run_on(TurnInPlace{{}, -18.85}));
  add("nothing limited but speed", changed(bezier_run(), [](ProfileRequest& r) {
        r.limits = Limits{};
        r.limits.speed_m_s = 1;
      }));
  add("four nodes", changed(bezier_run(), [](ProfileRequest& r) { r.nodes = 4; }));
  add("zone of no length", changed(straight_run(), [](ProfileRequest& r) { r.speed_caps = {{5, 5, 0.1}}; }));
  for (const auto& [name, request, nothing] : cases) {
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile.has_value()) << name << ": " << result.summary.message;
    const ReplayResult again = replay(request, *result.profile);
    EXPECT_TRUE(again.valid()) << name << ": " << again.limit << " " << again.worst_violation;
  }
}

/// The closed form's least time, to the last digit: a grid reaches it only with nodes at its switches.
TEST(Verdicts, ADeadlineOfExactlyTheLeastTimeIsPlanned) {
  for (TimeMode mode : {TimeMode::time_budget, TimeMode::fixed_time, TimeMode::time_price})
    for (double length_m : {0.7, 10.0, 33.3}) {
      const ProfileRequest r = straight_run(length_m);
      const double v = r.limits.speed_m_s, a = r.limits.acceleration_m_s2, d = r.limits.deceleration_m_s2;
      const double ramps_m = v * v / (2 * a) + v * v / (2 * d);
      const double exact_s = length_m > ramps_m ? length_m / v + v / (2 * a) + v / (2 * d)
                                                : std::sqrt(2 * length_m * (1 / a + 1 / d));
      const ProfileRequest request = within(r, mode, exact_s);
      const ProfileResult result = solve_profile(request);
      ASSERT_TRUE(result.profile.has_value()) << length_m << " m: " << result.summary.message;
      EXPECT_NEAR(result.profile->duration_s(), exact_s, 2e-7 * exact_s);
      EXPECT_TRUE(replay(request, *result.profile).valid());
      EXPECT_FALSE(solve_profile(within(r, mode, exact_s * (1 - 1e-5))).profile.has_value());
    }
}

/// On a curve there is no closed form: the least time of a finer grid replaces it.
TEST(Verdicts, ADeadlineThatOnlyAFinerGridMakesIsPlanned) {
  ProfileRequest fine = bezier_run();
  fine.nodes = 1000;
  const double least_s = minimum_s(fine);
  const ProfileRequest request = within(bezier_run(), TimeMode::time_budget, least_s);
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  EXPECT_LE(result.profile->duration_s(), least_s * (1 + 2e-7));
  EXPECT_TRUE(replay(request, *result.profile).valid());
}

TEST(Verdicts, ThePapersOwnCurveIsRegularAndPlans) {
  const BezierChainResult chain =
      bezier_chain({{{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, 2.7}}}}, {}, BezierFrame::start);
  ASSERT_TRUE(chain.ok());
  ASSERT_EQ(chain.path.pieces.size(), 1u);
  const ProfileRequest request = run_on(chain.path.pieces.front());
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  EXPECT_TRUE(replay(request, *result.profile).valid());
}

}  // namespace
}  // namespace joulepath
