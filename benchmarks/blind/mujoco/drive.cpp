// The plant's drive() in MuJoCo [Todorov2012]: the same commands and sensors, other bodies, contacts and time stepping.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "mjcf.hpp"
#include "plant.hpp"

namespace blind {
namespace {

constexpr double kSettle_s = 0.3;

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

std::unique_ptr<mjModel, ModelDeleter> compile(const std::string& text) {
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "robot.xml", static_cast<int>(text.size() + 1));
  std::memcpy(files->filedata[0], text.c_str(), text.size() + 1);
  std::array<char, 500> error{};
  std::unique_ptr<mjModel, ModelDeleter> model(
      mj_loadXML("robot.xml", files.get(), error.data(), static_cast<int>(error.size())));
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(std::string("MJCF: ") + error.data());
  return model;
}

/// The robot in MuJoCo with its controller, battery and the sums that the sensors average.
class Robot {
 public:
  Robot(const Machine& truth, const Machine& nominal, const World& world, const Run& run)
      : truth_(truth),
        nominal_(nominal),
        run_(run),
        model_(compile(mjcf_text(truth, world, run))),
        data_(mj_makeData(model_.get())),
        battery_V_(truth.open_circuit_voltage_V) {
    for (std::size_t side = 0; side < 2; ++side) {
      const int joint = mj_name2id(model_.get(), mjOBJ_JOINT, side == kLeft ? "left" : "right");
      angle_[side] = model_->jnt_qposadr[joint];
      speed_[side] = model_->jnt_dofadr[joint];
    }
    for (int k = 0; k < std::lround(kSettle_s / kPhysicsStep_s); ++k) mj_step(model_.get(), data_.get());
    heading_before_rad_ = heading_rad_ = raw_heading_rad();
    for (std::size_t side = 0; side < 2; ++side) start_rad_[side] = data_->qpos[angle_[side]];
  }

  /// The controller's tick: PI on wheel speed.
  void control(std::size_t tick) {
    for (std::size_t side = 0; side < 2; ++side) {
      const double outward = side == kLeft ? -1 : 1;
      const double wanted =
          (run_.speed_m_s[tick] + outward * nominal_.half_track_m * run_.yaw_rate_rad_s[tick]) /
          nominal_.wheel_radius_m[side];
      const double K = nominal_.torque_per_ampere_Nm_A(), angle = wheel_rad(side);
      const double seen = (angle - seen_rad_[side]) / kControlPeriod_s, error = wanted - seen;
      seen_rad_[side] = angle;
      const bool at_rest = wanted == 0 && std::abs(seen) < 0.05;
      integral_V_[side] =
          at_rest ? 0.8 * integral_V_[side] : integral_V_[side] + 8.0 * K * error * kControlPeriod_s;
      const double volts = K * wanted + integral_V_[side] + (at_rest ? 0.0 : 1.2 * K * error);
      const double limit = std::min(truth_.max_voltage_V, battery_V_);
      data_->ctrl[side] = std::clamp(volts, -limit, limit);
    }
  }

  void step(Sample& sum) {
    mj_step(model_.get(), data_.get());
    double power_W = truth_.standby_W;
    for (std::size_t side = 0; side < 2; ++side) {
      const double volts = data_->ctrl[side];
      const double amperes =
          (volts - truth_.torque_per_ampere_Nm_A() * data_->qvel[speed_[side]]) / truth_.resistance_ohm[side];
      power_W += volts * amperes > 0 ? volts * amperes : truth_.regeneration_efficiency * volts * amperes;
      sum.motor_voltage_V[side] += volts;
      sum.motor_current_A[side] += amperes;
      sum.true_power_W[side] += volts * amperes;
    }
    const double battery_A = power_W / battery_V_;
    battery_V_ = truth_.open_circuit_voltage_V - truth_.internal_resistance_ohm * battery_A;
    sum.battery_current_A += battery_A;
    sum.battery_voltage_V += battery_V_;
    heading_rad_ += std::remainder(raw_heading_rad() - heading_rad_, 2 * std::numbers::pi);
  }

  /// The sample that ends now: sums become means.
  Sample finished(Sample sum, double time_s, double steps) {
    sum.time_s = time_s;
    for (std::size_t side = 0; side < 2; ++side) {
      sum.wheel_speed_rad_s[side] = (wheel_rad(side) - before_rad_[side]) / kSamplePeriod_s;
      before_rad_[side] = wheel_rad(side);
      sum.motor_voltage_V[side] /= steps;
      sum.motor_current_A[side] /= steps;
      sum.true_power_W[side] /= steps;
    }
    sum.battery_voltage_V /= steps;
    sum.battery_current_A /= steps;
    sum.gyro_rad_s = (heading_rad_ - heading_before_rad_) / kSamplePeriod_s;
    heading_before_rad_ = heading_rad_;
    sum.x_m = data_->qpos[0];
    sum.y_m = data_->qpos[1];
    sum.heading_rad = heading_rad_;
    return sum;
  }

 private:
  double wheel_rad(std::size_t side) const { return data_->qpos[angle_[side]] - start_rad_[side]; }
  double raw_heading_rad() const {
    const mjtNum* q = data_->qpos + 3;
    return std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
  }

  const Machine& truth_;
  const Machine& nominal_;
  const Run& run_;
  std::unique_ptr<mjModel, ModelDeleter> model_;
  std::unique_ptr<mjData, DataDeleter> data_;
  double battery_V_{}, heading_rad_{}, heading_before_rad_{};
  std::array<int, 2> angle_{}, speed_{};
  Pair start_rad_{}, seen_rad_{}, before_rad_{}, integral_V_{};
};

}  // namespace

std::vector<Sample> drive(const Machine& truth, const Machine& nominal, const World& world, const Run& run,
                          const Discretization&) {
  const auto steps_per_tick = static_cast<int>(std::lround(kControlPeriod_s / kPhysicsStep_s));
  const auto ticks_per_sample = static_cast<std::size_t>(std::lround(kSamplePeriod_s / kControlPeriod_s));
  Robot robot(truth, nominal, world, run);
  std::vector<Sample> log;
  Sample sum;
  for (std::size_t tick = 0; tick < run.speed_m_s.size(); ++tick) {
    robot.control(tick);
    for (int k = 0; k < steps_per_tick; ++k) robot.step(sum);
    if ((tick + 1) % ticks_per_sample != 0) continue;
    log.push_back(
        robot.finished(sum, static_cast<double>(tick + 1) * kControlPeriod_s,
                       static_cast<double>(steps_per_tick) * static_cast<double>(ticks_per_sample)));
    sum = Sample{};
  }
  return log;
}

}  // namespace blind
