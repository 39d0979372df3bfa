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

/// A quantity of a wheel along a path, from what it is by the body's motion:
///   v = along u,   v' = along a,   omega = turn u,   omega' = turn a + turn_slope u^2.
/// A center of mass beside the axle adds omega^2 and v omega.
template <class ByBody>
Affine along_path(const ByBody& x, const PathRates& rates) {
  return {.constant = x.constant,
          .of_a = x.acceleration * rates.along + x.yaw_acceleration * rates.turn,
          .of_b = x.yaw_acceleration * rates.turn_slope +
                  (x.yaw_rate_squared * rates.turn + x.speed_by_yaw_rate * rates.along) * rates.turn,
          .of_u = x.speed * rates.along + x.yaw_rate * rates.turn};
}

bool agrees(double fitted, double exact, double scale) {
  return std::abs(fitted - exact) <= 1e-9 * (scale + std::abs(exact));
}

}  // namespace

void AffineFit::take_directions(const Site& site) {
  wheel_direction_ = site.wheel_direction;
  payload_kg_ = site.payload_kg;
  const auto at = [&](const BodyMotion<double>& motion) { return operating_point(*plant_, motion, site); };
  const States rest = at({}), speed = at({.speed_m_s = 1}), acceleration = at({.acceleration_m_s2 = 1}),
               yaw_rate = at({.yaw_rate_rad_s = 1}), back = at({.yaw_rate_rad_s = -1}),
               both = at({.speed_m_s = 1, .yaw_rate_rad_s = 1}),
               yaw_acceleration = at({.yaw_acceleration_rad_s2 = 1});
  const auto by_body = [&](Side side, double WheelState<double>::*member) {
    const double none = rest[side].*member;
    return ByBody{
        .constant = none,
        .speed = speed[side].*member - none,
        .acceleration = acceleration[side].*member - none,
        .yaw_rate = 0.5 * (yaw_rate[side].*member - back[side].*member),
        .yaw_rate_squared = 0.5 * (yaw_rate[side].*member + back[side].*member) - none,
        .speed_by_yaw_rate = both[side].*member - speed[side].*member - yaw_rate[side].*member + none,
        .yaw_acceleration = yaw_acceleration[side].*member - none};
  };
  for (Side side : kSides)
    by_body_[side] = {by_body(side, &WheelState<double>::current_A),
                      by_body(side, &WheelState<double>::voltage_V),
                      by_body(side, &WheelState<double>::contact_force_N)};
}

bool AffineFit::at(const PathRates& rates, const Site& site, Sided<AffineWheel>& wheel) {
  const Plant& plant = *plant_;
  if (plant.torque_loss_fraction != 0 || plant.driver_voltage_drop_V != 0) return false;
  if (plant.effects.empty()) {
    if (wheel_direction_ != site.wheel_direction || payload_kg_ != site.payload_kg) take_directions(site);
    for (Side side : kSides)
      wheel[side] = {along_path(by_body_[side].current_A, rates), along_path(by_body_[side].voltage_V, rates),
                     along_path(by_body_[side].force_N, rates)};
    return true;
  }
  const auto motion_at = [&](double u, double a) {
    return operating_point(plant, PathMotion::body_motion(rates, u, a), site);
  };
  const Samples samples{motion_at(0, 0), motion_at(1, 0), motion_at(-1, 0), motion_at(0, 1)};
  for (Side side : kSides)
    wheel[side] = {fit(samples, side, &WheelState<double>::current_A),
                   fit(samples, side, &WheelState<double>::voltage_V),
                   fit(samples, side, &WheelState<double>::contact_force_N)};
  constexpr double u = 0.37, a = -0.83;
  const States probe = motion_at(u, a);
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
