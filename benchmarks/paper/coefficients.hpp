#pragma once

#include <array>

#include "model/robot.hpp"

namespace joulepath::bench {

/// Coefficients of the straight-line power of one wheel as a polynomial in wheel acceleration q'',
/// wheel speed q' and payload m_p [P1, Eqs. (31), (32)].
using PowerCoefficients = std::array<double, 9>;

inline constexpr std::array<const char*, 9> kCoefficientNames{
    "q''^2", "q'' q'", "q''^2 m_p", "q''", "q'^2", "q'' q' m_p", "q'", "q'' m_p", "1"};

/// The nine coefficients of the model on a straight line. With J0 = (m_c + 2 m_w) r^2/2 + I_w + I_s,
/// j = r^2/2 and rho = R/(Kt n)^2:
///   P = rho tau^2 + (Kv/Kt) q' tau,  tau = (J0 + j m_p) q'' + nu q' + T_m.
[[nodiscard]] PowerCoefficients straight_line_coefficients(const Robot& robot, Side side);

/// The coefficient of q''^2 m_p^2, which Eqs. (31), (32) leave out.
[[nodiscard]] double dropped_coefficient(const Robot& robot, Side side);

/// Power (W) of one wheel by the polynomial.
[[nodiscard]] double polynomial_power_W(const PowerCoefficients& coefficients,
                                        double wheel_acceleration_rad_s2, double wheel_speed_rad_s,
                                        double payload_kg);

}  // namespace joulepath::bench
