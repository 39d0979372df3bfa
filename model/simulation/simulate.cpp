#include "model/simulation/simulate.hpp"

#include <algorithm>
#include <cmath>

#include "model/simulation/reference.hpp"

namespace joulepath {
namespace {

constexpr double kSameInstant_s = 1e-9;

DriveState start_state(const Plant& plant, const BodyMotion<double>& motion, const Pose& pose) {
  DriveState state{};
  state[kX] = pose.x_m;
  state[kY] = pose.y_m;
  state[kYaw] = pose.heading_rad;
  state[kVelocity + kTravel] = motion.speed_m_s;
  state[kVelocity + kTurn] = motion.yaw_rate_rad_s;
  const Sided<double> wheels =
      wheel_speeds_rad_s(plant.robot.geometry, motion.speed_m_s, motion.yaw_rate_rad_s);
  state[kVelocity + kLeftWheel] = wheels.left;
  state[kVelocity + kRightWheel] = wheels.right;
  return state;
}

/// One run: the loop of control periods and samples.
class Run {
 public:
  explicit Run(const SimulationRequest& request)
      : request_(request),
        reference_(request.robot.geometry, request.reference),
        controller_(request.controller, request.robot),
        plant_(make_plant(request.robot, request.effects)),
        integrator_(Drive(plant_, request.time_of_day_s),
                    start_state(plant_, reference_.motion(reference_.start_s()), request.start),
                    request.integrator) {
    reference_.start_at(request.start);
  }

  void drive() {
    const double length_s = reference_.end_s() - reference_.start_s();
    const double sample_s = 1 / request_.sensors.sample_rate_Hz;
    std::size_t tick = 0;
    std::size_t sample = 0;
    for (double end_s = length_s;;) {
      const double t = integrator_.time_s();
      if (t > tick * request_.controller.period_s - kSameInstant_s) {
        control(t);
        ++tick;
      }
      if (t > sample * sample_s - kSameInstant_s) {
        record(t);
        ++sample;
        if (t > end_s - kSameInstant_s &&
            (!reference_.ends_at_rest() || integrator_.at_rest() || t > length_s + request_.settle_s))
          break;
      }
      integrator_.advance_to(std::min(tick * request_.controller.period_s, sample * sample_s));
    }
    ticks_ = tick;
  }

  SimulationResult result() {
    SimulationResult result;
    const DriveState& state = integrator_.state();
    result.log = read_sensors(truth_, request_.sensors, has_battery(), request_.seed);
    for (double& time_s : result.log.time_s) time_s += reference_.start_s();
    distort_log(instruments(), result.log);
    result.executed = executed();
    result.duration_s = integrator_.time_s();
    result.motor_energy_J = {state[kEnergy], state[kEnergy + 1]};
    result.energy_J = state[kBatteryEnergy];
    result.battery_loss_J = state[kBatteryLoss];
    result.balance = {.motors_J = state[kEnergy] + state[kEnergy + 1],
                      .copper_J = state[kCopperLoss],
                      .driver_J = state[kDriverLoss],
                      .gear_J = state[kGearLoss],
                      .wheel_friction_J = state[kWheelFriction],
                      .body_work_J = state[kBodyWork],
                      .creep_J = state[kCreepLoss],
                      .stored_J = integrator_.drive().stored_energy_J(state) -
                                  integrator_.drive().stored_energy_J(truth_.front().state)};
    result.final_pose = {state[kX], state[kY], state[kYaw]};
    result.planned_pose = reference_.pose(reference_.end_s());
    result.worst_speed_error_rad_s = worst_error_rad_s_;
    result.saturated_fraction =
        ticks_ > 0 ? static_cast<double>(saturated_) / static_cast<double>(ticks_) : 0;
    result.battery_gave_way = integrator_.battery_gave_way();
    result.came_to_rest = integrator_.at_rest();
    result.steps = integrator_.steps();
    result.events = integrator_.events();
    return result;
  }

 private:
  bool has_battery() const { return std::isfinite(plant_.robot.battery.open_circuit_voltage_V); }

  std::vector<Effect> instruments() const {
    std::vector<Effect> all;
    for (const EffectSetting& setting : plant_.robot.effects) all.push_back(make_effect(setting));
    return all;
  }

  bool coasts_at(double time_s) const {
    return std::any_of(request_.coasting.begin(), request_.coasting.end(), [&](const Interval& interval) {
      return time_s >= interval.from_s && time_s < interval.to_s;
    });
  }

