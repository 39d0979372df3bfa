#include "model/winding.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/effects/winding_heating.hpp"

namespace joulepath {
namespace {

constexpr WindingThermal kWinding{
    .resistance_K_W = 2.5, .capacity_J_K = 40, .max_winding_C = 155, .ambient_C = 25};
constexpr double kOhm = 0.8;

/// At a constant current the winding approaches x = R_th R i^2/(1 - alpha R_th R i^2).
TEST(Winding, AConstantCurrentHasAClosedForm) {
  const double i = 5, loss_W = kOhm * i * i, alpha = 1.0 / (235 + 25);
  const double share = alpha * 2.5 * loss_W, final_K = 2.5 * loss_W / (1 - share), tau_s = 100 / (1 - share);
  for (const double t : {0.1, 10.0, 100.0, 1e4})
    EXPECT_NEAR(rise_after_K(kWinding, kOhm, 0, i, t), final_K * (1 - std::exp(-t / tau_s)), 1e-9) << t;
  EXPECT_NEAR(rise_after_K(kWinding, kOhm, 60, 0, 100), 60 * std::exp(-1), 1e-12);
}

/// Runge-Kutta steps of the law itself, cool and in a run-away.
TEST(Winding, IsWhatTheLawIntegratesTo) {
  for (const double i : {1.0, 7.0, 11.4, 15.0}) {
    const auto rate = [&](double x) { return (kOhm * (1 + x / 260) * i * i - x / 2.5) / 40; };
    double x = 12;
    constexpr int kSteps = 4000;
    const double h = 60.0 / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      const double a = rate(x), b = rate(x + 0.5 * h * a), c = rate(x + 0.5 * h * b), d = rate(x + h * c);
      x += h * (a + 2 * b + 2 * c + d) / 6;
    }
    EXPECT_NEAR(rise_after_K(kWinding, kOhm, 12, i, 60), x, 1e-8 * x) << i;
  }
}

TEST(Winding, WhereTheTimeConstantIsInfiniteTheRiseIsLinear) {
  const double i = std::sqrt(260 / 2.5 / kOhm);
  EXPECT_NEAR(rise_after_K(kWinding, kOhm, 3, i, 7), 3 + kOhm * i * i / 40 * 7, 1e-9);
}

/// The catalog's law for a day of similar work is that of the winding at its mean loss.
TEST(Winding, TheEffectIsTheSameLawAtAConstantLoss) {
  const double rise_K = 45;
  const WindingHeating effect{.final_fraction = copper_factor(kWinding, rise_K) - 1, .time_constant_s = 100};
  for (const double t : {0.0, 30.0, 500.0})
    EXPECT_NEAR(effect.resistance_factor(t), copper_factor(kWinding, first_order(0, rise_K, t, 100)), 1e-12);
}

}  // namespace
}  // namespace joulepath
