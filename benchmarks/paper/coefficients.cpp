#include "benchmarks/paper/coefficients.hpp"

namespace joulepath::bench {
namespace {

struct StraightLine {
  double rho{}, J0{}, j{}, nu{}, T{}, kappa{};
};

StraightLine straight_line(const Robot& robot, Side side) {
  const Motor& motor = robot.motor[side];
  const double K = motor.torque_per_ampere_Nm_A();
  const double r = robot.geometry.wheel_radius_m[side];
  return {.rho = motor.resistance_ohm / (K * K),
          .J0 = robot.total_mass_kg(0.0) * r * r / 2 + robot.inertia.wheel_axle_inertia_kg_m2,
          .j = r * r / 2,
          .nu = motor.viscous_friction_Nm_s_rad,
          .T = motor.friction_torque_Nm,
          .kappa = motor.volts_per_speed_V_s_rad() / K};
}

}  // namespace

PowerCoefficients straight_line_coefficients(const Robot& robot, Side side) {
  const auto [rho, J0, j, nu, T, kappa] = straight_line(robot, side);
  return {rho * J0 * J0,
          kappa * J0 + 2 * rho * J0 * nu,
          2 * rho * J0 * j,
          2 * rho * J0 * T,
          kappa * nu + rho * nu * nu,
          kappa * j + 2 * rho * j * nu,
          kappa * T + 2 * rho * nu * T,
          2 * rho * j * T,
          rho * T * T};
}

double dropped_coefficient(const Robot& robot, Side side) {
  const StraightLine line = straight_line(robot, side);
  return line.rho * line.j * line.j;
}

double polynomial_power_W(const PowerCoefficients& c, double wheel_acceleration_rad_s2,
                          double wheel_speed_rad_s, double payload_kg) {
  const double a = wheel_acceleration_rad_s2, w = wheel_speed_rad_s, m = payload_kg;
  return c[0] * a * a + c[1] * a * w + c[2] * a * a * m + c[3] * a + c[4] * w * w + c[5] * a * w * m +
         c[6] * w + c[7] * a * m + c[8];
}

}  // namespace joulepath::bench
