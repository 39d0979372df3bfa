#include "model/simulation/drive.hpp"

#include <algorithm>
#include <cmath>

#include "model/simulation/drive_forces.hpp"

namespace joulepath {
namespace {

/// Speed (m/s) below which the robot counts as standing: casters neither swivel nor push.
constexpr double kCourseSpeed_m_s = 1e-3;

/// Memories as passed to the effects: near standstill they approach the course.
EffectMemory usable_memory(const DriveState& state, double course, double course_speed) {
  const double share =
      course_speed * course_speed / (course_speed * course_speed + kCourseSpeed_m_s * kCourseSpeed_m_s);
  EffectMemory memory{};
  for (std::size_t k = 0; k < kMaxMemories; ++k) memory[k] = course + share * (state[kMemory + k] - course);
  return memory;
}

double clamp_to(double value, double size) { return std::clamp(value, -size, size); }

}  // namespace

Drive::Drive(Plant plant, double time_of_day_s) : plant_(std::move(plant)), time_of_day_s_(time_of_day_s) {
  creeps_ = plant_.creep_m_s_N > 0 && 1.0 / plant_.creep_m_s_N <= kStiffest_N_s_m;
  active_[kLeftWheel] = active_[kRightWheel] = true;
  mass_ = mass_properties(plant_.robot, 0.0);
  Site site{.travel_direction = 1, .turn_direction = 1};
  const BodyLoad<double> there = effect_load(plant_, mass_, 0.0, 0.0, site);
  site.travel_direction = site.turn_direction = 0;
  const BodyLoad<double> none = effect_load(plant_, mass_, 0.0, 0.0, site);
  active_[kTravel] = there.force_N != none.force_N;
  active_[kTurn] = there.moment_Nm != none.moment_Nm;
  refresh_response();
}

void Drive::set_input(const DriveInput& input) {
  const bool heavier = input.payload_kg != input_.payload_kg;
  input_ = input;
  if (heavier) refresh_response();
}

/// Rigid: J (SᵀMS)^-1 Jᵀ, with J from wheel speeds to all four; creeping: each speed is independent.
void Drive::refresh_response() {
  const Robot& robot = plant_.robot;
  mass_ = mass_properties(robot, plant_.payload_kg(input_.payload_kg));
  const double axle = robot.inertia.wheel_axle_inertia_kg_m2;
  response_ = {};
  if (creeps_) {
    response_[kTravel][kTravel] = 1 / mass_.mass_kg;
    response_[kTurn][kTurn] = 1 / mass_.yaw_inertia_kg_m2;
    response_[kLeftWheel][kLeftWheel] = response_[kRightWheel][kRightWheel] = 1 / axle;
    return;
  }
  const double l = robot.geometry.half_track_m;
  const double r_left = robot.geometry.wheel_radius_m.left;
  const double r_right = robot.geometry.wheel_radius_m.right;
  const double J[4][2] = {{r_left / 2, r_right / 2}, {-r_left / (2 * l), r_right / (2 * l)}, {1, 0}, {0, 1}};
  const double inertia[4] = {mass_.mass_kg, mass_.yaw_inertia_kg_m2, axle, axle};
  double H[2][2] = {};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 4; ++k) H[i][j] += J[k][i] * inertia[k] * J[k][j];
  const double det = H[0][0] * H[1][1] - H[0][1] * H[1][0];
  const double inverse[2][2] = {{H[1][1] / det, -H[0][1] / det}, {-H[1][0] / det, H[0][0] / det}};
  for (int a = 0; a < 4; ++a)
    for (int b = 0; b < 4; ++b)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) response_[a][b] += J[a][i] * inverse[i][j] * J[b][j];
}

Velocity Drive::respond(const Velocity& force) const {
  Velocity acceleration{};
  for (std::size_t a = 0; a < kSurfaces; ++a)
    for (std::size_t b = 0; b < kSurfaces; ++b) acceleration[a] += response_[a][b] * force[b];
  return acceleration;
}

