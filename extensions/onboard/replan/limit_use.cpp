#include "extensions/onboard/replan/limit_use.hpp"

#include <algorithm>
#include <cmath>

#include "model/limit_table.hpp"

namespace joulepath {

void CommandAudit::add(double time_s, double speed_m_s, double yaw_rate_rad_s, double payload_kg) {
  Command now{time_s, speed_m_s, yaw_rate_rad_s, payload_kg, {}};
  const double period_s = last_ ? time_s - last_->time_s : 0.0;
  if (period_s > 0) {
    const double acceleration = (speed_m_s - last_->speed_m_s) / period_s;
    const double gain = (std::abs(speed_m_s) - std::abs(last_->speed_m_s)) / period_s;
    const double turning = (yaw_rate_rad_s - last_->yaw_rate_rad_s) / period_s;
    const double jerk = (gain - last_->gain_m_s2.value_or(0.0)) / period_s;
    look({last_->speed_m_s, acceleration, last_->yaw_rate_rad_s, turning}, gain, jerk, last_->payload_kg,
         time_s);
    look({speed_m_s, acceleration, yaw_rate_rad_s, turning}, gain, jerk, last_->payload_kg, time_s);
    now.gain_m_s2 = gain;
  }
  last_ = now;
}

void CommandAudit::look(const BodyMotion<double>& motion, double gain_m_s2, double jerk_m_s3,
                        double payload_kg, double time_s) {
  const Site site =
      site_of(plant_.robot.geometry, {}, payload_kg, motion.speed_m_s, motion.yaw_rate_rad_s, time_s);
  const LimitState state = limit_state(plant_, motion, site, gain_m_s2, jerk_m_s3);
  const Limits limits = limits_for_payload(plant_.robot, payload_kg);
  for_each_limit(state, limits, [&](const Limit& row, double value, double limit) {
    auto use =
        std::find_if(uses_.begin(), uses_.end(), [&](const LimitUse& u) { return u.limit == row.name; });
    if (use == uses_.end()) use = uses_.insert(uses_.end(), {std::string(row.name), 0.0, time_s});
    const double fraction = limit_fraction(value, limit);
    if (fraction > use->fraction) *use = {std::string(row.name), fraction, time_s};
  });
}

}  // namespace joulepath
