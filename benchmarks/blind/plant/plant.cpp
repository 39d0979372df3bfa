#include "plant.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace blind {
namespace {

constexpr double kEdgesPerRad = 8000.0;  // encoder on the motor shaft, seen at the wheel
constexpr double kPwmSteps = 4096.0;     // over twice the supply voltage
constexpr double kScrubPresliding_rad = 0.004;

double sign_of(double x) { return x > 0 ? 1.0 : (x < 0 ? -1.0 : 0.0); }

/// One LuGre bristle: `level` is the friction it reaches when it slides, `z` its deflection in units of the
/// presliding length (steady sliding: z = sign of the speed).
struct Bristle {
  double z{};
  double force(double level, double speed, double presliding, double dt) {
    const double rate = std::abs(speed) / presliding;
    const double before = z;
    z = (z + dt * speed / presliding) / (1.0 + dt * rate);
    constexpr double kDamping_s = 0.003;  // of the bristle's own motion: gone once it slides
    return level * (z + std::clamp(kDamping_s * (z - before) / dt, -0.2, 0.2));
  }
};

struct Wheel {
  double angle_rad{}, speed_rad_s{}, current_A{}, voltage_V{}, commanded_V{};
  double integral_V{};
  double seen_angle_rad{};  // at the controller's last tick
  double since_stop_rad{};  // angle travelled since standstill
  double stopped_s{};
  Bristle bristle{};
};

/// The state of the whole machine and one step of it.
class Plant {
 public:
  Plant(const Machine& truth, const Machine& nominal, const World& world, const Run& run,
        const Discretization& d)
      : m_(truth), nominal_(nominal), w_(world), run_(run), d_(d) {
    heading_rad_ = run.heading_rad;
    payload_kg_ = run.payload_kg * truth.payload_factor;
    mass_kg_ = truth.chassis_mass_kg + 2 * truth.wheel_mass_kg + payload_kg_;
    const double solid = truth.chassis_mass_kg + payload_kg_ * (1 - w_.slosh_fraction);
    body_mass_kg_ = solid + 2 * truth.wheel_mass_kg;
    moment_kg_m_ = (truth.chassis_mass_kg + payload_kg_) * truth.center_of_mass_offset_m;
    const double d0 = truth.center_of_mass_offset_m, l = truth.half_track_m;
    yaw_inertia_ = truth.chassis_yaw_inertia_kg_m2 + truth.payload_yaw_inertia_m2 * payload_kg_ +
                   (truth.chassis_mass_kg + payload_kg_) * d0 * d0 + 2 * truth.wheel_mass_kg * l * l +
                   2 * truth.wheel_diameter_inertia_kg_m2;
    normal_N_ = mass_kg_ * kGravity_m_s2 / 2;
    battery_V_ = truth.open_circuit_voltage_V;
  }

  void control(std::size_t tick) {
    const double v = run_.speed_m_s[tick], yaw = run_.yaw_rate_rad_s[tick];
    for (std::size_t k = 0; k < 2; ++k) {
      Wheel& wheel = wheel_[k];
      const double side = k == kLeft ? -1 : 1;
      const double wanted = (v + side * nominal_.half_track_m * yaw) / nominal_.wheel_radius_m[k];
      const double encoder = edges(wheel.angle_rad);
      const double seen = (encoder - wheel.seen_angle_rad) / kControlPeriod_s;
      wheel.seen_angle_rad = encoder;
      const double back_emf = nominal_.torque_per_ampere_Nm_A();
      const double error = wanted - seen;
      const bool at_rest = wanted == 0 && std::abs(seen) < 0.05;
      wheel.integral_V =
          at_rest ? 0.8 * wheel.integral_V : wheel.integral_V + 8.0 * back_emf * error * kControlPeriod_s;
      double volts = back_emf * wanted + wheel.integral_V + (at_rest ? 0.0 : 1.2 * back_emf * error);
      const double limit = std::min(m_.max_voltage_V, battery_V_);
      volts = std::clamp(volts, -limit, limit);
      const double step = 2 * nominal_.open_circuit_voltage_V / kPwmSteps;
      wheel.commanded_V = d_.edges ? step * std::round(volts / step) : volts;
    }
  }