  /// The reference in the middle of the coming period, so that the held values match the period's mean.
  void control(double t) {
    const double now_s = reference_.start_s() + t;
    const double middle_s = now_s + request_.controller.period_s / 2;
    const BodyMotion<double> motion = reference_.motion(middle_s);
    const double payload_kg =
        request_.reference.payload_kg.empty() ? request_.payload_kg : reference_.payload_kg(now_s);
    const Site site = site_of(request_.robot.geometry, reference_.pose(middle_s), payload_kg,
                              motion.speed_m_s, motion.yaw_rate_rad_s, request_.time_of_day_s + t);
    const DriveState& state = integrator_.state();
    const Sided<double> wheel_rad_s{state[kVelocity + kLeftWheel], state[kVelocity + kRightWheel]};
    const double battery_V = truth_.empty() ? plant_.robot.battery.open_circuit_voltage_V
                                            : integrator_.instant().battery_voltage_V;
    const Sided<double> limit_V{std::min(battery_V, plant_.robot.motor.left.max_voltage_V),
                                std::min(battery_V, plant_.robot.motor.right.max_voltage_V)};
    DriveInput input{.coasting = coasts_at(now_s), .payload_kg = payload_kg};
    if (input.coasting) {
      controller_.release();
    } else {
      input.voltage_V = controller_.command_V(motion, site, wheel_rad_s, limit_V);
      judge(now_s, wheel_rad_s, input, limit_V);
    }
    command_ = {motion.speed_m_s, motion.yaw_rate_rad_s};
    integrator_.drive().set_input(input);
  }

  void judge(double now_s, const Sided<double>& wheel_rad_s, const DriveInput& input,
             const Sided<double>& limit_V) {
    const BodyMotion<double> now = reference_.motion(now_s);
    const Sided<double> wanted =
        wheel_speeds_rad_s(request_.robot.geometry, now.speed_m_s, now.yaw_rate_rad_s);
    bool saturated = false;
    for (Side side : kSides) {
      worst_error_rad_s_ = std::max(worst_error_rad_s_, std::abs(wanted[side] - wheel_rad_s[side]));
      saturated |= std::abs(input.voltage_V[side]) >= limit_V[side];
    }
    saturated_ += saturated;
  }

  void record(double t) {
    truth_.push_back({.time_s = t,
                      .state = integrator_.state(),
                      .instant = integrator_.instant(),
                      .command_speed_m_s = command_.speed_m_s,
                      .command_yaw_rate_rad_s = command_.yaw_rate_rad_s,
                      .payload_kg = integrator_.drive().input().payload_kg});
  }

  Trajectory executed() const {
    Trajectory t;
    for (const Snapshot& s : truth_) {
      t.time_s.push_back(reference_.start_s() + s.time_s);
      t.linear_speed_m_s.push_back(s.state[kVelocity + kTravel]);
      t.angular_speed_rad_s.push_back(s.state[kVelocity + kTurn]);
      for (Side side : kSides) {
        t.wheel_speed_rad_s[side].push_back(s.state[kVelocity + surface_of(side)]);
        t.motor_voltage_V[side].push_back(s.instant.voltage_V[side]);
        t.motor_current_A[side].push_back(s.instant.current_A[side]);
        t.motor_power_W[side].push_back(s.instant.voltage_V[side] * s.instant.current_A[side]);
      }
      t.position_x_m.push_back(s.state[kX]);
      t.position_y_m.push_back(s.state[kY]);
      t.heading_rad.push_back(s.state[kYaw]);
      t.payload_kg.push_back(s.payload_kg);
      t.battery_power_W.push_back(s.instant.derivative[kBatteryEnergy]);
      t.energy_J.push_back(s.state[kBatteryEnergy]);
    }
    return t;
  }

  const SimulationRequest& request_;
  Reference reference_;
  WheelController controller_;
  Plant plant_;
  DriveIntegrator integrator_;
  std::vector<Snapshot> truth_{};
  Twist<double> command_{};
  double worst_error_rad_s_{};
  std::size_t saturated_{};
  std::size_t ticks_{};
};

}  // namespace

SimulationResult simulate(const SimulationRequest& request) {
  Run run(request);
  run.drive();
  return run.result();
}

}  // namespace joulepath
