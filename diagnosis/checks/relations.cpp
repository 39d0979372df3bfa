#include "diagnosis/checks/relations.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/checks/box_fit.hpp"
#include "diagnosis/numerics/rms.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/dynamics.hpp"
#include "model/kinematics.hpp"
#include "model/mean_power.hpp"
#include "model/motor.hpp"
// Design: docs/decisions/0500-data-checks.md
namespace joulepath {
namespace {

using Eigen::VectorXd;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool has(const RunSignals& run, const VectorXd& channel) {
  return channel.size() == run.size() && run.size() > 0;
}

VectorXd directions(const VectorXd& speed) {
  return speed.unaryExpr([](double each) { return friction_direction(each); });
}

VectorXd increments(const VectorXd& values) {
  const Eigen::Index n = values.size() - kIncrementRows;
  return n > 0 ? VectorXd(values.tail(n) - values.head(n)) : VectorXd();
}

/// Distance (m) and angle (rad) of the body over the increments of the wheels' angles.
Twist<VectorXd> rolled(const Geometry& geometry, const Sided<VectorXd>& angle_rad) {
  return body_twist(geometry, Sided<VectorXd>{increments(angle_rad.left), increments(angle_rad.right)});
}

VectorXd stacked(const VectorXd& a, const VectorXd& b) {
  VectorXd both(a.size() + b.size());
  both << a, b;
  return both;
}

/// A coefficient that is 1 where the robot file is right.
BoxedTerm factor(VectorXd value, double least, double most, double freedom) {
  return {std::move(value), std::pow(least, freedom), std::pow(most, freedom)};
}

/// Shares of the sum of squares that a law leaves unexplained in a sound and in a doubtful log.
struct Bounds {
  double sound{}, doubtful{};
};
constexpr Bounds kWinding{kSoundWinding, kDoubtfulWinding}, kTorque{kSoundTorque, kSoundTorque},
    kMotion{kSoundMotion, kSoundMotion}, kBattery{kSoundBattery, kDoubtfulBattery};

/// None with too few rows: coefficients explain as many rows exactly, whatever the channels are.
std::optional<Relation> relation(std::string law, const Bounds& bounds, const VectorXd& explained,
                                 const std::vector<BoxedTerm>& terms) {
  if (explained.size() < static_cast<Eigen::Index>(terms.size()) + kLeastFreeRows) return {};
  return Relation{std::move(law), fit_in_box(explained, terms).unexplained, bounds.sound, bounds.doubtful};
}

/// V = R i + Kv n q'. The constant term models a sensor offset, the sign term a driver's voltage drop, the
/// acceleration term delayed readings.
std::optional<Relation> winding(const RunSignals& run, const Robot& robot, const ExpectedMotors& expected,
                                Side side, double freedom) {
  const VectorXd& voltage = run.motor_voltage_V[side];
  if (!has(run, voltage) || !wheel_turns(run, side)) return {};
  const Motor& motor = robot.motor[side];
  const bool measured = has(run, run.motor_current_A[side]);
  const VectorXd current = measured ? run.motor_current_A[side] : expected.current_A(side);
  const double emf = motor.volts_per_speed_V_s_rad();
  const double offset_V =
      kGreatestOffset * motor.resistance_ohm * motor.friction_torque_Nm / motor.torque_per_ampere_Nm_A();
  const double drop_V = kGreatestDrop * voltage.cwiseAbs().maxCoeff();
  const VectorXd& speed = run.wheel_speed_rad_s[side];
  return relation(
      std::string("V = R i + Kv n w ") + side_name(side), kWinding, voltage,
      {factor(motor.resistance_ohm * current, measured ? kLeastMeasuredFactor : kLeastPredictedFactor,
              measured ? kMostMeasuredFactor : kMostPredictedCurrent, freedom),
       factor(emf * speed, kLeastScale, kMostScale, freedom),
       {VectorXd::Ones(run.size()), -offset_V, offset_V},
       {directions(speed), -drop_V, drop_V},
       {emf * run.wheel_acceleration_rad_s2[side], -kLongestDelay_s, kLongestDelay_s}});
}

/// Measured current against the current that friction and inertia require. Resistances and loads may be
/// several times those of the robot file; their signs are certain.
std::optional<Relation> mechanics(const RunSignals& run, const Robot& robot, const ExpectedMotors& expected,
                                  Side side, double freedom) {
  const VectorXd& current = run.motor_current_A[side];
  if (!has(run, current) || !wheel_turns(run, side)) return {};
  const Motor& motor = robot.motor[side];
  const double friction_A = motor.friction_torque_Nm / motor.torque_per_ampere_Nm_A();
  const VectorXd yaw = body_twist(robot.geometry, run.wheel_speed_rad_s).yaw_rate_rad_s;
  const double load_A = robot.geometry.wheel_radius_m[side] * kGravity_m_s2 * robot.total_mass_kg(0) / 2 /
                        motor.torque_per_ampere_Nm_A();
  std::vector<BoxedTerm> terms{
      factor(expected.friction_A[side], kLeastFriction, kMostFriction, freedom),
      {expected.viscous_A[side], 0.0, kMostTorquePerSpeed},
      factor(expected.inertia_A[side], kLeastInertia, kMostInertia, freedom),
      {VectorXd::Ones(run.size()), -kGreatestOffset * friction_A, kGreatestOffset * friction_A},
      {directions(yaw * 2), -kGreatestTurningLoad * load_A, kGreatestTurningLoad * load_A}};
  if (run.heading_measured && has(run, run.heading_rad)) {
    terms.push_back({run.heading_rad.array().cos(), -kGreatestSlope * load_A, kGreatestSlope * load_A});
    terms.push_back({run.heading_rad.array().sin(), -kGreatestSlope * load_A, kGreatestSlope * load_A});
  }
  return relation(std::string("i = torque of the motion / (Kt n) ") + side_name(side), kTorque, current,
                  terms);
}

std::optional<Relation> gyro_and_wheels(const RunSignals& run, const Geometry& geometry, double freedom) {
  if (!has(run, run.gyro_yaw_rate_rad_s)) return {};
  const Twist<VectorXd> wheels = body_twist(geometry, run.wheel_speed_rad_s);
  const VectorXd& yaw = wheels.yaw_rate_rad_s;
  if (std::max(rms(yaw), rms(run.gyro_yaw_rate_rad_s)) < kLeastYawRate_rad_s) return {};
  const double mismatch = kGreatestMismatch / (2 * geometry.half_track_m);
  return relation("gyro = yaw rate of the wheels", kMotion, run.gyro_yaw_rate_rad_s,
                  {factor(yaw, kLeastRolled, kMostRolled, freedom),
                   {wheels.speed_m_s, -mismatch, mismatch},
                   {VectorXd::Ones(run.size()), -kGreatestGyroBias_rad_s, kGreatestGyroBias_rad_s}});
}

std::optional<Relation> heading_and_wheels(const RunSignals& run, const Geometry& geometry, double freedom) {
  if (!run.heading_measured || !has(run, run.heading_rad)) return {};
  const Twist<VectorXd> wheels = rolled(geometry, run.wheel_angle_rad);
  const VectorXd& turned = wheels.yaw_rate_rad_s;
  const VectorXd heading = increments(run.heading_rad);
  const double least = kLeastYawRate_rad_s * run.period_s * kIncrementRows;
  if (heading.size() == 0 || std::max(rms(turned), rms(heading)) < least) return {};
  const double mismatch = kGreatestMismatch / (2 * geometry.half_track_m);
  return relation(
      "heading = angle turned by the wheels", kMotion, heading,
      {factor(turned, kLeastRolled, kMostRolled, freedom), {wheels.speed_m_s, -mismatch, mismatch}});
}

std::optional<Relation> heading_and_gyro(const RunSignals& run, double freedom) {
  if (!run.heading_measured || !has(run, run.heading_rad) || !has(run, run.gyro_yaw_rate_rad_s)) return {};
  VectorXd angle(run.size());
  double sum = 0;
  for (Eigen::Index j = 0; j < run.size(); ++j) angle[j] = sum += run.gyro_yaw_rate_rad_s[j] * run.period_s;
  const VectorXd turned = increments(angle), heading = increments(run.heading_rad);
  const double span_s = run.period_s * kIncrementRows;
  if (heading.size() == 0 || std::max(rms(turned), rms(heading)) < kLeastYawRate_rad_s * span_s) return {};
  return relation(
      "heading = angle turned by the gyro", kMotion, heading,
      {factor(turned, kLeastScale, kMostScale, freedom),
       {VectorXd::Constant(turned.size(), span_s), -kGreatestGyroBias_rad_s, kGreatestGyroBias_rad_s}});
}

/// Compares motion along the measured heading; without a heading, distances only.
std::optional<Relation> position_and_wheels(const RunSignals& run, const Geometry& geometry, double freedom) {
  if (!has(run, run.x_m) || !has(run, run.y_m)) return {};
  const VectorXd dx = increments(run.x_m), dy = increments(run.y_m);
  const double least_m = kLeastSpeed_m_s * run.period_s * kIncrementRows;
  if (dx.size() == 0) return {};
  const VectorXd distance = rolled(geometry, run.wheel_angle_rad).speed_m_s;
  if (rms(distance) < least_m && rms(stacked(dx, dy)) < least_m) return {};
  if (!run.heading_measured)
    return relation("distance = path of the wheels", kMotion,
                    (dx.array().square() + dy.array().square()).sqrt().matrix(),
                    {factor(distance.cwiseAbs(), kLeastRolled, kMostRolled, freedom)});
  const VectorXd x = rolled(geometry, run.wheel_along_x_rad).speed_m_s;
  const VectorXd y = rolled(geometry, run.wheel_along_y_rad).speed_m_s;
  return relation("position = path of the wheels along the heading", kMotion, stacked(dx, dy),
                  {factor(stacked(x, y), kLeastRolled, kMostRolled, freedom),
                   {stacked(-y, x), -kGreatestHeadingOffset_rad, kGreatestHeadingOffset_rad}});
}

/// How much each sample changes within the smoothing kernel (1 sigma).
VectorXd kernel_change(const RunSignals& run, const VectorXd& values) {
  const Eigen::Index last = values.size() - 1;
  VectorXd change = VectorXd::Zero(values.size());
  for (Eigen::Index j = 0; j <= last; ++j) {
    const Eigen::Index before = std::max<Eigen::Index>(j - 1, 0), after = std::min(j + 1, last);
    if (after > before)
      change[j] =
          run.kernel_sigma_s * (values[after] - values[before]) / (run.time_s[after] - run.time_s[before]);
  }
  return change;
}

/// What the motors draw and return by the motion alone.
SupplyAccount expected_account(const RunSignals& run, const Robot& robot, const ExpectedMotors& expected) {
  SupplyAccount account{VectorXd::Zero(run.size()), VectorXd::Zero(run.size()), {}};
  for (Side side : kSides) {
    const VectorXd current = expected.current_A(side),
                   voltage = robot.motor[side].resistance_ohm * current +
                             robot.motor[side].volts_per_speed_V_s_rad() * run.wheel_speed_rad_s[side];
    const VectorXd power =
        voltage.cwiseProduct(current) + kernel_change(run, voltage).cwiseProduct(kernel_change(run, current));
    account.draw_W += power.binaryExpr(kernel_change(run, power), &mean_positive_W);
    account.return_W += power;
  }
  account.return_W -= account.draw_W;
  return account;
}

/// Battery power = motor power + standby. Without measured motors, the factor of the predicted motor power
/// may be large.
std::optional<Relation> battery(const RunSignals& run, const Robot& robot, const ExpectedMotors& expected,
                                double freedom) {
  if (!has(run, run.battery_power_W) || !moves(run)) return {};
  const bool measured = has(run, run.motor_power_W.left) && has(run, run.motor_power_W.right);
  const SupplyAccount motors = measured ? run.motors_at_supply : expected_account(run, robot, expected);
  const double least = measured ? kLeastMeasuredFactor : kLeastPredictedFactor,
               most = measured ? kMostMeasuredFactor : kMostPredictedPower;
  const double standby_W = robot.power.standby_W > 0 ? kMostStandby * robot.power.standby_W : kInfinity;
  return relation("battery power = motor power + standby",
                  measured ? kBattery : Bounds{kSoundBattery, kSoundBattery}, run.battery_power_W,
                  {factor(motors.draw_W, least, most, freedom),
                   {motors.return_W, -kGreatestBrakeDraw, kGreatestBrakeFactor * most},
                   {VectorXd::Ones(run.size()), 0.0, standby_W}});
}

/// The battery's voltage is of the order of the file's: the power alone does not tell its unit from the
/// current's.
std::optional<Relation> supply(const RunSignals& run, const Robot& robot, double freedom) {
  const double open_V = robot.battery.open_circuit_voltage_V;
  if (!has(run, run.battery_voltage_V) || !std::isfinite(open_V)) return {};
  return relation("battery voltage = open-circuit voltage", {kSoundBattery, kSoundBattery},
                  run.battery_voltage_V,
                  {factor(VectorXd::Constant(run.size(), open_V), kLeastPredictedFactor,
                          1 / kLeastPredictedFactor, freedom)});
}

}  // namespace

bool wheel_turns(const RunSignals& run, Side side) {
  return rms(run.wheel_speed_rad_s[side]) >= kBlurredWheel_rad_s;
}

bool moves(const RunSignals& run) { return wheel_turns(run, Side::left) || wheel_turns(run, Side::right); }

ExpectedMotors expected_motors(const RunSignals& run, const Robot& robot) {
  ExpectedMotors expected;
  for (Side side : kSides)
    for (VectorXd* part : {&expected.friction_A[side], &expected.viscous_A[side], &expected.inertia_A[side]})
      *part = VectorXd::Zero(run.size());
  for (Eigen::Index j = 0; j < run.size(); ++j) {
    const Wrench<double> wrench =
        inertial_wrench(mass_properties(robot, run.payload_kg[j]), run.rolled_motion(robot.geometry, j));
    const Sided<double> force_N = contact_forces_N(robot.geometry.half_track_m, wrench);
    for (Side side : kSides) {
      const Motor& motor = robot.motor[side];
      const double speed = run.wheel_speed_rad_s[side][j];
      const double torque_Nm =
          robot.geometry.wheel_radius_m[side] * force_N[side] +
          robot.inertia.wheel_axle_inertia_kg_m2 * run.wheel_acceleration_rad_s2[side][j];
      expected.inertia_A[side][j] = motor_current_A(motor, torque_Nm);
      expected.viscous_A[side][j] = motor_current_A(motor, motor.viscous_friction_Nm_s_rad * speed);
      expected.friction_A[side][j] =
          motor_current_A(motor, motor.friction_torque_Nm * run.direction(side, j));
    }
  }
  return expected;
}

Relations relations_of(const RunSignals& run, const Robot& robot, double freedom) {
  const ExpectedMotors expected = expected_motors(run, robot);
  const Geometry& geometry = robot.geometry;
  return {winding(run, robot, expected, Side::left, freedom),
          winding(run, robot, expected, Side::right, freedom),
          mechanics(run, robot, expected, Side::left, freedom),
          mechanics(run, robot, expected, Side::right, freedom),
          gyro_and_wheels(run, geometry, freedom),
          heading_and_wheels(run, geometry, freedom),
          heading_and_gyro(run, freedom),
          position_and_wheels(run, geometry, freedom),
          battery(run, robot, expected, freedom),
          supply(run, robot, freedom)};
}

}  // namespace joulepath