Site Drive::site_at(const DriveState& state, double time_s, const FrictionMode& mode) const {
  const Geometry& geometry = plant_.robot.geometry;
  const double v = state[kVelocity + kTravel];
  const double omega = state[kVelocity + kTurn];
  const double course = course_of(geometry, v, omega);
  return {.pose = {state[kX], state[kY], state[kYaw]},
          .time_of_day_s = time_of_day_s_ + time_s,
          .payload_kg = input_.payload_kg,
          .travel_direction = active_[kTravel] ? mode[kTravel] : sign_of(v),
          .turn_direction = active_[kTurn] ? mode[kTurn] : sign_of(omega),
          .wheel_direction = {double(mode[kLeftWheel]), double(mode[kRightWheel])},
          .course = course,
          .memory = usable_memory(state, course, caster_speed_m_s(geometry, v, omega))};
}

/// L i' + R i + Kv n q' = V within the current limit; without inductance an algebraic equation.
///                                                                        [P1, Eqs. (14), (15)]
void Drive::motors(const DriveState& state, double hot, Instant& instant, Forces& forces) const {
  for (Side side : kSides) {
    const std::size_t k = static_cast<std::size_t>(side == Side::right);
    const Motor& motor = plant_.robot.motor[side];
    const double R = hot * motor.resistance_ohm;
    const double drop_V = plant_.driver_voltage_drop_V;
    const double back_emf_V = motor.volts_per_speed_V_s_rad() * state[kVelocity + surface_of(side)];
    double& current_A = instant.current_A[side];
    double& voltage_V = instant.voltage_V[side];
    if (input_.coasting) {
      voltage_V = back_emf_V;
    } else if (motor.inductance_H > 0) {
      current_A = state[kArmatureLeft + k];
      const double held_V = sign_of(current_A) * drop_V;
      const double widest_V = R * motor.max_current_A + drop_V;
      voltage_V = std::isfinite(widest_V)
                      ? back_emf_V + clamp_to(input_.voltage_V[side] - back_emf_V, widest_V)
                      : input_.voltage_V[side];
      instant.derivative[kArmatureLeft + k] =
          (voltage_V - held_V - R * current_A - back_emf_V) / motor.inductance_H;
    } else {
      const double across_V = input_.voltage_V[side] - back_emf_V;
      const double driving_V = sign_of(across_V) * std::max(0.0, std::abs(across_V) - drop_V);
      current_A = clamp_to(driving_V / R, motor.max_current_A);
      voltage_V = std::abs(driving_V) > R * motor.max_current_A
                      ? back_emf_V + R * current_A + sign_of(current_A) * drop_V
                      : input_.voltage_V[side];
    }
    forces.motor_Nm[side] = motor.torque_per_ampere_Nm_A() * current_A;
  }
}

/// Inertial forces where mu != 0, and the effects' loads on the body.
void Drive::body_forces(const DriveState& state, const Site& site, Forces& forces) const {
  const double v = state[kVelocity + kTravel];
  const double omega = state[kVelocity + kTurn];
  forces.load = effect_load(plant_, mass_, v, omega, site);
  forces.total[kTravel] = mass_.first_moment_kg_m * omega * omega - forces.load.force_N + input_.push_N;
  forces.total[kTurn] = -mass_.first_moment_kg_m * v * omega - forces.load.moment_Nm;
}