  void step(double day_s) {
    const double dt = d_.step_s;
    for (std::size_t k = 0; k < 2; ++k) advance_current(k, day_s);
    advance_battery();
    advance_bodies(day_s);
    time_s_ += dt;
  }

  double encoder_rad(std::size_t k) const { return edges(wheel_[k].angle_rad); }
  const Wheel& wheel(std::size_t k) const { return wheel_[k]; }
  double battery_V() const { return battery_V_; }
  double battery_A() const { return battery_A_; }
  double yaw_rate() const { return yaw_rate_; }
  double x_m() const { return x_m_; }
  double y_m() const { return y_m_; }
  double heading_rad() const { return heading_rad_; }

 private:
  double edges(double angle_rad) const {
    return d_.edges ? std::floor(angle_rad * kEdgesPerRad) / kEdgesPerRad : angle_rad;
  }

  void advance_current(std::size_t k, double day_s) {
    Wheel& wheel = wheel_[k];
    const double hot = w_.heating_fraction * (1 - std::exp(-day_s / w_.heating_time_s * (1 + w_.form)));
    double ohm = m_.resistance_ohm[k] * (1 + hot);
    const double drop = w_.driver_drop_V * std::clamp(wheel.current_A / 0.005, -1.0, 1.0) +
                        w_.driver_drop_V * w_.form * 0.5 * wheel.current_A;
    double volts = wheel.commanded_V - drop;
    if (w_.foldback_current_A > 0 && std::abs(wheel.current_A) > w_.foldback_current_A) {
      volts += 3.0 * ohm * sign_of(wheel.current_A) * w_.foldback_current_A;
      ohm *= 4.0;
    }
    wheel.voltage_V = volts;
    const double emf = m_.torque_per_ampere_Nm_A() * wheel.speed_rad_s;
    const double dt = d_.step_s;
    wheel.current_A =
        (wheel.current_A + dt / m_.inductance_H * (volts - emf)) / (1 + dt * ohm / m_.inductance_H);
    wheel.current_A = std::clamp(wheel.current_A, -m_.max_current_A, m_.max_current_A);
  }

  void advance_battery() {
    double power = m_.standby_W;
    for (const Wheel& wheel : wheel_) {
      const double electrical = wheel.commanded_V * wheel.current_A;
      power += electrical > 0 ? electrical : m_.regeneration_efficiency * electrical;
    }
    battery_A_ = power / battery_V_;
    battery_V_ = m_.open_circuit_voltage_V - m_.internal_resistance_ohm * battery_A_;
  }

  /// Friction that opposes the wheel's own motion, before its sign: everything the bearing carries.
  double resisting_level(std::size_t k, double day_s) const {
    const Wheel& wheel = wheel_[k];
    const double speed = std::abs(wheel.speed_rad_s);
    const double reference = nominal_.top_speed_m_s / nominal_.wheel_radius_m[k];
    const double shape =
        1 + w_.form * (speed / reference - 0.5) + w_.rolling_speed_slope_s_m * speed * m_.wheel_radius_m[k];
    double level = 0;
    level += w_.rolling_coefficient * normal_N_ * m_.wheel_radius_m[k] * shape;
    const bool on_patch =
        x_m_ > w_.patch_m[0] && x_m_ < w_.patch_m[1] && y_m_ > w_.patch_m[2] && y_m_ < w_.patch_m[3];
    if (on_patch) level += w_.patch_coefficient * normal_N_ * m_.wheel_radius_m[k] * shape;
    if (w_.stribeck_torque_Nm > 0) {
      const double ratio = speed / w_.stribeck_speed_rad_s;
      level += w_.stribeck_torque_Nm * std::exp(-std::pow(ratio, 2.0 + 2 * w_.form));
    }
    level += w_.drag_torque_Nm[k] * shape;
    if (wheel.speed_rad_s < 0) level += w_.reverse_torque_Nm * shape;
    level += w_.gear_loss_fraction * m_.torque_per_ampere_Nm_A() * std::abs(wheel.current_A) * shape;
    level += w_.grease_torque_Nm * std::exp(-day_s / w_.grease_time_s);
    level += w_.belt_set_torque_Nm * std::exp(-wheel.since_stop_rad / w_.belt_set_angle_rad);
    return level + m_.friction_torque_Nm[k] * (1 + w_.rolling_speed_slope_s_m * speed * m_.wheel_radius_m[k]);
  }

