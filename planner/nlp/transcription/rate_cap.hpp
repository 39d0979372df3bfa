#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "planner/motion/path_motion.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath::nlp {

/// Largest square of the rate at a place, and the limit that determines it.
struct RateCap {
  double squared{kNoLimit};
  std::string_view limit{};
};

/// Speed, yaw rate and lateral acceleration bound the rate alone:
///   u^2 <= (v_max/|along|)^2,  (omega_max/|turn|)^2,  a_lat/|along turn|.
/// In reverse v_max is the lesser one of speed and reverse speed.
inline RateCap rate_cap(const ProfileRequest& request, const PathRates& rates, double s) {
  const Limits& limits = request.limits;
  RateCap cap;
  const auto lower = [&](double squared, std::string_view limit) {
    if (squared < cap.squared) cap = {squared, limit};
  };
  const auto square = [](double x) { return x * x; };
  const double turn = std::abs(rates.turn);
  if (rates.along != 0) {
    lower(square(limits.speed_m_s), "speed");
    if (rates.along < 0) lower(square(limits.reverse_speed_m_s), "reverse_speed");
    for (const SpeedCap& zone : request.speed_caps)
      if (s >= zone.from_m && s <= zone.to_m) lower(square(zone.speed_m_s), "speed");
  }
  if (turn > 0) {
    lower(square(limits.yaw_rate_rad_s / turn), "yaw_rate");
    if (rates.along != 0) lower(limits.lateral_acceleration_m_s2 / turn, "lateral_acceleration");
  }
  return cap;
}

inline double rate_cap_squared(const ProfileRequest& request, const PathRates& rates, double s) {
  return rate_cap(request, rates, s).squared;
}

}  // namespace joulepath::nlp
