#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-overflow"  // GCC 12 is wrong about copies of a std::variant
#endif

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "model/limit_table.hpp"
#include "planner/motion/replay.hpp"
#include "planner/path/shape/bezier_chain.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ProfileRequest straight(double length_m = 10) {
  const Robot robot = testing::nomad();
  return {.piece = straight_piece({}, length_m),
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .nodes = 80,
          .solver = SolverChoice::fast};
}

ProfileRequest on(PathPiece piece) {
  ProfileRequest request = straight();
  request.piece = std::move(piece);
  return request;
}

ProfileRequest bezier() { return on(Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})})); }
ProfileRequest turn() { return on(TurnInPlace{{}, 1.5}); }

/// A straight run into an arc of 0.3 m radius through a clothoid.
ProfileRequest into_arc(double run_m) {
  std::vector<CurveSegment> segments{LinearCurvature({}, run_m)};
  segments.emplace_back(LinearCurvature({run_m, 0, 0}, 0.3, 0, 1 / 0.3 / 0.3));
  const Pose pose = std::get<LinearCurvature>(segments.back()).at(0.3).pose;
  segments.emplace_back(LinearCurvature(pose, 0.3, 1 / 0.3));
  return on(Curve(std::move(segments)));
}

ProfileRequest with_effect(ProfileRequest request, EffectSetting effect) {
  request.plant = make_plant(request.plant.robot, {std::move(effect)});
  return request;
}

ProfileRequest changed(ProfileRequest request, const std::function<void(ProfileRequest&)>& change) {
  change(request);
  return request;
}

double minimum_s(ProfileRequest request) {
  request.time = {TimeMode::minimum_time};
  return solve_profile(request).profile->duration_s();
}

ProfileRequest within(ProfileRequest request, TimeMode mode, double duration_s) {
  request.time = {mode, duration_s};
  return request;
}

struct Case {
  std::string name;
  ProfileRequest request;
  std::string constraint;
};

void both_motors(ProfileRequest& r, double Motor::*member, double value) {
  r.plant.robot.motor.left.*member = value;
  r.plant.robot.motor.right.*member = value;
}

