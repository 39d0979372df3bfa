#include "planner/nlp/transcription/affine_fit.hpp"

#include <cmath>

#include "model/operating_point.hpp"
#include "planner/motion/path_motion.hpp"

namespace joulepath::nlp {
namespace {

using States = Sided<WheelState<double>>;

struct Samples {
  States rest, fast, back, pushed;
};

template <class Member>
Affine fit(const Samples& samples, Side side, Member member) {
  const double rest = samples.rest[side].*member;
  const double fast = samples.fast[side].*member, back = samples.back[side].*member;
  return {.constant = rest,
          .of_a = samples.pushed[side].*member - rest,
          .of_b = 0.5 * (fast + back) - rest,
          .of_u = 0.5 * (fast - back)};
}

bool agrees(double fitted, double exact, double scale) {
  return std::abs(fitted - exact) <= 1e-9 * (scale + std::abs(exact));
}

}  // namespace

bool fit_affine(const Plant& plant, const PathRates& rates, const Site& site, Sided<AffineWheel>& wheel) {
  const auto at = [&](double u, double a) {
    return operating_point(plant, PathMotion::body_motion(rates, u, a), site);
  };
  const Samples samples{at(0, 0), at(1, 0), at(-1, 0), at(0, 1)};
  const bool bent = plant.torque_loss_fraction != 0 || plant.driver_voltage_drop_V != 0;
  if (bent) return false;
  for (Side side : kSides)
    wheel[side] = {fit(samples, side, &WheelState<double>::current_A),
                   fit(samples, side, &WheelState<double>::voltage_V),
                   fit(samples, side, &WheelState<double>::contact_force_N)};
  if (plant.effects.empty()) return true;  // the model without effects is affine
  constexpr double u = 0.37, a = -0.83;
  const States probe = at(u, a);
  for (Side side : kSides) {
    const AffineWheel& fitted = wheel[side];
    if (!agrees(fitted.current_A(a, u * u, u), probe[side].current_A, 1.0) ||
        !agrees(fitted.voltage_V(a, u * u, u), probe[side].voltage_V, 1.0) ||
        !agrees(fitted.force_N(a, u * u, u), probe[side].contact_force_N, 1.0))
      return false;
  }
  return true;
}

}  // namespace joulepath::nlp
