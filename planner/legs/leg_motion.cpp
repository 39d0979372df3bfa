#include "planner/legs/leg_motion.hpp"

#include <algorithm>

namespace joulepath {

SampledMotion prescribed_motion(const LegPlan& leg, const Plant& plant) {
  return {plant,
          *leg.prescribed,
          {.time_of_day_s = leg.start_s, .payload_kg = leg.payload.from_kg, .memory = leg.memory}};
}

LegMotion::LegMotion(const LegPlan& leg, const Plant& plant)
    : leg_(&leg), standby_W_(plant.robot.power.standby_W) {
  for (const StretchPlan& stretch : leg.stretches) stretches_.push_back(path_motion(stretch.request));
  if (leg.prescribed && leg.prescribed->size() > 0) prescribed_.emplace(prescribed_motion(leg, plant));
}

double LegMotion::energy_J(double from_s, double to_s) const {
  double sum_J = 0, begin_s = 0;
  if (prescribed_) {
    const double start_s = prescribed_->start_s();
    sum_J =
        energy_between(*prescribed_, start_s + from_s, start_s + std::min(to_s, leg_->duration_s)).total_J();
    begin_s = leg_->duration_s;
  }
  for (std::size_t k = 0; k < stretches_.size(); ++k) {
    const Profile& profile = leg_->stretches[k].profile;
    const double end_s = begin_s + profile.duration_s();
    const double first_s = std::max(from_s, begin_s), last_s = std::min(to_s, end_s);
    if (last_s > first_s)
      sum_J += energy_between(stretches_[k], profile, first_s - begin_s, last_s - begin_s).total_J();
    begin_s = end_s;
  }
  return sum_J + standby_W_ * std::max(0.0, to_s - std::max(from_s, begin_s));
}

}  // namespace joulepath