void Drive::wheel_forces(const DriveState& state, const Site& site, Forces& forces) const {
  const Geometry& geometry = plant_.robot.geometry;
  for (Side side : kSides) {
    const Surface surface = surface_of(side);
    const double speed_rad_s = state[kVelocity + surface];
    forces.gear_loss_Nm[side] =
        plant_.torque_loss_fraction * std::abs(forces.motor_Nm[side]) * site.wheel_direction[side];
    forces.friction_Nm[side] = shaft_friction_Nm(plant_, mass_, side, speed_rad_s, site);
    forces.total[surface] = forces.motor_Nm[side] - forces.gear_loss_Nm[side] - forces.friction_Nm[side];
    if (!creeps_) continue;
    const double r = geometry.wheel_radius_m[side];
    const double arm_m = side_sign(side) * geometry.half_track_m;
    forces.creep_m_s[side] =
        r * speed_rad_s - (state[kVelocity + kTravel] + arm_m * state[kVelocity + kTurn]);
    const double force_N = forces.creep_m_s[side] / plant_.creep_m_s_N;
    forces.total[surface] -= r * force_N;
    forces.total[kTravel] += force_N;
    forces.total[kTurn] += arm_m * force_N;
  }
}

void Drive::contact_forces(const Forces& forces, const Velocity& acceleration, Instant& instant) const {
  const Robot& robot = plant_.robot;
  for (Side side : kSides)
    instant.contact_force_N[side] =
        creeps_ ? forces.creep_m_s[side] / plant_.creep_m_s_N
                : (forces.motor_Nm[side] - forces.gear_loss_Nm[side] - forces.friction_Nm[side] -
                   robot.inertia.wheel_axle_inertia_kg_m2 * acceleration[surface_of(side)]) /
                      robot.geometry.wheel_radius_m[side];
}

void Drive::motion(const DriveState& state, const Site& site, const Velocity& acceleration,
                   Instant& instant) const {
  double v = state[kVelocity + kTravel];
  double omega = state[kVelocity + kTurn];
  if (!creeps_ && plant_.creep_m_s_N > 0) {  // stiff contacts: creep without delay
    const Sided<double>& f = instant.contact_force_N;
    v -= plant_.creep_m_s_N * (f.right + f.left) / 2;
    omega -= plant_.creep_m_s_N * (f.right - f.left) / (2 * plant_.robot.geometry.half_track_m);
  }
  DriveState& rate = instant.derivative;
  rate[kX] = v * std::cos(state[kYaw]);
  rate[kY] = v * std::sin(state[kYaw]);
  rate[kYaw] = omega;
  rate[kAngleLeft] = state[kVelocity + kLeftWheel];
  rate[kAngleRight] = state[kVelocity + kRightWheel];
  for (std::size_t s = 0; s < kSurfaces; ++s) rate[kVelocity + s] = acceleration[s];
  const double path_m_s =
      caster_speed_m_s(plant_.robot.geometry, state[kVelocity + kTravel], state[kVelocity + kTurn]);
  std::size_t slot = 0;
  for (const Effect& effect : plant_.effects)
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { e.memory_rate_per_m(0.0, 0.0); }) {
            rate[kMemory + slot] = path_m_s * e.memory_rate_per_m(state[kMemory + slot], site.course);
            ++slot;
          }
        },
        effect);
}

Drive::Instant Drive::evaluate(const DriveState& state, double time_s, const FrictionMode& mode) const {
  Instant instant;
  Forces forces;
  const Site site = site_at(state, time_s, mode);
  const double hot = plant_.resistance_factor(site.time_of_day_s);
  motors(state, hot, instant, forces);
  body_forces(state, site, forces);
  wheel_forces(state, site, forces);
  bounds(state, site, mode, forces);
  Velocity acceleration{};
  hold(mode, forces, acceleration, instant);
  contact_forces(forces, acceleration, instant);
  motion(state, site, acceleration, instant);
  integrals(state, forces, hot, instant);
  return instant;
}

void Drive::stop(DriveState& state, Surface surface) const {
  const double impulse = -state[kVelocity + surface] / response_[surface][surface];
  for (std::size_t a = 0; a < kSurfaces; ++a) state[kVelocity + a] += response_[a][surface] * impulse;
  state[kVelocity + surface] = 0.0;
}

}  // namespace joulepath