std::vector<Case> hopeless() {
  using R = ProfileRequest&;
  std::vector<Case> cases;
  const auto add = [&](std::string name, ProfileRequest request, std::string constraint) {
    cases.push_back({std::move(name), std::move(request), std::move(constraint)});
  };
  // Time
  add("deadline 1 ms short", within(straight(), TimeMode::time_budget, minimum_s(straight()) - 1e-3),
      "deadline");
  add("deadline half", within(straight(), TimeMode::time_budget, 6), "deadline");
  add("bezier 1 ms short", within(bezier(), TimeMode::time_budget, minimum_s(bezier()) - 1e-3), "deadline");
  add("turn 1 ms short", within(turn(), TimeMode::time_budget, minimum_s(turn()) - 1e-3), "deadline");
  add("duration short", within(straight(), TimeMode::fixed_time, 11), "duration");
  add("priced, short", within(straight(), TimeMode::time_price, 11), "deadline");
  add("no time", within(straight(), TimeMode::time_budget, 0), "deadline");
  add("negative time", within(straight(), TimeMode::fixed_time, -3), "duration");
  add("tiny time", within(straight(), TimeMode::time_budget, 1e-9), "deadline");
  add("NaN time", within(straight(), TimeMode::time_budget, kNaN), "deadline");
  add("too long at speed",
      changed(within(straight(0.5), TimeMode::fixed_time, 60), [](R r) { r.start_rate = r.end_rate = 0.9; }),
      "duration");
  // Start and end speeds
  add("start not shed", changed(straight(0.5), [](R r) { r.start_rate = 1; }), "start_speed");
  add("end not reached", changed(straight(0.5), [](R r) { r.end_rate = 1; }), "end_speed");
  add("start above limit", changed(straight(), [](R r) { r.start_rate = 1.2; }), "start_speed");
  add("end above limit", changed(straight(), [](R r) { r.end_rate = 1.2; }), "end_speed");
  add("start not shed before the curve", changed(into_arc(0.2), [](R r) { r.start_rate = 0.95; }),
      "start_speed");
  add("end too fast for the arc", changed(into_arc(2), [](R r) { r.end_rate = 0.9; }), "end_speed");
  add("start not shed before the zone",
      changed(straight(),
              [](R r) {
                r.start_rate = 1, r.speed_caps = {{0.3, 4, 0.2}};
              }),
      "start_speed");
  add("end above its zone",
      changed(straight(),
              [](R r) {
                r.end_rate = 0.8, r.speed_caps = {{8, 10, 0.2}};
              }),
      "end_speed");
  add("negative start", changed(straight(), [](R r) { r.start_rate = -1; }), "start_speed");
  add("NaN start", changed(straight(), [](R r) { r.start_rate = kNaN; }), "start_speed");
  add("infinite end", changed(straight(), [](R r) { r.end_rate = kNoLimit; }), "start_speed");
  // Limits of zero
  add("speed 0", changed(straight(), [](R r) { r.limits.speed_m_s = 0; }), "speed");
  add("acceleration 0", changed(straight(), [](R r) { r.limits.acceleration_m_s2 = 0; }), "acceleration");
  add("deceleration 0", changed(straight(), [](R r) { r.limits.deceleration_m_s2 = 0; }), "deceleration");
  add("lateral 0", changed(bezier(), [](R r) { r.limits.lateral_acceleration_m_s2 = 0; }),
      "lateral_acceleration");
  add("yaw rate 0 on a curve", changed(bezier(), [](R r) { r.limits.yaw_rate_rad_s = 0; }), "yaw_rate");
  add("yaw rate 0 in a turn", changed(turn(), [](R r) { r.limits.yaw_rate_rad_s = 0; }), "yaw_rate");
  add("yaw acceleration 0 in a turn", changed(turn(), [](R r) { r.limits.yaw_acceleration_rad_s2 = 0; }),
      "yaw_acceleration");
  add("wheel acceleration 0", changed(straight(), [](R r) { r.limits.wheel_acceleration_rad_s2 = 0; }),
      "wheel_acceleration");
  add("traction 0", changed(straight(), [](R r) { r.limits.traction_coefficient = 0; }), "traction");
  add("motor power 0", changed(straight(), [](R r) { r.limits.motor_power_W = 0; }), "motor_power");
  add("battery power 0", changed(straight(), [](R r) { r.limits.battery_power_W = 0; }), "battery_power");
  add("current 0", changed(straight(), [](R r) { both_motors(r, &Motor::max_current_A, 0); }),
      "motor_current");
  add("voltage 0", changed(straight(), [](R r) { both_motors(r, &Motor::max_voltage_V, 0); }),
      "motor_voltage");
  add("jerk 0", changed(straight(), [](R r) { r.limits.jerk_m_s3 = 0; }), "jerk");
  add("negative jerk", changed(bezier(), [](R r) { r.limits.jerk_m_s3 = -1; }), "limits");
  add("NaN current", changed(straight(), [](R r) { r.plant.robot.motor.right.max_current_A = kNaN; }),
      "limits");
  add("jerk 0 and a deadline",
      changed(within(straight(), TimeMode::time_budget, 20), [](R r) { r.limits.jerk_m_s3 = 0; }), "jerk");
  add("zone of 0", changed(straight(), [](R r) { r.speed_caps = {{4, 5, 0}}; }), "speed");
  // Too weak
  add("battery below standby", changed(straight(), [](R r) { r.limits.battery_power_W = 9; }),
      "battery_power");
  add("current below friction", changed(straight(), [](R r) { both_motors(r, &Motor::max_current_A, 0.15); }),
      "motor_current");
  add("voltage below friction", changed(straight(), [](R r) { both_motors(r, &Motor::max_voltage_V, 0.4); }),
      "motor_voltage");
  add("motor power below copper loss", changed(straight(), [](R r) { r.limits.motor_power_W = 0.05; }),
      "motor_power");
  add("turn, weak motors", changed(turn(), [](R r) { both_motors(r, &Motor::max_current_A, 0.15); }),
      "motor_current");
  add("slope too steep",
      with_effect(changed(straight(), [](R r) { both_motors(r, &Motor::max_current_A, 1.5); }),
                  {.name = "floor_slope", .parameters = {{"grade", 0.3}, {"uphill_direction_rad", 0}}}),
      "motor_current");
  add("slope too slippery",
      with_effect(changed(straight(), [](R r) { r.limits.traction_coefficient = 0.1; }),
                  {.name = "floor_slope", .parameters = {{"grade", 0.3}, {"uphill_direction_rad", 0}}}),
      "traction");
  add("patch too rough",
      with_effect(
          changed(straight(), [](R r) { both_motors(r, &Motor::max_current_A, 1); }),
          {.name = "floor_patch",
           .parameters =
               {{"coefficient", 0.4}, {"x_min_m", 4}, {"x_max_m", 6}, {"y_min_m", -1}, {"y_max_m", 1}}}),
      "motor_current");
  add("dragging wheel",
      with_effect(changed(straight(), [](R r) { both_motors(r, &Motor::max_current_A, 1); }),
                  {.name = "dragging_wheel", .parameters = {{"torque_Nm", 5}}, .side = Side::left}),
      "motor_current");
  // Nonsense
  add("turn by nothing", on(TurnInPlace{{}, 0}), "path");
  add("turn by NaN", on(TurnInPlace{{}, kNaN}), "path");
  add("NaN limit", changed(straight(), [](R r) { r.limits.speed_m_s = kNaN; }), "limits");
  add("negative limit", changed(straight(), [](R r) { r.limits.acceleration_m_s2 = -1; }), "limits");
  add("NaN payload", changed(straight(), [](R r) { r.payload = {kNaN, kNaN}; }), "payload");
  return cases;
}

