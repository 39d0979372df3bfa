#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "planner/baselines/clipped.hpp"
#include "planner/baselines/finish.hpp"
#include "planner/baselines/rounded.hpp"
#include "planner/baselines/shapes.hpp"
#include "planner/profile/profile_solver.hpp"

namespace joulepath {
namespace {

using std::numbers::pi;

std::string unit_key(const ProfileRequest& request, const char* along, const char* turning) {
  return is_turn(request.piece) ? turning : along;
}

using Settings = std::map<std::string, double>;

Profile triangle(double length, double duration_s) {
  const double a = 4 * length / (duration_s * duration_s), half_s = 0.5 * duration_s;
  return {.time_s = {0, half_s, duration_s},
          .s = {0, length / 2, length},
          .rate = {0, a * half_s, 0},
          .acceleration = {a, -a},
          .jerk = {0, 0}};
}

constexpr double kRamp_s = 4.0;  ///< of [P1]'s protocol; shorter if the time is short

/// Accelerate for 4 s, cruise, brake for 4 s.
Profile ramps(double length, double duration_s) {
  const double ramp_s = std::min(kRamp_s, 0.5 * duration_s), rate = length / (duration_s - ramp_s),
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
  return profile;
}

/// Parabola of the rate: the cubic of least jerk-free effort, optimal where there is no viscous friction.
Profile cubic(double length, double duration_s) {
  const double T = duration_s, a = 6 * length / (T * T), j = -2 * a / T;
  Profile profile = jerk_profile({{T / 2, j}, {T / 2, j}}, a);
  profile.s.back() = length;
  profile.rate.back() = 0;
  return profile;
}

Profile quintic(double length, double duration_s) {
  return shaped_profile([](double t) { return 60 * t * (1 - t) * (1 - 2 * t); }, length, duration_s);
}

Profile sinusoidal(double length, double duration_s) {
  return shaped_profile([](double t) { return 2 * pi * std::sin(2 * pi * t); }, length, duration_s);
}

struct RampLimits {
  double a{}, j{};
};

RampLimits ramp_limits(const ProfileRequest& request) {
  const bool turn = is_turn(request.piece);
  const Limits& limits = request.limits;
  const double most =
      turn ? limits.yaw_acceleration_rad_s2 : std::min(limits.acceleration_m_s2, limits.deceleration_m_s2);
  const double a = std::isfinite(most) ? most : 1.0;
  return {a, !turn && std::isfinite(limits.jerk_m_s3) ? limits.jerk_m_s3 : 2 * a};
}

/// Pieces of an S-curve: jerk, constant acceleration, jerk back; cruise; the same mirrored.
std::vector<JerkPiece> s_curve_pieces(double rate, RampLimits ramp, double cruise_s) {
  const auto [a, j] = ramp;
  const double full_s = a / j, jerk_s = rate >= a * full_s ? full_s : std::sqrt(rate / j);
  const double flat_s = rate >= a * full_s ? rate / a - full_s : 0.0;
  return {{jerk_s, j}, {flat_s, 0}, {jerk_s, -j}, {cruise_s, 0}, {jerk_s, -j}, {flat_s, 0}, {jerk_s, j}};
}

/// The S-curve that takes the time; nothing if even the fastest cruise takes longer.
std::optional<Profile> s_curve(RampLimits ramp, double length, double duration_s) {
  const auto ramp_s = [&](double rate) {
    double sum_s = 0;
    for (const JerkPiece& piece : s_curve_pieces(rate, ramp, 0)) sum_s += piece.duration_s;
    return 0.5 * sum_s;
  };
  // Ramps are symmetric: their length is half of the rate times their duration. The search finds the slower
  // root.
  const auto taken_s = [&](double rate) { return length / rate + ramp_s(rate); };
  double low = length / duration_s, high = low;
  while (high * ramp_s(high) < length && taken_s(high) > duration_s) high *= 1.02;
  if (taken_s(high) > duration_s || high * ramp_s(high) > length * (1 + 1e-9)) return std::nullopt;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (taken_s(middle) > duration_s ? low : high) = middle;
  }
  const double cruise_s = std::max(0.0, length / high - ramp_s(high));
  Profile profile = jerk_profile(s_curve_pieces(high, ramp, cruise_s));
  profile.rate.back() = 0;
  return profile;
}

constexpr const char* kFastest = "minimum_time_then_wait";

BaselineResult minimum_time_then_wait(const ProfileRequest& request, double duration_s) {
  ProfileRequest fastest = request;
  fastest.time = {.mode = TimeMode::minimum_time};
  ProfileResult result = solve_profile(fastest);
  if (!result.profile) return no_baseline(kFastest, result.summary.message);
  const double moving_s = result.profile->duration_s();
  return finish_baseline(request, kFastest, std::move(*result.profile), duration_s, {{"moving_s", moving_s}});
}

/// A constant speed, for pieces that begin and end at exactly this speed; it is never a motion from rest and
/// cannot be clipped.
BaselineResult constant_speed(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "constant_speed";
  constexpr double kSame = 1e-6;
  const double length = piece_length(request.piece), rate = length / duration_s;
  if (std::abs(request.start_rate - rate) > kSame || std::abs(request.end_rate - rate) > kSame)
    return no_baseline(kName, "needs a step of speed at the ends");
  Profile profile{
      .time_s = {0, duration_s}, .s = {0, length}, .rate = {rate, rate}, .acceleration = {0}, .jerk = {0}};
  return finish_baseline(request, kName, std::move(profile), duration_s,
                         {{unit_key(request, "speed_m_s", "yaw_rate_rad_s"), rate}});
}

/// A shape from rest to rest over a length in a time; nothing if no shape is so fast.
using Shape = std::optional<Profile> (*)(const ProfileRequest& request, double length, double duration_s);
using SettingsOf = Settings (*)(const ProfileRequest& request, double length, double duration_s);

Baseline from_rest_to_rest(const char* name, Shape shape, SettingsOf settings) {
  return [=](const ProfileRequest& request, double duration_s) {
    if (request.start_rate != 0 || request.end_rate != 0)
      return no_baseline(name, "defined from rest to rest only");
    const double length = piece_length(request.piece);
    return clipped_baseline(
        request, name, [&](double t) { return shape(request, length, t); }, duration_s,
        settings(request, length, duration_s));
  };
}

Settings no_settings(const ProfileRequest&, double, double) { return {}; }

Settings peak_acceleration(const ProfileRequest& request, double length, double T) {
  return {{unit_key(request, "acceleration_m_s2", "yaw_acceleration_rad_s2"), 4 * length / (T * T)}};
}

Settings ramp_time(const ProfileRequest&, double, double T) {
  return {{"ramp_s", std::min(kRamp_s, 0.5 * T)}};
}

Settings s_curve_settings(const ProfileRequest& request, double, double) {
  const RampLimits ramp = ramp_limits(request);
  return {{unit_key(request, "acceleration_m_s2", "yaw_acceleration_rad_s2"), ramp.a},
          {unit_key(request, "jerk_m_s3", "yaw_jerk_rad_s3"), ramp.j}};
}

template <Profile (*shape)(double, double)>
std::optional<Profile> plain(const ProfileRequest&, double length, double T) {
  return shape(length, T);
}

std::optional<Profile> limited_s_curve(const ProfileRequest& request, double length, double T) {
  return s_curve(ramp_limits(request), length, T);
}

/// Under a jerk limit the unclipped S-curve, or the trapezoid of largest acceleration, clipped and rounded.
BaselineResult s_curve_baseline(const ProfileRequest& request, double duration_s) {
  constexpr const char* kName = "s_curve";
  const Baseline clipped = from_rest_to_rest(kName, limited_s_curve, s_curve_settings);
  if (!is_rounded(request) || request.start_rate != 0 || request.end_rate != 0)
    return clipped(request, duration_s);
  if (std::optional<Profile> whole = limited_s_curve(request, piece_length(request.piece), duration_s)) {
    BaselineResult result = finish_baseline(request, kName, std::move(*whole), duration_s,
                                            s_curve_settings(request, 0, duration_s));
    if (result.feasible) return result;
  }
  BaselineResult rounded = rounded_max_acceleration(request, kName, duration_s);
  rounded.parameters["clipped"] = 1;
  return rounded;
}

/// Bisects between a factor of the time that fails and one that works, to a thousandth of the time.
BaselineResult between(const Baseline& baseline, const ProfileRequest& request, double duration_s,
                       std::pair<double, double> factors, BaselineResult works) {
  constexpr double kClose = 1e-3;
  auto [low, high] = factors;
  while (high - low > kClose) {
    const double middle = 0.5 * (low + high);
    BaselineResult trial = baseline(request, middle * duration_s);
    (trial.feasible ? high : low) = middle;
    if (trial.feasible) works = std::move(trial);
  }
  return works;
}

}  // namespace

