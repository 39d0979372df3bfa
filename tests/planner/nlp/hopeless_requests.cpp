#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-overflow"  // GCC 12 is wrong about copies of a std::variant
#endif

#include "tests/planner/nlp/hopeless_requests.hpp"

#include <limits>

#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::testing {

ProfileRequest straight_run(double length_m) {
  const Robot robot = nomad();
  return {.piece = straight_piece({}, length_m),
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .nodes = 80,
          .solver = SolverChoice::fast};
}

ProfileRequest run_on(PathPiece piece) {
  ProfileRequest request = straight_run();
  request.piece = std::move(piece);
  return request;
}

ProfileRequest bezier_run() {
  return run_on(Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})}));
}
ProfileRequest turn_run() { return run_on(TurnInPlace{{}, 1.5}); }

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

void set_both_motors(ProfileRequest& r, double Motor::*member, double value) {
  r.plant.robot.motor.left.*member = value;
  r.plant.robot.motor.right.*member = value;
}

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A straight run into an arc of 0.3 m radius through a clothoid.
ProfileRequest into_arc(double run_m) {
  std::vector<CurveSegment> segments{LinearCurvature({}, run_m)};
  segments.emplace_back(LinearCurvature({run_m, 0, 0}, 0.3, 0, 1 / 0.3 / 0.3));
  const Pose pose = std::get<LinearCurvature>(segments.back()).at(0.3).pose;
  segments.emplace_back(LinearCurvature(pose, 0.3, 1 / 0.3));
  return run_on(Curve(std::move(segments)));
}

ProfileRequest with_effect(ProfileRequest request, EffectSetting effect) {
  request.plant = make_plant(request.plant.robot, {std::move(effect)});
  return request;
}

}  // namespace

