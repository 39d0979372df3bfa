#pragma once

#include "planner/nlp/interval/segment.hpp"

namespace joulepath::nlp {

/// Two neighboring nodes with constant jerk between them: acceleration is linear in time. The unknowns are
/// rate and acceleration at the nodes and the time between them, related by the kinematics:
///   u1 = u0 + dt (a0 + a1)/2,   ds = dt (u0 + u1)/2 - dt^2 (a1 - a0)/12.
/// Terms that take an Interval take this as well.
template <class R>
struct JerkInterval {
  using Real = R;
  const Segment& segment;
  Real u0{}, a0{};
  Real u1{}, a1{};
  Real dt{};
  mutable PointLoads<Real> loads{};

  /// After a share tau of the time.
  Motion<Real> at(double tau) const {
    const Real u = (1 - tau) * u0 + tau * u1 - 0.5 * tau * (1 - tau) * (dt * (a1 - a0));
    return {(1 - tau) * a0 + tau * a1, Real(u * u), u};
  }
  Motion<Real> at_limit_point(std::size_t point) const {
    if (point == 0) return {a0, Real(u0 * u0), u0};
    if (point + 1 == kLimitPoints) return {a1, Real(u1 * u1), u1};
    return at(segment.limit_points[point].time_share);
  }
  Motion<Real> at_energy_point(std::size_t point) const { return at(kEnergyTimes[point]); }

  /// Residuals of the kinematics: 0 for a motion.
  Real speed_defect() const { return u1 - u0 - 0.5 * (dt * (a0 + a1)); }
  Real distance_defect() const {
    return 0.5 * (dt * (u0 + u1)) - (1.0 / 12) * (dt * dt * (a1 - a0)) - segment.ds;
  }
};

/// Derivatives by (u0, a0, u1, a1, dt).
using JerkJet = JetOf<5>;

/// The interval with derivatives by its five values, each divided by its scale.
inline JerkInterval<JerkJet> jet_jerk_interval(const Segment& segment, const std::array<double, 5>& x,
                                               const std::array<double, 5>& scale = {1, 1, 1, 1, 1}) {
  std::array<JerkJet, 5> jets;
  for (std::size_t i = 0; i < 5; ++i) {
    jets[i] = JerkJet(x[i]);
    jets[i].d[i] = scale[i];
  }
  return {segment, jets[0], jets[1], jets[2], jets[3], jets[4]};
}

}  // namespace joulepath::nlp