  double wheel_torque(std::size_t k, double day_s) {
    Wheel& wheel = wheel_[k];
    const double q = wheel.speed_rad_s;
    double torque = m_.torque_per_ampere_Nm_A() * wheel.current_A - m_.viscous_friction_Nm_s_rad * q;
    torque -= wheel.bristle.force(resisting_level(k, day_s), q, m_.presliding_angle_rad, d_.step_s);
    if (w_.cogging_per_rev > 0)
      torque +=
          w_.cogging_torque_Nm[k] * std::sin(w_.cogging_per_rev * wheel.angle_rad + w_.cogging_phase_rad[k]);
    if (w_.eccentric_torque_Nm[k] != 0) torque -= w_.eccentric_torque_Nm[k] * std::sin(wheel.angle_rad + 0.7);
    if (w_.flat_spot_torque_Nm[k] != 0) {
      const double off = std::remainder(wheel.angle_rad, 2 * std::numbers::pi) / 0.15;
      torque += w_.flat_spot_torque_Nm[k] * off * std::exp(-0.5 * off * off);  // climb, then fall
    }
    if (w_.eddy_torque_Nm > 0) {
      const double ratio = q / w_.eddy_speed_rad_s;
      torque -= w_.eddy_torque_Nm * 2 * ratio / (1 + ratio * ratio);
    }
    return torque;
  }

  struct BodyForces {
    double forward_N{}, sideways_N{}, yaw_Nm{};
  };

  BodyForces outer_forces(double day_s) {
    BodyForces f;
    const double c = std::cos(heading_rad_), s = std::sin(heading_rad_);
    const auto push = [&](double x_N, double y_N,
                          double ahead_m) {  // a force in map axes, at a point ahead of the axle
      f.forward_N += c * x_N + s * y_N;
      f.sideways_N += -s * x_N + c * y_N;
      f.yaw_Nm += ahead_m * (-s * x_N + c * y_N);
    };
    if (w_.slope_grade != 0) {
      const double undulation = 1 + w_.form * std::sin(1.3 * x_m_ + 0.9 * y_m_);
      const double pull = -mass_kg_ * kGravity_m_s2 * w_.slope_grade * undulation;
      push(pull * std::cos(w_.uphill_direction_rad), pull * std::sin(w_.uphill_direction_rad),
           moment_kg_m_ / mass_kg_);
    }
    if (w_.draft_force_N != 0) {
      const double pull = w_.draft_force_N * (0.2 + day_s / 400.0);
      push(pull * std::cos(w_.draft_direction_rad), pull * std::sin(w_.draft_direction_rad), 0);
    }
    if (w_.cable_N_m != 0) push(-w_.cable_N_m * x_m_, -w_.cable_N_m * y_m_, 0);
    f.forward_N -= w_.air_drag_N_s2_m2 * forward_ * std::pow(std::abs(forward_), 1.0 + w_.form);
    if (w_.scrub_moment_Nm > 0)
      f.yaw_Nm -= scrub_.force(w_.scrub_moment_Nm * (1 + w_.form * (std::abs(yaw_rate_) - 0.5)), yaw_rate_,
                               kScrubPresliding_rad, d_.step_s);
    if (w_.caster_moment_Nm > 0) f.yaw_Nm += caster_moment();
    if (w_.slosh_fraction > 0) f.forward_N += slosh_force();
    return f;
  }