const std::vector<Baseline>& baselines() {
  static const std::vector<Baseline> all{trapezoid_max_acceleration,
                                         trapezoid_best_tuned,
                                         from_rest_to_rest("triangular", plain<triangle>, peak_acceleration),
                                         from_rest_to_rest("constant_ramp", plain<ramps>, ramp_time),
                                         s_curve_baseline,
                                         from_rest_to_rest("cubic", plain<cubic>, no_settings),
                                         from_rest_to_rest("quintic", plain<quintic>, no_settings),
                                         from_rest_to_rest("sinusoidal", plain<sinusoidal>, no_settings),
                                         minimum_time_then_wait,
                                         constant_speed};
  return all;
}

std::vector<BaselineResult> all_baselines(const ProfileRequest& request, double duration_s) {
  std::vector<BaselineResult> results;
  for (const Baseline& baseline : baselines()) results.push_back(baseline(request, duration_s));
  return results;
}

BaselineResult soonest(const Baseline& baseline, const ProfileRequest& request, double duration_s) {
  BaselineResult in_time = baseline(request, duration_s);
  if (in_time.feasible) return in_time;
  if (in_time.name ==
      kFastest) {  // the same drive for any time, expensive to find: it is late by its own time or never
    const auto moving_s = in_time.parameters.find("moving_s");
    const bool late = moving_s != in_time.parameters.end() && moving_s->second > duration_s;
    return late ? baseline(request, moving_s->second) : in_time;
  }
  double fails = 1;
  for (double factor : {1.01, 1.02, 1.04, 1.07, 1.1, 1.2, 1.4}) {
    BaselineResult later = baseline(request, factor * duration_s);
    if (later.feasible) return between(baseline, request, duration_s, {fails, factor}, std::move(later));
    fails = factor;
  }
  return in_time;
}

}  // namespace joulepath
