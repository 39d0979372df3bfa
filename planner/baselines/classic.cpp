#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/baselines/finish.hpp"
#include "planner/baselines/shapes.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;

std::string unit_key(const ProfileRequest& request, const char* along, const char* turning) {
  return is_turn(request.piece) ? turning : along;
}

BaselineResult triangular(const ProfileRequest& request, double length, double duration_s) {
  const double a = 4 * length / (duration_s * duration_s), half_s = 0.5 * duration_s;
  Profile profile{.time_s = {0, half_s, duration_s},
                  .s = {0, length / 2, length},
                  .rate = {0, a * half_s, 0},
                  .acceleration = {a, -a},
                  .jerk = {0, 0}};
  return finish_baseline(request, "triangular", std::move(profile), duration_s,
                         {{unit_key(request, "acceleration_m_s2", "yaw_acceleration_rad_s2"), a}});
}

/// Accelerate for 4 s, cruise, brake for 4 s (shorter ramps where the time is), as [P1]'s protocol has it.
BaselineResult constant_ramp(const ProfileRequest& request, double length, double duration_s) {
  const double ramp_s = std::min(4.0, 0.5 * duration_s), rate = length / (duration_s - ramp_s),
               a = rate / ramp_s;
  const double ramp = 0.5 * rate * ramp_s;
  Profile profile{.time_s = {0, ramp_s}, .s = {0, ramp}, .rate = {0, rate}, .acceleration = {a}, .jerk = {0}};
  if (duration_s > 2 * ramp_s) {
    profile.time_s.push_back(duration_s - ramp_s);
    profile.s.push_back(length - ramp);
    profile.rate.push_back(rate);
    profile.acceleration.push_back(0);
    profile.jerk.push_back(0);
  }
  profile.time_s.push_back(duration_s);
  profile.s.push_back(length);
  profile.rate.push_back(0);
  profile.acceleration.push_back(-a);
  profile.jerk.push_back(0);
  return finish_baseline(request, "constant_ramp", std::move(profile), duration_s,
                         {{"ramp_s", ramp_s}, {unit_key(request, "speed_m_s", "yaw_rate_rad_s"), rate}});
}

/// Parabola of the rate: the cubic of least jerk-free effort, optimal where there is no viscous friction.
BaselineResult cubic(const ProfileRequest& request, double length, double duration_s) {
  const double T = duration_s, a = 6 * length / (T * T), j = -2 * a / T;
  Profile profile = jerk_profile({{T / 2, j}, {T / 2, j}}, a);
  profile.s.back() = length;
  profile.rate.back() = 0;
  return finish_baseline(request, "cubic", std::move(profile), T, {});
}

BaselineResult quintic(const ProfileRequest& request, double length, double duration_s) {
  const TimeShape shape{[](double t) { return t * t * t * (10 + t * (-15 + 6 * t)); },
                        [](double t) { return 30 * t * t * (1 - t) * (1 - t); }};
  return finish_baseline(request, "quintic", shaped_profile(shape, length, duration_s), duration_s, {});
}

BaselineResult sinusoidal(const ProfileRequest& request, double length, double duration_s) {
  const TimeShape shape{[](double t) { return t - std::sin(2 * pi * t) / (2 * pi); },
                        [](double t) { return 1 - std::cos(2 * pi * t); }};
  return finish_baseline(request, "sinusoidal", shaped_profile(shape, length, duration_s), duration_s, {});
}

/// Pieces of an S-curve: jerk, constant acceleration, jerk back; cruise; the same mirrored.
std::vector<JerkPiece> s_curve_pieces(double rate, double a, double j, double cruise_s) {
  const double full_s = a / j, jerk_s = rate >= a * full_s ? full_s : std::sqrt(rate / j);
  const double flat_s = rate >= a * full_s ? rate / a - full_s : 0.0;
  return {{jerk_s, j}, {flat_s, 0}, {jerk_s, -j}, {cruise_s, 0}, {jerk_s, -j}, {flat_s, 0}, {jerk_s, j}};
}