TEST(Verdicts, EveryHopelessInputSaysWhichWhereAndHowMuch) {
  const std::vector<Case> cases = hopeless();
  EXPECT_GE(cases.size(), 40u);
  for (const Case& c : cases) {
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
      both_motors(r, row->rating, value);
    else
      r.limits.*row->field = key == "speed_m_s" ? std::max(r.limits.speed_m_s, value) : value;
    if (key == "speed_m_s")
      for (SpeedCap& cap : r.speed_caps) cap.speed_m_s = std::max(cap.speed_m_s, value);
  }
  return true;
}

/// A thousandth more than the relaxation asked for is enough, half of it is not.
TEST(Verdicts, TheRelaxationWouldDo) {
  int tried = 0;
  for (const Case& c : hopeless()) {
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

/// Less than what is offered must not be enough, down to 1e-6, below which nothing is offered.
TEST(Verdicts, NoLimitIsRaisedFurtherThanItMustBe) {
  for (const Case& c : hopeless()) {
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
  ProfileRequest request = within(straight(), TimeMode::time_budget, 1.02 * minimum_s(straight()));
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

TEST(Verdicts, DegenerateButPossibleInputsJustPlan) {
  std::vector<Case> cases;
  const auto add = [&](std::string name, ProfileRequest request) {
    cases.push_back({std::move(name), std::move(request), ""});
  };
  add("a micrometre", straight(1e-6));
  add("a millimetre", straight(1e-3));
  add("ten kilometres", straight(1e4));
  add("exactly the minimum time", within(straight(), TimeMode::time_budget, minimum_s(straight())));
  add("minimum time and a millionth",
      within(bezier(), TimeMode::time_budget, minimum_s(bezier()) * (1 + 1e-6)));
  add("minimum time and a thousandth",
      within(bezier(), TimeMode::fixed_time, minimum_s(bezier()) * (1 + 1e-3)));
  add("very long", within(straight(), TimeMode::time_budget, 1e6));
  add("through at speed", changed(straight(), [](ProfileRequest& r) { r.start_rate = r.end_rate = 1; }));
  add("a turn by a microradian", on(TurnInPlace{{}, 1e-6}));
  add("three whole turns", on(TurnInPlace{{}, -18.85}));
  add("nothing limited but speed", changed(bezier(), [](ProfileRequest& r) {
        r.limits = Limits{};
        r.limits.speed_m_s = 1;
      }));
  add("four nodes", changed(bezier(), [](ProfileRequest& r) { r.nodes = 4; }));
  add("zone of no length", changed(straight(), [](ProfileRequest& r) { r.speed_caps = {{5, 5, 0.1}}; }));
  for (const auto& [name, request, nothing] : cases) {
    const ProfileResult result = solve_profile(request);
    ASSERT_TRUE(result.profile.has_value()) << name << ": " << result.summary.message;
    const ReplayResult again = replay(request, *result.profile);
    EXPECT_TRUE(again.valid()) << name << ": " << again.limit << " " << again.worst_violation;
  }
}

/// The closed form's least time, to the last digit: no grid makes it without nodes where it bends.
TEST(Verdicts, ADeadlineOfExactlyTheLeastTimeIsPlanned) {
  for (TimeMode mode : {TimeMode::time_budget, TimeMode::fixed_time, TimeMode::time_price})
    for (double length_m : {0.7, 10.0, 33.3}) {
      const ProfileRequest r = straight(length_m);
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

/// On a curve the closed form is unknown: the least time of a finer grid stands in for it.
TEST(Verdicts, ADeadlineThatOnlyAFinerGridMakesIsPlanned) {
  ProfileRequest fine = bezier();
  fine.nodes = 1000;
  const double least_s = minimum_s(fine);
  const ProfileRequest request = within(bezier(), TimeMode::time_budget, least_s);
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
  const ProfileRequest request = on(chain.path.pieces.front());
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  EXPECT_TRUE(replay(request, *result.profile).valid());
}

}  // namespace
}  // namespace joulepath