  /// Casters that still point along the old course resist the turn into the new one. `caster_` is the part
  /// of the swivel that is left: set by a change of course, worn off by the distance travelled.
  double caster_moment() {
    const double reach_m = 1.2 * m_.half_track_m;  // the caster's mounting point, ahead of the axle
    const double speed = std::hypot(forward_, reach_m * yaw_rate_);
    if (speed > 5e-3) {
      const double course = std::atan2(reach_m * yaw_rate_, forward_);
      double turned = std::remainder(course - course_rad_, 2 * std::numbers::pi);
      if (std::abs(turned) > 2.6)
        turned = 0;  // straight back: the casters on both sides swing apart, no moment
      course_rad_ = course;
      caster_ =
          std::clamp(caster_ + turned / 0.35, -1.0, 1.0) * std::exp(-speed * d_.step_s / w_.caster_trail_m);
    }
    return -w_.caster_moment_Nm * caster_;
  }

  /// A part of the payload on a spring, along the robot: its pull on the chassis.
  double slosh_force() {
    const double part = payload_kg_ * w_.slosh_fraction;
    if (part <= 0) return 0.0;
    const double w = w_.slosh_frequency_rad_s, dt = d_.step_s;
    const double pull = part * (w * w * slosh_m_ + 2 * 0.08 * w * (slosh_speed_ - forward_));
    slosh_speed_ -= dt * pull / part;
    slosh_m_ += dt * (slosh_speed_ - forward_);
    return pull;
  }

  /// Newton-Euler about the axle midpoint, implicit in the creep forces: eliminate the wheels, then solve
  /// the remaining 3x3 system for (forward, sideways, yaw rate).
  void advance_bodies(double day_s) {
    const double dt = d_.step_s, l = m_.half_track_m, C = m_.tyre_creep_N_s_m,
                 J = m_.wheel_axle_inertia_kg_m2;
    double push_N[2], grip[2];  // creep force of a wheel = push - grip * (speed of the contact point)
    for (std::size_t k = 0; k < 2; ++k) {
      const double r = m_.wheel_radius_m[k], torque = wheel_torque(k, day_s);
      const double free_speed = J * wheel_[k].speed_rad_s + dt * torque, stiff = J + dt * C * r * r;
      push_N[k] = C * r * free_speed / stiff;
      grip[k] = C * J / stiff;
      free_[k] = free_speed;
      stiff_[k] = stiff;
    }
    const BodyForces f = outer_forces(day_s);
    const double mu = moment_kg_m_, m = body_mass_kg_;
    // Rows: forward, sideways, yaw; unknowns: the new speeds.
    const double a11 = m + dt * (grip[0] + grip[1]), a13 = dt * l * (grip[1] - grip[0]);
    const double a33 = yaw_inertia_ + dt * l * l * (grip[0] + grip[1]);
    const double a22 = m + dt * 4 * m_.tyre_creep_N_s_m;
    const double b1 = m * forward_ + dt * (push_N[0] + push_N[1] + f.forward_N + mu * yaw_rate_ * yaw_rate_ +
                                           m * yaw_rate_ * sideways_);
    const double b2 = m * sideways_ + mu * yaw_rate_ + dt * (f.sideways_N - m * yaw_rate_ * forward_);
    const double b3 = yaw_inertia_ * yaw_rate_ + mu * sideways_ +
                      dt * (l * (push_N[1] - push_N[0]) + f.yaw_Nm - mu * yaw_rate_ * forward_);
    // sideways: a22 y + mu w = b2 ; forward: a11 u + a13 w = b1 ; yaw: a13 u + mu y + a33 w = b3
    const double det = a33 - a13 * a13 / a11 - mu * mu / a22;
    yaw_rate_ = (b3 - a13 * b1 / a11 - mu * b2 / a22) / det;
    forward_ = (b1 - a13 * yaw_rate_) / a11;
    sideways_ = (b2 - mu * yaw_rate_) / a22;
    for (std::size_t k = 0; k < 2; ++k) turn_wheel(k, forward_ + (k == kLeft ? -l : l) * yaw_rate_);
    const double middle = heading_rad_ + 0.5 * dt * yaw_rate_;
    x_m_ += dt * (forward_ * std::cos(middle) - sideways_ * std::sin(middle));
    y_m_ += dt * (forward_ * std::sin(middle) + sideways_ * std::cos(middle));
    heading_rad_ += dt * yaw_rate_;
  }

