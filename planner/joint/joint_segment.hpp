#pragma once

#include <array>
#include <cmath>
#include <utility>

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

/// Quantities of a segment that limits bound: squared speed, lateral acceleration and squared yaw rate at its
/// end; then per end acceleration along the heading and yaw acceleration.
inline constexpr std::size_t kSegmentQuantities = 7, kCapQuantities = 3;
/// Rows of a segment; each is a limit's unused share, >= 0. The first ones hold at its end alone.
inline constexpr std::size_t kSegmentRows = 12, kCapRows = 4;
/// Variables of a segment: squares of dtau/dt at both ends, phi at both knots of its piece, the piece's
/// length.
inline constexpr std::size_t kSegmentVariables = 5;

template <class Real>
struct SegmentValues {
  std::array<Real, 2> energy_J{};  ///< of the channels of recovery: both motors, or their sum
  Real duration_s{};
  std::array<Real, kSegmentQuantities> bounded{};
};

/// A row is 1 + slope x quantity.
struct RowLaw {
  std::size_t quantity{};
  double slope{};
};
/// `sign`: 1 forward, -1 in reverse.
inline std::array<RowLaw, kSegmentRows> row_laws(const Limits& most, int sign) {
  const double lateral = 1 / most.lateral_acceleration_m_s2, turning = 1 / most.yaw_acceleration_rad_s2,
               gain = sign / most.acceleration_m_s2, loss = sign / most.deceleration_m_s2;
  return {{{0, -1 / (most.speed_m_s * most.speed_m_s)},
           {1, -lateral},
           {1, lateral},
           {2, -1 / (most.yaw_rate_rad_s * most.yaw_rate_rad_s)},
           {3, -gain},
           {3, loss},
           {4, -turning},
           {4, turning},
           {5, -gain},
           {5, loss},
           {6, -turning},
           {6, turning}}};
}

/// constant + sum of weight x term, in one pass over the derivatives.
template <std::size_t K>
double linear(double constant, const std::array<double, K>& weight, const std::array<const double*, K>& of) {
  for (std::size_t k = 0; k < K; ++k) constant += weight[k] * *of[k];
  return constant;
}
template <std::size_t N, std::size_t K>
nlp::JetOf<N> linear(double constant, const std::array<double, K>& weight,
                     const std::array<const nlp::JetOf<N>*, K>& of) {
  nlp::JetOf<N> sum(constant);
  for (std::size_t k = 0; k < K; ++k) sum.value += weight[k] * of[k]->value;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t k = 0; k < K; ++k) sum.d[i] += weight[k] * of[k]->d[i];
  for (std::size_t i = 0; i < sum.dd.size(); ++i)
    for (std::size_t k = 0; k < K; ++k) sum.dd[i] += weight[k] * of[k]->dd[i];
  return sum;
}

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

/// The motion of a part of a piece: the square of dtau/dt is linear in tau.
template <class Real>
struct PartMotion {
  PieceRates<Real> rates{};
  Real rate_gain{};           ///< d^2 tau/dt^2
  Real A_slope{}, W_slope{};  ///< by tau

  PartMotion(const DriveLaw& law, const std::array<Real, kSegmentVariables>& x, const Real& per_length,
             double part)
      : rates(piece_rates(x[2], x[3], law.half_track_m)),
        rate_gain((x[1] - x[0]) * per_length * (0.5 / part)),
        A_slope(rates.dA * per_length),
        W_slope(rates.dW * per_length) {}

  /// At a place with A and W, where dtau/dt is u and its square b.
  BodyMotion<Real> at(const Real& A, const Real& W, const Real& u, const Real& b) const {
    return {A * u, A * rate_gain + A_slope * b, W * u, W * rate_gain + W_slope * b};
  }
};

/// The sign of a wheel's speed.
template <class Real>
Real wheel_sign(const DriveLaw& law, Side side, const Real& A, const Real& W) {
  return rounded_sign(A + W * (side_sign(side) * law.half_track_m), kSignWidth);
}

template <class Real>
Real value_of(const WheelForm& form, const BodyMotion<Real>& body, const Real& sign) {
  const Real &v = body.speed_m_s, &w = body.yaw_rate_rad_s;
  Real value =
      linear(form.constant,
             std::array{form.sign, form.speed, form.yaw_rate, form.acceleration, form.yaw_acceleration},
             std::array{&sign, &v, &w, &body.acceleration_m_s2, &body.yaw_acceleration_rad_s2});
  if (form.yaw_rate_squared != 0) value += form.yaw_rate_squared * (w * w);
  if (form.speed_by_yaw_rate != 0) value += form.speed_by_yaw_rate * (v * w);
  return value;
}

/// Power (W) of one motor by the body's motion.
template <class Real>
Real motor_power_W(const WheelLaw& law, const BodyMotion<Real>& body, const Real& sign) {
  const Real current_A = value_of(law.current_A, body, sign);
  const Real voltage_V =
      linear(law.emf, std::array{law.resistance, law.emf_speed, law.emf_yaw_rate, law.emf_sign},
             std::array{&current_A, &body.speed_m_s, &body.yaw_rate_rad_s, &sign});
  return voltage_V * current_A;
}

/// Energy, duration and bounded quantities of the part [f0, f1] of a piece: two Gauss-Legendre points in
/// time, as in the program of a given path (planner/nlp/transcription/formulation.hpp).
template <class Real>
void evaluate_segment(const DriveLaw& law, const std::array<Real, kSegmentVariables>& x, double f0, double f1,
                      SegmentValues<Real>& out) {
  using std::sqrt;
  const Real &b0 = x[0], &b1 = x[1], &length_m = x[4];
  const double part = f1 - f0;
  const Real u0 = sqrt(b0), u1 = sqrt(b1), per_sum = 1.0 / (u0 + u1), per_length = 1.0 / length_m;
  const Real gain = u1 - u0;
  const PartMotion<Real> motion(law, x, per_length, part);
  const PieceRates<Real>& rates = motion.rates;
  out.duration_s = length_m * per_sum * (2 * part);
  out.energy_J = {Real(0.0), Real(0.0)};
  for (const double time : nlp::kEnergyTimes) {
    const Real u = u0 + gain * time, b = u * u;
    const Real f = (u0 * (2 * time) + gain * (time * time)) * per_sum * part + f0;
    const Real A = rates.A0 + rates.dA * f, W = rates.W0 + rates.dW * f;
    const BodyMotion<Real> body = motion.at(A, W, u, b);
    for (const Side side : kSides) {
      const std::size_t channel = law.shared_bus ? 0 : static_cast<std::size_t>(side == Side::left);
      out.energy_J[channel] += motor_power_W(law.wheel[side], body, wheel_sign(law, side, A, W));
    }
  }
  for (Real& energy : out.energy_J) energy = energy * out.duration_s * 0.5;
  const Real A1 = rates.A(f1), W1 = rates.W(f1), speed = A1 * b1;
  out.bounded[0] = A1 * speed;
  out.bounded[1] = W1 * speed;
  out.bounded[2] = W1 * W1 * b1;
  for (std::size_t end = 0; end < 2; ++end) {
    const Real& b = end == 0 ? b0 : b1;
    const double f = end == 0 ? f0 : f1;
    out.bounded[3 + 2 * end] = rates.A(f) * motion.rate_gain + motion.A_slope * b;
    out.bounded[4 + 2 * end] = rates.W(f) * motion.rate_gain + motion.W_slope * b;
  }
}

}  // namespace joulepath::joint