std::vector<HopelessRequest> hopeless_requests() {
  using R = ProfileRequest&;
  std::vector<HopelessRequest> cases;
  const auto add = [&](std::string name, ProfileRequest request, std::string constraint) {
    cases.push_back({std::move(name), std::move(request), std::move(constraint)});
  };
  // Time
  add("deadline 1 ms short", within(straight_run(), TimeMode::time_budget, minimum_s(straight_run()) - 1e-3),
      "deadline");
  add("deadline half", within(straight_run(), TimeMode::time_budget, 6), "deadline");
  add("bezier 1 ms short", within(bezier_run(), TimeMode::time_budget, minimum_s(bezier_run()) - 1e-3),
      "deadline");
  add("turn 1 ms short", within(turn_run(), TimeMode::time_budget, minimum_s(turn_run()) - 1e-3), "deadline");
  add("duration short", within(straight_run(), TimeMode::fixed_time, 11), "duration");
  add("priced, short", within(straight_run(), TimeMode::time_price, 11), "deadline");
  add("no time", within(straight_run(), TimeMode::time_budget, 0), "deadline");
  add("negative time", within(straight_run(), TimeMode::fixed_time, -3), "duration");
  add("tiny time", within(straight_run(), TimeMode::time_budget, 1e-9), "deadline");
  add("NaN time", within(straight_run(), TimeMode::time_budget, kNaN), "deadline");
  add("too long at speed",
      changed(within(straight_run(0.5), TimeMode::fixed_time, 60),
              [](R r) { r.start_rate = r.end_rate = 0.9; }),
      "duration");
  // Start and end speeds
  add("start not shed", changed(straight_run(0.5), [](R r) { r.start_rate = 1; }), "start_speed");
  add("end not reached", changed(straight_run(0.5), [](R r) { r.end_rate = 1; }), "end_speed");
  add("start above limit", changed(straight_run(), [](R r) { r.start_rate = 1.2; }), "start_speed");
  add("end above limit", changed(straight_run(), [](R r) { r.end_rate = 1.2; }), "end_speed");
  add("start not shed before the curve", changed(into_arc(0.2), [](R r) { r.start_rate = 0.95; }),
      "start_speed");
  add("end too fast for the arc", changed(into_arc(2), [](R r) { r.end_rate = 0.9; }), "end_speed");
  add("start not shed before the zone",
      changed(straight_run(),
              [](R r) {
                r.start_rate = 1, r.speed_caps = {{0.3, 4, 0.2}};
              }),
      "start_speed");
  add("end above its zone",
      changed(straight_run(),
              [](R r) {
                r.end_rate = 0.8, r.speed_caps = {{8, 10, 0.2}};
              }),
      "end_speed");
  add("negative start", changed(straight_run(), [](R r) { r.start_rate = -1; }), "start_speed");
  add("NaN start", changed(straight_run(), [](R r) { r.start_rate = kNaN; }), "start_speed");
  add("infinite end", changed(straight_run(), [](R r) { r.end_rate = kNoLimit; }), "start_speed");
  // Limits of zero
  add("speed 0", changed(straight_run(), [](R r) { r.limits.speed_m_s = 0; }), "speed");
  add("acceleration 0", changed(straight_run(), [](R r) { r.limits.acceleration_m_s2 = 0; }), "acceleration");
  add("deceleration 0", changed(straight_run(), [](R r) { r.limits.deceleration_m_s2 = 0; }), "deceleration");
  add("lateral 0", changed(bezier_run(), [](R r) { r.limits.lateral_acceleration_m_s2 = 0; }),
      "lateral_acceleration");
  add("yaw rate 0 on a curve", changed(bezier_run(), [](R r) { r.limits.yaw_rate_rad_s = 0; }), "yaw_rate");
  add("yaw rate 0 in a turn", changed(turn_run(), [](R r) { r.limits.yaw_rate_rad_s = 0; }), "yaw_rate");
  add("yaw acceleration 0 in a turn", changed(turn_run(), [](R r) { r.limits.yaw_acceleration_rad_s2 = 0; }),
      "yaw_acceleration");
  add("wheel acceleration 0", changed(straight_run(), [](R r) { r.limits.wheel_acceleration_rad_s2 = 0; }),
      "wheel_acceleration");
  add("traction 0", changed(straight_run(), [](R r) { r.limits.traction_coefficient = 0; }), "traction");
  add("motor power 0", changed(straight_run(), [](R r) { r.limits.motor_power_W = 0; }), "motor_power");
  add("battery power 0", changed(straight_run(), [](R r) { r.limits.battery_power_W = 0; }), "battery_power");
  add("current 0", changed(straight_run(), [](R r) { set_both_motors(r, &Motor::max_current_A, 0); }),
      "motor_current");
  add("voltage 0", changed(straight_run(), [](R r) { set_both_motors(r, &Motor::max_voltage_V, 0); }),
      "motor_voltage");
  add("jerk 0", changed(straight_run(), [](R r) { r.limits.jerk_m_s3 = 0; }), "jerk");
  add("negative jerk", changed(bezier_run(), [](R r) { r.limits.jerk_m_s3 = -1; }), "limits");
  add("NaN current", changed(straight_run(), [](R r) { r.plant.robot.motor.right.max_current_A = kNaN; }),
      "limits");
  add("jerk 0 and a deadline",
      changed(within(straight_run(), TimeMode::time_budget, 20), [](R r) { r.limits.jerk_m_s3 = 0; }),
      "jerk");
  add("zone of 0", changed(straight_run(), [](R r) { r.speed_caps = {{4, 5, 0}}; }), "speed");
  // Too weak
  add("battery below standby", changed(straight_run(), [](R r) { r.limits.battery_power_W = 9; }),
      "battery_power");
  add("current below friction",
      changed(straight_run(), [](R r) { set_both_motors(r, &Motor::max_current_A, 0.15); }), "motor_current");
  add("voltage below friction",
      changed(straight_run(), [](R r) { set_both_motors(r, &Motor::max_voltage_V, 0.4); }), "motor_voltage");
  add("motor power below copper loss", changed(straight_run(), [](R r) { r.limits.motor_power_W = 0.05; }),
      "motor_power");
  add("turn, weak motors", changed(turn_run(), [](R r) { set_both_motors(r, &Motor::max_current_A, 0.15); }),
      "motor_current");
  add("slope too steep",
      with_effect(changed(straight_run(), [](R r) { set_both_motors(r, &Motor::max_current_A, 1.5); }),
                  {.name = "floor_slope", .parameters = {{"grade", 0.3}, {"uphill_direction_rad", 0}}}),
      "motor_current");
  add("slope too slippery",
      with_effect(changed(straight_run(), [](R r) { r.limits.traction_coefficient = 0.1; }),
                  {.name = "floor_slope", .parameters = {{"grade", 0.3}, {"uphill_direction_rad", 0}}}),
      "traction");
  add("patch too rough",
      with_effect(
          changed(straight_run(), [](R r) { set_both_motors(r, &Motor::max_current_A, 1); }),
          {.name = "floor_patch",
           .parameters =
               {{"coefficient", 0.4}, {"x_min_m", 4}, {"x_max_m", 6}, {"y_min_m", -1}, {"y_max_m", 1}}}),
      "motor_current");
  add("dragging wheel",
      with_effect(changed(straight_run(), [](R r) { set_both_motors(r, &Motor::max_current_A, 1); }),
                  {.name = "dragging_wheel", .parameters = {{"torque_Nm", 5}}, .side = Side::left}),
      "motor_current");
  // Nonsense
  add("turn by nothing", run_on(TurnInPlace{{}, 0}), "path");
  add("turn by NaN", run_on(TurnInPlace{{}, kNaN}), "path");
  add("NaN limit", changed(straight_run(), [](R r) { r.limits.speed_m_s = kNaN; }), "limits");
  add("negative limit", changed(straight_run(), [](R r) { r.limits.acceleration_m_s2 = -1; }), "limits");
  add("NaN payload", changed(straight_run(), [](R r) { r.payload = {kNaN, kNaN}; }), "payload");
  return cases;
}

}  // namespace joulepath::testing