  void turn_wheel(std::size_t k, double contact_speed) {
    Wheel& wheel = wheel_[k];
    const double dt = d_.step_s;
    wheel.speed_rad_s =
        (free_[k] + dt * m_.tyre_creep_N_s_m * m_.wheel_radius_m[k] * contact_speed) / stiff_[k];
    wheel.angle_rad += dt * wheel.speed_rad_s;
    const bool still = std::abs(wheel.speed_rad_s) < 0.02;
    wheel.stopped_s = still ? wheel.stopped_s + dt : 0.0;
    wheel.since_stop_rad =
        wheel.stopped_s > 0.1 ? 0.0 : wheel.since_stop_rad + dt * std::abs(wheel.speed_rad_s);
  }

  const Machine& m_;
  const Machine& nominal_;
  const World& w_;
  const Run& run_;
  Discretization d_;
  Wheel wheel_[2];
  Bristle scrub_;
  double mass_kg_{}, body_mass_kg_{}, payload_kg_{}, moment_kg_m_{}, yaw_inertia_{}, normal_N_{};
  double forward_{}, sideways_{}, yaw_rate_{}, x_m_{}, y_m_{}, heading_rad_{};
  double free_[2]{}, stiff_[2]{};
  double battery_V_{}, battery_A_{}, time_s_{};
  double caster_{}, course_rad_{}, slosh_m_{}, slosh_speed_{};
};

}  // namespace

std::vector<Sample> drive(const Machine& truth, const Machine& nominal, const World& world, const Run& run,
                          const Discretization& d) {
  Plant plant(truth, nominal, world, run, d);
  const auto steps_per_tick = static_cast<int>(std::lround(kControlPeriod_s / d.step_s));
  const auto ticks_per_sample = static_cast<int>(std::lround(kSamplePeriod_s / kControlPeriod_s));
  const double steps_per_sample = steps_per_tick * ticks_per_sample;
  std::vector<Sample> log;
  Sample sum;
  Pair angle_before{};
  double heading_before = run.heading_rad;
  for (std::size_t tick = 0; tick < run.speed_m_s.size(); ++tick) {
    plant.control(tick);
    for (int k = 0; k < steps_per_tick; ++k) {
      plant.step(run.start_time_s + static_cast<double>(tick) * kControlPeriod_s);
      for (std::size_t side = 0; side < 2; ++side) {
        const Wheel& wheel = plant.wheel(side);
        sum.motor_voltage_V[side] += wheel.commanded_V;
        sum.motor_current_A[side] += wheel.current_A;
        sum.true_power_W[side] += wheel.voltage_V * wheel.current_A;
      }
      sum.battery_voltage_V += plant.battery_V();
      sum.battery_current_A += plant.battery_A();
    }
    if ((tick + 1) % static_cast<std::size_t>(ticks_per_sample) != 0) continue;
    sum.time_s = static_cast<double>(tick + 1) * kControlPeriod_s;
    for (std::size_t side = 0; side < 2; ++side) {
      const double angle = plant.encoder_rad(side);
      sum.wheel_speed_rad_s[side] = (angle - angle_before[side]) / kSamplePeriod_s;
      angle_before[side] = angle;
      sum.motor_voltage_V[side] /= steps_per_sample;
      sum.motor_current_A[side] /= steps_per_sample;
      sum.true_power_W[side] /= steps_per_sample;
    }
    sum.battery_voltage_V /= steps_per_sample;
    sum.battery_current_A /= steps_per_sample;
    sum.gyro_rad_s = (plant.heading_rad() - heading_before) / kSamplePeriod_s;
    heading_before = plant.heading_rad();
    sum.x_m = plant.x_m();
    sum.y_m = plant.y_m();
    sum.heading_rad = plant.heading_rad();
    log.push_back(sum);
    sum = Sample{};
  }
  return log;
}

}  // namespace blind
