#pragma once

#include <algorithm>
#include <cstddef>

#include "plant.hpp"

// Method: [CanudasDeWit1995]
namespace blind {

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
  double free_current_A{}, brake_A_s_rad{};  // the step's new current = free_current - brake * new speed
  double integral_V{};
  double seen_angle_rad{};  // at the controller's last tick
  double since_stop_rad{};  // angle travelled since standstill
  double stopped_s{};
  Bristle bristle{};
};

/// The state of the whole machine and one step of it (bodies.cpp), with its forces (forces.cpp).
class Plant {
 public:
  Plant(const Machine& truth, const Machine& nominal, const World& world, const Run& run,
        const Discretization& d);

  /// The controller's tick: PI on encoder speed, PWM steps.
  void control(std::size_t tick);
  void step(double day_s);

  double encoder_rad(std::size_t k) const { return edges(wheel_[k].angle_rad); }
  const Wheel& wheel(std::size_t k) const { return wheel_[k]; }
  double battery_V() const { return battery_V_; }
  double battery_A() const { return battery_A_; }
  double yaw_rate() const { return yaw_rate_; }
  double x_m() const { return x_m_; }
  double y_m() const { return y_m_; }
  double heading_rad() const { return heading_rad_; }

 private:
  double edges(double angle_rad) const;
  void prepare_current(std::size_t k, double day_s);
  void advance_battery();
  double resisting_level(std::size_t k, double day_s) const;
  double wheel_torque(std::size_t k, double day_s);

  struct BodyForces {
    double forward_N{}, sideways_N{}, yaw_Nm{};
  };
  BodyForces outer_forces(double day_s);
  void load(double weighed_kg);
  double caster_moment();
  double slosh_force();
  void advance_bodies(double day_s);
  void turn_wheel(std::size_t k, double contact_speed);

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

}  // namespace blind
