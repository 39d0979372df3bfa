#include "planner/motion/limit_check.hpp"

#include <cmath>

#include "model/limit_table.hpp"
#include "planner/motion/path_motion.hpp"

namespace joulepath {
namespace {

/// A cap holds inside its interval: at its end the neighbor may already be faster.
constexpr double kBorder_m = 1e-9;

}  // namespace

void for_each_limit_use(const PathMotion& motion, const Limits& limits, const std::vector<SpeedCap>& caps,
                        const ProfileState& state, double jerk,
                        const std::function<void(std::string_view, double)>& use) {
  const PathMotion::Place place = motion.laws(state.s, state.time_s);
  const BodyMotion<double> body = PathMotion::body_motion(place.rates, state.rate, state.acceleration);
  const bool travels = place.rates.along != 0;
  if (travels)
    for (const SpeedCap& cap : caps)
      if (state.s > cap.from_m + kBorder_m && state.s < cap.to_m - kBorder_m && cap.speed_m_s < kNoLimit)
        use("speed", limit_fraction(body.speed_m_s, cap.speed_m_s));
  for_each_limit(
      limit_state(motion.plant(), body, place.site, travels ? state.acceleration : 0.0, travels ? jerk : 0.0),
      limits,
      [&](const Limit& row, double value, double limit) { use(row.name, limit_fraction(value, limit)); });
}

bool acceleration_jumps(const Profile& profile, double& s) {
  constexpr double kJump = 1e-5;  // m/s^2: far above the rounding of sums
  double before = 0;
  for (std::size_t k = 0; k < profile.acceleration.size(); ++k) {
    s = profile.s[k];
    if (std::abs(profile.acceleration[k] - before) > kJump) return true;
    before = profile.acceleration[k] + profile.jerk[k] * (profile.time_s[k + 1] - profile.time_s[k]);
  }
  s = profile.s.back();
  return std::abs(before) > kJump;
}

}  // namespace joulepath
