#pragma once

#include <algorithm>
#include <cmath>

namespace joulepath::joint {

/// The longest steps of slacks and of multipliers that keep them positive.
struct StepLengths {
  double primal{1}, dual{1};
  static void shorten(double& step, double x, double dx) {
    constexpr double kBoundary = 0.99;
    if (dx < 0) step = std::min(step, -kBoundary * x / dx);
  }
};

/// An inequality value >= 0 with its slack s > 0 and multiplier z > 0: value = s, s z = mu.
struct Row {
  /// Of s z, relative to mu: a row farther off would meet its bound without a force against it.
  static constexpr double kLeastProduct = 0.1;
  double value{}, s{1}, z{}, ds{}, dz{};

  void begin(double at, double least, double mu) {
    value = at;
    s = std::max(at, least);
    z = mu / s;
  }
  double stiffness() const { return z / s; }
  double residual() const { return value - s; }
  /// Weight of the value's gradient in the reduced gradient, with a minus sign.
  double push(double mu) const { return mu / s - stiffness() * residual(); }
  void step(double d_value, double mu, StepLengths& lengths) {
    ds = d_value + residual();
    dz = mu / s - z - stiffness() * ds;
    StepLengths::shorten(lengths.primal, s, ds);
    StepLengths::shorten(lengths.dual, z, dz);
  }
  double slack_after(double primal, double new_value) const { return std::max(s + primal * ds, new_value); }
  /// Barrier and violation at a step; every row has its own weight.
  double merit(double primal, double new_value, double mu, double weight) const {
    const double slack = slack_after(primal, new_value);
    return (1.3 * std::max(z, z + dz) + weight) * (slack - new_value) - mu * std::log(slack);
  }
  void take(double primal, double dual, double new_value, double mu) {
    s = slack_after(primal, new_value);
    z = std::clamp(z + dual * dz, kLeastProduct * mu / s, 1e6 * mu / s + 1e-12);
    value = new_value;
  }
};

/// The energy max(E, eta E) of a channel as E + (1 - eta) zeta with zeta >= 0, w = E + zeta >= 0:
///   u zeta = mu,   y w = mu,   1 - eta - u - y = 0.
struct Recovery {
  double E{}, zeta{}, w{}, u{}, y{}, d_zeta{}, dw{}, du{}, dy{};

  void begin(double energy, double loss, double mu) {
    E = energy;
    const double scale = mu / loss;
    zeta = scale - 0.5 * E + 0.5 * std::hypot(E, 2 * scale);
    w = std::max(E + zeta, 1e-9);
    u = std::min(mu / zeta, loss * (1 - 1e-6));
    y = loss - u;
  }
  double residual() const { return E + zeta - w; }
  double of_zeta() const { return u / zeta; }
  double of_w() const { return y / w; }
  double stiffness() const { return of_zeta() * of_w() / (of_zeta() + of_w()); }
  double imbalance(double loss, double mu) const { return mu / zeta + mu / w - loss; }
  /// Weight of E's gradient in the reduced gradient.
  double pull(double loss, double mu) const {
    const double c = of_w();
    const double step = mu / w - y - c * imbalance(loss, mu) / (of_zeta() + c) - stiffness() * residual();
    return 1 - y - step;
  }
  void step(double dE, double loss, double mu, StepLengths& lengths) {
    const double a = of_zeta(), c = of_w();
    d_zeta = (imbalance(loss, mu) - c * (dE + residual())) / (a + c);
    dw = dE + d_zeta + residual();
    du = mu / zeta - u - a * d_zeta;
    dy = mu / w - y - c * dw;
    StepLengths::shorten(lengths.primal, zeta, d_zeta);
    StepLengths::shorten(lengths.primal, w, dw);
    StepLengths::shorten(lengths.dual, u, du);
    StepLengths::shorten(lengths.dual, y, dy);
  }
  double merit(double primal, double energy, double loss, double mu) const {
    const double zz = zeta + primal * d_zeta, ww = w + primal * dw;
    return energy + loss * zz - mu * std::log(zz * ww) + 1.2 * std::abs(energy + zz - ww);
  }
  void take(double primal, double dual, double energy) {
    zeta += primal * d_zeta;
    w += primal * dw;
    u += dual * du;
    y += dual * dy;
    E = energy;
  }
};

}  // namespace joulepath::joint
