#include "diagnosis/checks/dead_channels.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/checks/relations.hpp"
#include "diagnosis/numerics/rms.hpp"
#include "diagnosis/prediction/prediction.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/kinematics.hpp"

namespace joulepath {
namespace {

using Eigen::VectorXd;

VectorXd centered(const VectorXd& values) { return values.array() - values.mean(); }

VectorXd differences(const VectorXd& values) {
  const Eigen::Index n = values.size() - 1;
  return n > 0 ? VectorXd(values.tail(n) - values.head(n)) : VectorXd();
}

class Search {
 public:
  Search(const RunSignals& run, const Robot& robot)
      : run_(run), robot_(robot), expected_(expected_motors(run, robot)) {}

  std::vector<FollowedChannel> list() {
    for (Side side : kSides) wheel(side);
    if (!moves(run_)) return std::move(channels_);
    const VectorXd yaw = body_twist(robot_.geometry, run_.wheel_speed_rad_s).yaw_rate_rad_s;
    compare(run_.gyro_yaw_rate_rad_s, yaw, kMovingYawRate_rad_s, {"gyro_yaw_rate_rad_s"});
    if (run_.heading_measured)
      compare(differences(run_.heading_rad), differences(integral(yaw)), kMovingYawRate_rad_s * run_.period_s,
              {"heading_rad"});
    place();
    supply();
    return std::move(channels_);
  }

 private:
  VectorXd integral(const VectorXd& rate) const {
    VectorXd sum = rate * run_.period_s;
    for (Eigen::Index j = 1; j < sum.size(); ++j) sum[j] += sum[j - 1];
    return sum;
  }

  /// A channel with a large change of another shape is not dead; one value throughout is, where the expected
  /// value changes, whatever the value.
  void compare(const VectorXd& channel, const VectorXd& expected, double least_rms,
               std::vector<std::string> columns, bool needed = false) {
    if (channel.size() != expected.size() || channel.size() < kLeastFreeRows) return;
    FollowedChannel found{.columns = std::move(columns), .expected = rms(expected), .needed = needed};
    found.is_constant = channel.maxCoeff() - channel.minCoeff() <= kLeastSensorNoise;
    if (found.expected > 0) found.followed = channel.dot(expected) / expected.squaredNorm();
    if (found.is_constant && rms(centered(expected)) >= least_rms) {
      found.is_dead = true;
    } else if (found.expected >= least_rms) {
      found.is_dead = std::abs(found.followed) < kDeadShare && rms(channel) < kDeadSize * found.expected;
      found.is_alive = !found.is_dead && !found.is_constant;
    }
    channels_.push_back(std::move(found));
  }

  /// Compares a motor's channels with its wheel's motion, where it turns, and the wheel's speed with its
  /// voltage.
  void wheel(Side side) {
    const std::string suffix = std::string("_") + side_name(side);
    const Motor& motor = robot_.motor[side];
    const VectorXd& speed = run_.wheel_speed_rad_s[side];
    const VectorXd current = expected_.current_A(side);
    const double friction_A = motor.friction_torque_Nm / motor.torque_per_ampere_Nm_A();
    const double emf = motor.volts_per_speed_V_s_rad();
    const bool turning = wheel_turns(run_, side);
    if (turning && run_.motor_current_A[side].size() > 0)
      compare(centered(run_.motor_current_A[side]), centered(current), kLeastChange * friction_A,
              {"motor_current" + suffix + "_A"});
    const VectorXd& voltage = run_.motor_voltage_V[side];
    if (turning)
      compare(voltage, VectorXd(emf * speed + motor.resistance_ohm * current), emf * kTurningWheel_rad_s,
              {"motor_voltage" + suffix + "_V"});
    if (voltage.size() > 0)
      compare(speed, VectorXd((voltage - motor.resistance_ohm * current) / emf), kTurningWheel_rad_s,
              {"wheel_speed" + suffix + "_rad_s"}, true);
  }

  void place() {
    if (run_.x_m.size() != run_.size() || run_.y_m.size() != run_.size()) return;
    const VectorXd dx = differences(run_.x_m), dy = differences(run_.y_m);
    const VectorXd moved = (dx.array().square() + dy.array().square()).sqrt();
    const VectorXd distance_m = body_twist(robot_.geometry, run_.wheel_angle_rad).speed_m_s;
    compare(moved, differences(distance_m).cwiseAbs(), kMovingTravel_m_s * run_.period_s,
            {"position_x_m", "position_y_m"});
  }

  /// What the motion asks of the battery: means over the kernel, without the standby.
  void supply() {
    if (run_.battery_power_W.size() != run_.size()) return;
    const VectorXd motors_W =
        predict(run_, {.robot = robot_}).battery_power_W.array() - robot_.power.standby_W;
    compare(centered(run_.battery_power_W), centered(motors_W), kLeastChange * rms(motors_W),
            {run_.battery_voltage_V.cwiseAbs().maxCoeff() > 0 ? "battery_current_A" : "battery_voltage_V"});
  }

  const RunSignals& run_;
  const Robot& robot_;
  ExpectedMotors expected_;
  std::vector<FollowedChannel> channels_{};
};

}  // namespace

std::vector<FollowedChannel> followed_channels(const RunSignals& run, const Robot& robot) {
  return Search(run, robot).list();
}

std::vector<std::size_t> dead_runs(const std::map<std::size_t, FollowedChannel>& runs) {
  std::vector<std::size_t> dead, all;
  bool alive = false, varies = false, dead_vary = false;  // of the other runs, and of the dead ones
  for (const auto& [r, channel] : runs) {
    all.push_back(r);
    const bool varies_with_less = std::ranges::any_of(runs, [&own = channel](const auto& other) {
      return !other.second.is_constant && other.second.expected <= own.expected;
    });
    if (channel.is_dead || (channel.is_constant && varies_with_less))
      dead.push_back(r), dead_vary |= !channel.is_constant;
    else
      alive |= channel.is_alive, varies |= !channel.is_constant;
  }
  const bool contradicted = alive || (varies && !dead_vary);
  return dead.empty() || contradicted ? dead : all;
}

}  // namespace joulepath
