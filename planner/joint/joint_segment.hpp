#pragma once

#include <array>
#include <cmath>

#include "planner/joint/drive_law.hpp"
#include "planner/nlp/interval/jet.hpp"
#include "planner/nlp/interval/segment.hpp"

namespace joulepath::joint {

inline double cos(double x) { return std::cos(x); }
inline double sin(double x) { return std::sin(x); }
template <std::size_t N>
nlp::JetOf<N> cos(const nlp::JetOf<N>& x) {
  const double c = std::cos(x.value), s = std::sin(x.value);
  return x.through(c, -s, -c);
}
template <std::size_t N>
nlp::JetOf<N> sin(const nlp::JetOf<N>& x) {
  const double c = std::cos(x.value), s = std::sin(x.value);
  return x.through(s, c, -s);
}
/// tanh(x / width)
template <std::size_t N>
nlp::JetOf<N> rounded_sign(const nlp::JetOf<N>& x, double width) {
  const double t = std::tanh(x.value / width), slope = (1 - t * t) / width;
  return x.through(t, slope, -2 * t * slope / width);
}
inline double rounded_sign(double x, double width) { return std::tanh(x / width); }

/// Width over which the friction of a wheel changes its sign, in its speed per unit of tau: wide enough for
/// Newton's method, narrow enough for the choice among curves.
inline constexpr double kSignWidth = 0.04;

/// Rows of a segment; each is a limit's unused share, >= 0: speed, lateral acceleration to both sides, yaw
/// rate; then per end gain and loss of speed, yaw acceleration to both sides.
inline constexpr std::size_t kSegmentRows = 12, kCapRows = 4;
/// Variables of a segment: squares of dtau/dt at both ends, phi at both knots of its piece, the piece's
/// length.
inline constexpr std::size_t kSegmentVariables = 5;

template <class Real>
struct SegmentValues {
  std::array<Real, 2> energy_J{};  ///< of the channels of recovery: both motors, or their sum
  Real duration_s{};
  std::array<Real, kSegmentRows> rows{};
};

/// Motion along a piece: A = ds/dtau and W = d heading/dtau are linear in the share f of its length.
template <class Real>
struct PieceRates {
  Real A0{}, dA{}, W0{}, dW{};
  Real A(double f) const { return A0 + dA * f; }
  Real W(double f) const { return W0 + dW * f; }
};
template <class Real>
PieceRates<Real> piece_rates(const Real& from_rad, const Real& to_rad, double half_track_m) {
  const Real A0 = cos(from_rad), W0 = sin(from_rad) / half_track_m;
  return {A0, cos(to_rad) - A0, W0, sin(to_rad) / half_track_m - W0};
}

/// Power (W) of one motor by the body's motion.
template <class Real>
Real motor_power_W(const WheelLaw& law, const BodyMotion<Real>& body, const Real& sign) {
  const Real &v = body.speed_m_s, &w = body.yaw_rate_rad_s;
  Real current_A = law.constant + law.sign * sign + law.speed * v + law.yaw_rate * w +
                   law.acceleration * body.acceleration_m_s2 +
                   law.yaw_acceleration * body.yaw_acceleration_rad_s2;
  if (law.yaw_rate_squared != 0) current_A += law.yaw_rate_squared * (w * w);
  if (law.speed_by_yaw_rate != 0) current_A += law.speed_by_yaw_rate * (v * w);
  Real voltage_V = law.resistance * current_A + law.emf_speed * v + law.emf_yaw_rate * w + law.emf;
  if (law.emf_sign != 0) voltage_V += law.emf_sign * sign;
  return voltage_V * current_A;
}

/// Energy, duration and rows of the part [f0, f1] of a piece: the square of dtau/dt is linear in tau, two
/// Gauss-Legendre points in time, as in the program of a given path
/// (planner/nlp/transcription/formulation.hpp).
template <class Real>
void evaluate_segment(const DriveLaw& law, int sign, const std::array<Real, kSegmentVariables>& x, double f0,
                      double f1, SegmentValues<Real>& out) {
  using std::sqrt;
  const auto& [b0, b1, from_rad, to_rad, length_m] = x;
  const PieceRates<Real> rates = piece_rates(from_rad, to_rad, law.half_track_m);
  const double part = f1 - f0, l = law.half_track_m;
  const Real u0 = sqrt(b0), u1 = sqrt(b1), per_sum = 1.0 / (u0 + u1), per_length = 1.0 / length_m;
  const Real a = (b1 - b0) * per_length * (0.5 / part), A_slope = rates.dA * per_length,
             W_slope = rates.dW * per_length, gain = u1 - u0;
  out.duration_s = length_m * per_sum * (2 * part);
  out.energy_J = {Real(0.0), Real(0.0)};
  for (const double time : nlp::kEnergyTimes) {
    const Real u = u0 + gain * time, b = u * u;
    const Real f = (u0 * (2 * time) + gain * (time * time)) * per_sum * part + f0;
    const Real A = rates.A0 + rates.dA * f, W = rates.W0 + rates.dW * f;
    const BodyMotion<Real> body{A * u, A * a + A_slope * b, W * u, W * a + W_slope * b};
    for (const Side side : kSides) {
      const Real wheel = A + W * (side == Side::right ? l : -l);
      const std::size_t channel = law.shared_bus ? 0 : static_cast<std::size_t>(side == Side::left);
      out.energy_J[channel] += motor_power_W(law.wheel[side], body, rounded_sign(wheel, kSignWidth));
    }
  }
  for (Real& energy : out.energy_J) energy = energy * out.duration_s * 0.5;
  const Limits& most = law.limits;
  const Real A1 = rates.A(f1), W1 = rates.W(f1),
             lateral = A1 * W1 * b1 * (1 / most.lateral_acceleration_m_s2);
  out.rows[0] = 1.0 - A1 * A1 * b1 * (1 / (most.speed_m_s * most.speed_m_s));
  out.rows[1] = 1.0 - lateral;
  out.rows[2] = 1.0 + lateral;
  out.rows[3] = 1.0 - W1 * W1 * b1 * (1 / (most.yaw_rate_rad_s * most.yaw_rate_rad_s));
  for (std::size_t end = 0; end < 2; ++end) {
    const Real& b = end == 0 ? b0 : b1;
    const double f = end == 0 ? f0 : f1;
    const Real gained = (rates.A(f) * a + A_slope * b) * sign;
    const Real turned = (rates.W(f) * a + W_slope * b) * (1 / most.yaw_acceleration_rad_s2);
    Real* row = &out.rows[kCapRows + 4 * end];
    row[0] = 1.0 - gained * (1 / most.acceleration_m_s2);
    row[1] = 1.0 + gained * (1 / most.deceleration_m_s2);
    row[2] = 1.0 - turned;
    row[3] = 1.0 + turned;
  }
}

}  // namespace joulepath::joint
