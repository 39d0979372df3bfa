#include "bodies.hpp"

#include <algorithm>
#include <cmath>

namespace blind {
namespace {

constexpr double kEdgesPerRad = 8000.0;  // encoder on the motor shaft, seen at the wheel
constexpr double kPwmSteps = 4096.0;     // over twice the supply voltage

double sign_of(double x) { return x > 0 ? 1.0 : (x < 0 ? -1.0 : 0.0); }

}  // namespace

Plant::Plant(const Machine& truth, const Machine& nominal, const World& world, const Run& run,
             const Discretization& d)
    : m_(truth), nominal_(nominal), w_(world), run_(run), d_(d) {
  heading_rad_ = run.heading_rad;
  load(run.payload_kg);
  battery_V_ = truth.open_circuit_voltage_V;
}

void Plant::load(double weighed_kg) {
  payload_kg_ = weighed_kg * m_.payload_factor;
  mass_kg_ = m_.chassis_mass_kg + 2 * m_.wheel_mass_kg + payload_kg_;
  const double solid = m_.chassis_mass_kg + payload_kg_ * (1 - w_.slosh_fraction);
  body_mass_kg_ = solid + 2 * m_.wheel_mass_kg;
  moment_kg_m_ = (m_.chassis_mass_kg + payload_kg_) * m_.center_of_mass_offset_m;
  const double d0 = m_.center_of_mass_offset_m, l = m_.half_track_m;
  yaw_inertia_ = m_.chassis_yaw_inertia_kg_m2 + m_.payload_yaw_inertia_m2 * payload_kg_ +
                 (m_.chassis_mass_kg + payload_kg_) * d0 * d0 + 2 * m_.wheel_mass_kg * l * l +
                 2 * m_.wheel_diameter_inertia_kg_m2;
  normal_N_ = mass_kg_ * kGravity_m_s2 / 2;
}

void Plant::control(std::size_t tick) {
  for (const Loading& reloading : run_.reloadings)
    if (reloading.tick == tick) load(reloading.payload_kg);
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

void Plant::step(double day_s) {
  const double dt = d_.step_s;
  for (std::size_t k = 0; k < 2; ++k) prepare_current(k, day_s);
  advance_bodies(day_s);
  advance_battery();
  time_s_ += dt;
}

double Plant::edges(double angle_rad) const {
  return d_.edges ? std::floor(angle_rad * kEdgesPerRad) / kEdgesPerRad : angle_rad;
}

/// The armature's new current as a straight line in the new speed: free_current - brake * speed. The back-EMF
/// is that of the end of the step, as are current and speed in the log: no lag between them is left.
void Plant::prepare_current(std::size_t k, double day_s) {
  Wheel& wheel = wheel_[k];
  double ohm = m_.resistance_ohm[k];
  if (w_.heating_fraction > 0)
    ohm *= 1 + w_.heating_fraction * (1 - std::exp(-day_s / w_.heating_time_s * (1 + w_.form)));
  const double drop = w_.driver_drop_V * std::clamp(wheel.current_A / 0.005, -1.0, 1.0) +
                      w_.driver_drop_V * w_.form * 0.5 * wheel.current_A;
  double volts = wheel.commanded_V - drop;
  if (w_.foldback_current_A > 0 && std::abs(wheel.current_A) > w_.foldback_current_A) {
    volts += 3.0 * ohm * sign_of(wheel.current_A) * w_.foldback_current_A;
    ohm *= 4.0;
  }
  wheel.voltage_V = volts;
  const double dt = d_.step_s, slope = dt / m_.inductance_H / (1 + dt * ohm / m_.inductance_H);
  wheel.free_current_A = wheel.current_A / (1 + dt * ohm / m_.inductance_H) + slope * volts;
  wheel.brake_A_s_rad = slope * m_.torque_per_ampere_Nm_A();
  const double expected = wheel.free_current_A - wheel.brake_A_s_rad * wheel.speed_rad_s;
  if (std::abs(expected) <= m_.max_current_A) return;
  wheel.free_current_A = std::copysign(m_.max_current_A, expected);  // held at its limit
  wheel.brake_A_s_rad = 0;
}

void Plant::advance_battery() {
  double power = m_.standby_W;
  for (const Wheel& wheel : wheel_) {
    const double electrical = wheel.commanded_V * wheel.current_A;
    power += electrical > 0 ? electrical : m_.regeneration_efficiency * electrical;
  }
  battery_A_ = power / battery_V_;
  battery_V_ = m_.open_circuit_voltage_V - m_.internal_resistance_ohm * battery_A_;
}

/// Newton-Euler about the axle midpoint, implicit in creep forces, back-EMF and viscous friction: eliminate
/// currents and wheels, then solve the remaining 3x3 system for (forward, sideways, yaw rate).
void Plant::advance_bodies(double day_s) {
  const double dt = d_.step_s, l = m_.half_track_m, C = m_.tyre_creep_N_s_m, J = m_.wheel_axle_inertia_kg_m2;
  double push_N[2], grip[2];  // creep force of a wheel = push - grip * (speed of the contact point)
  for (std::size_t k = 0; k < 2; ++k) {
    const double r = m_.wheel_radius_m[k], torque = wheel_torque(k, day_s);
    const double damping =
        m_.viscous_friction_Nm_s_rad + m_.torque_per_ampere_Nm_A() * wheel_[k].brake_A_s_rad;
    const double free_speed = J * wheel_[k].speed_rad_s + dt * torque;
    const double stiff = J + dt * (C * r * r + damping);
    push_N[k] = C * r * free_speed / stiff;
    grip[k] = C * (J + dt * damping) / stiff;
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

void Plant::turn_wheel(std::size_t k, double contact_speed) {
  Wheel& wheel = wheel_[k];
  const double dt = d_.step_s;
  wheel.speed_rad_s =
      (free_[k] + dt * m_.tyre_creep_N_s_m * m_.wheel_radius_m[k] * contact_speed) / stiff_[k];
  wheel.current_A = wheel.free_current_A - wheel.brake_A_s_rad * wheel.speed_rad_s;
  wheel.angle_rad += dt * wheel.speed_rad_s;
  const bool still = std::abs(wheel.speed_rad_s) < 0.02;
  wheel.stopped_s = still ? wheel.stopped_s + dt : 0.0;
  wheel.since_stop_rad =
      wheel.stopped_s > 0.1 ? 0.0 : wheel.since_stop_rad + dt * std::abs(wheel.speed_rad_s);
}

}  // namespace blind