BaselineResult s_curve(const ProfileRequest& request, double length, double duration_s) {
  const bool turn = is_turn(request.piece);
  const Limits& limits = request.limits;
  const double most =
      turn ? limits.yaw_acceleration_rad_s2 : std::min(limits.acceleration_m_s2, limits.deceleration_m_s2);
  const double a = std::isfinite(most) ? most : 1.0;
  const double j = !turn && std::isfinite(limits.jerk_m_s3) ? limits.jerk_m_s3 : 2 * a;
  const auto ramp_s = [&](double rate) {
    double sum_s = 0;
    for (const JerkPiece& piece : s_curve_pieces(rate, a, j, 0)) sum_s += piece.duration_s;
    return sum_s;
  };
  // Ramps are symmetric: they cover half of rate times their time. The slower root makes the time.
  const auto taken_s = [&](double rate) { return length / rate + 0.5 * ramp_s(rate); };
  double low = length / duration_s, high = low;
  while (high * ramp_s(high) < 2 * length && taken_s(high) > duration_s) high *= 1.02;
  if (taken_s(high) > duration_s || 0.5 * high * ramp_s(high) > length * (1 + 1e-9))
    return no_baseline("s_curve", "no cruise speed makes the time with this acceleration and jerk");
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (taken_s(middle) > duration_s ? low : high) = middle;
  }
  const double cruise_s = std::max(0.0, length / high - 0.5 * ramp_s(high));
  Profile profile = jerk_profile(s_curve_pieces(high, a, j, cruise_s));
  profile.rate.back() = 0;
  return finish_baseline(request, "s_curve", std::move(profile), duration_s,
                         {{unit_key(request, "speed_m_s", "yaw_rate_rad_s"), high},
                          {unit_key(request, "acceleration_m_s2", "yaw_acceleration_rad_s2"), a},
                          {unit_key(request, "jerk_m_s3", "yaw_jerk_rad_s3"), j}});
}

BaselineResult minimum_time_then_wait(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "minimum_time_then_wait";
  ProfileRequest fastest = request;
  fastest.time = {.mode = TimeMode::minimum_time};
  ProfileResult result = solve_profile(fastest);
  if (!result.profile) return no_baseline(kName, result.summary.message);
  const double moving_s = result.profile->duration_s();
  return finish_baseline(request, kName, std::move(*result.profile), duration_s, {{"moving_s", moving_s}});
}

/// Never a motion from rest: counted only where the piece is entered and left at that very speed.
BaselineResult constant_speed(const ProfileRequest& request, double length, double duration_s) {
  const double rate = length / duration_s;
  Profile profile{
      .time_s = {0, duration_s}, .s = {0, length}, .rate = {rate, rate}, .acceleration = {0}, .jerk = {0}};
  BaselineResult result = finish_baseline(request, "constant_speed", std::move(profile), duration_s,
                                          {{unit_key(request, "speed_m_s", "yaw_rate_rad_s"), rate}});
  constexpr double kSame = 1e-6;
  if (std::abs(request.start_rate - rate) > kSame || std::abs(request.end_rate - rate) > kSame) {
    result.feasible = false;
    if (result.reason.empty()) result.reason = "needs a jump of speed at the ends";
  }
  return result;
}

}  // namespace

std::vector<BaselineResult> all_baselines(const ProfileRequest& request, double duration_s) {
  const double length = piece_length(request.piece);
  std::vector<BaselineResult> results{trapezoid_max_acceleration(request, duration_s),
                                      trapezoid_best_tuned(request, duration_s)};
  using Shape = BaselineResult (*)(const ProfileRequest&, double, double);
  const std::pair<const char*, Shape> shapes[] = {
      {"triangular", triangular}, {"constant_ramp", constant_ramp}, {"s_curve", s_curve}, {"cubic", cubic},
      {"quintic", quintic},       {"sinusoidal", sinusoidal}};
  const bool from_rest_to_rest = request.start_rate == 0 && request.end_rate == 0;
  for (const auto& [name, shape] : shapes)
    results.push_back(from_rest_to_rest ? shape(request, length, duration_s)
                                        : no_baseline(name, "runs from rest to rest only"));
  results.push_back(minimum_time_then_wait(request, duration_s));
  results.push_back(constant_speed(request, length, duration_s));
  return results;
}

}  // namespace joulepath
