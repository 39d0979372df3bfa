#pragma once

#include <Eigen/Core>

#include "model/motion.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// Index of a side in the vectors and matrices of the state space. The paper's wheel 1 is the right one.
constexpr int wheel_index(Side side) { return side == Side::left ? 0 : 1; }

using WheelVector = Eigen::Vector2d;  ///< (left, right)
using Coordinates = Eigen::Vector4d;  ///< q = (x, y, q_left, q_right)
using StateVector =
    Eigen::Matrix<double, 6, 1>;  ///< (x, y, q_left, q_right, q_left', q_right')  [P1, Eq. (24)]
using VelocityMap = Eigen::Matrix<double, 4, 2>;  ///< from wheel speeds to q'
using ConstraintMatrix = Eigen::Matrix<double, 2, 4>;

/// Quantities outside of the state vector: load, time of day, and the heading at wheel angles zero.
struct DriveCircumstances {
  double payload_kg{};  ///< as stated
  double heading_at_zero_rad{};
  double time_of_day_s{};
  EffectMemory memory{};
};

/// Heading as a function of the wheel angles.
///   phi = phi_0 + (r_right q_right - r_left q_left)/(2 l)                     [P1, Eqs. (4), (5)]
[[nodiscard]] double heading_rad(const Geometry& geometry, double heading_at_zero_rad,
                                 const StateVector& state);

/// A(q) with A(q) q' = 0: no lateral motion, and rolling of the two wheels.   [P1, Eqs. (1), (7)-(9)]
[[nodiscard]] ConstraintMatrix constraint_matrix(const Geometry& geometry, double heading_rad);

/// S(q) with q' = S(q) eta, eta = (q_left', q_right'), A S = 0.                [P1, Eq. (19)]
[[nodiscard]] VelocityMap velocity_map(const Geometry& geometry, double heading_rad);

/// dS/dt along a motion with this yaw rate.                                    [P1, Eq. (20)]
[[nodiscard]] VelocityMap velocity_map_rate(const Geometry& geometry, double heading_rad,
                                            double yaw_rate_rad_s);

/// M(q), kg, kg m and kg m^2; wheel block I c_i c_j + (I_w + I_s) on the diagonal, c = -/+ r/(2 l).
///                                                                     [P1, Eq. (17)], see docs/equations.md
[[nodiscard]] Eigen::Matrix4d mass_matrix(const Robot& robot, const MassProperties& mass, double heading_rad);

/// F: Kt Kv n^2/R + nu on the wheels, N m s/rad.                               [P1, Eq. (18)]
[[nodiscard]] Eigen::Matrix4d damping_matrix(const Plant& plant, double time_of_day_s);

/// T: Kt n/R on the wheels, N m/V.                                             [P1, Eq. (18)]
[[nodiscard]] VelocityMap voltage_matrix(const Plant& plant, double time_of_day_s);

/// C(q, q'): -mu phi'^2 (cos phi, sin phi), Coulomb friction on the wheels, and the loads of the
/// effects. At a wheel that stands still friction is left out: see simulate() for stiction.
///                                                                             [P1, Eq. (18)]
[[nodiscard]] Coordinates load_vector(const Plant& plant, const DriveCircumstances& circumstances,
                                      const StateVector& state);

/// SᵀMS (kg m^2): the inertia at the wheels. It does not depend on q, and on the center of mass only
/// through Steiner's share of the yaw inertia.                                 [P1, Eq. (22)]
[[nodiscard]] Eigen::Matrix2d reduced_mass_matrix(const Robot& robot, const MassProperties& mass);

/// SᵀM S_dot (N m s): the torque of turning with mu != 0.                      [P1, Eq. (22)]
[[nodiscard]] Eigen::Matrix2d reduced_coriolis_matrix(const Robot& robot, const MassProperties& mass,
                                                      double yaw_rate_rad_s);

/// x' of the rigid robot (no creep) under the voltages (V) that the drivers are commanded to put out.
///
///   eta' = (SᵀMS)^-1 (SᵀT V - SᵀC - SᵀF S eta - SᵀM S_dot eta)                [P1, Eqs. (23), (25)]
///
/// Gear loss and voltage drop, which are not linear in V, are included.
[[nodiscard]] StateVector state_derivative(const Plant& plant, const DriveCircumstances& circumstances,
                                           const StateVector& state, const WheelVector& voltage_V);

/// f(x) of x' = f(x) + g(x) V.                                                 [P1, Eqs. (25), (26)]
[[nodiscard]] StateVector drift(const Plant& plant, const DriveCircumstances& circumstances,
                                const StateVector& state);

/// g(x) of x' = f(x) + g(x) V. Exact for plants without gear loss and voltage drop.  [P1, Eqs. (25), (26)]
[[nodiscard]] Eigen::Matrix<double, 6, 2> input_matrix(const Plant& plant,
                                                       const DriveCircumstances& circumstances);

/// Voltages (V) for given wheel accelerations (rad/s^2); inverse of state_derivative().
///
///   V = (SᵀT)^-1 (SᵀM S eta' + SᵀM S_dot eta + SᵀF S eta + SᵀC)               [P1, Eq. (27)]
[[nodiscard]] WheelVector voltages_for_V(const Plant& plant, const DriveCircumstances& circumstances,
                                         const StateVector& state,
                                         const WheelVector& wheel_acceleration_rad_s2);

}  // namespace joulepath
