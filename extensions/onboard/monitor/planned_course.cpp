#include "extensions/onboard/monitor/planned_course.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kRest_m_s = 1e-3;     ///< at the rim
constexpr double kFlicker_m = 1e-3;    ///< travel between two samples at rest that is a tick of the encoder
constexpr double kLeaves_m = 0.02;     ///< travel from a stop that was made
constexpr double kStanding_s = 0.5;    ///< before a standstill counts as a stop
constexpr double kStopWithin_m = 0.3;  ///< of a stop of the plan
constexpr double kStopWithin = 0.05;   ///< of the travel since the last stop
constexpr double kNoTravel_m = 1e-9;

}  // namespace

double rim_speed_m_s(const Geometry& geometry, const Sided<double>& wheel_speed_rad_s) {
  return 0.5 * (std::abs(wheel_speed_rad_s.left) * geometry.wheel_radius_m.left +
                std::abs(wheel_speed_rad_s.right) * geometry.wheel_radius_m.right);
}

PlannedCourse planned_course(const Geometry& geometry, const Trajectory& trajectory) {
  PlannedCourse course;
  course.time_s = trajectory.time_s;
  course.energy_J = trajectory.energy_J;
  const std::size_t rows = trajectory.size();
  course.payload_kg = trajectory.payload_kg;
  course.payload_kg.resize(rows);  // no payload where the plan has none
  double travel_m = 0, before_m_s = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    const double now_m_s = rim_speed_m_s(
        geometry, {trajectory.wheel_speed_rad_s.left[i], trajectory.wheel_speed_rad_s.right[i]});
    if (i > 0) travel_m += 0.5 * (before_m_s + now_m_s) * (course.time_s[i] - course.time_s[i - 1]);
    before_m_s = now_m_s;
    course.travel_m.push_back(travel_m);
    course.leg.push_back(trajectory.leg.empty() ? 0 : static_cast<std::size_t>(trajectory.leg[i]));
  }
  return course;
}

CourseProgress::CourseProgress(const PlannedCourse& course) : course_(&course) {
  for (std::size_t i = 1; i + 1 < course.travel_m.size(); ++i) {
    const bool rests = course.travel_m[i + 1] - course.travel_m[i] <= kNoTravel_m;
    const bool moved = course.travel_m[i] - course.travel_m[i - 1] > kNoTravel_m;
    if (rests && moved) stops_.push_back(i);
  }
}

void CourseProgress::advance(double step_s, double rim_speed_m_s) {
  const std::vector<double>& travel = course_->travel_m;
  travel_m_ += step_s * rim_speed_m_s;
  since_stop_m_ += step_s * rim_speed_m_s;
  since_rest_m_ = rim_speed_m_s > kRest_m_s ? since_rest_m_ + step_s * rim_speed_m_s : 0.0;
  if (since_rest_m_ > kFlicker_m) {
    standing_s_ = rest_clock_s_ = 0;
    // A stop is passed when the robot is surely beyond it: its odometry may read more than the plan's travel,
    // unless it has been seen to stand there.
    const double margin_m = made_stop_ ? kLeaves_m : stop_within_m();
    while (index_ + 1 < travel.size() && travel[index_ + 1] + (waits() ? margin_m : 0.0) <= travel_m_) {
      made_stop_ = made_stop_ && waits();
      ++index_;
    }
    return;
  }
  const bool new_stop = standing_s_ < kStanding_s && standing_s_ + step_s >= kStanding_s;
  standing_s_ += step_s;
  if (new_stop) snap_to_stop();
  wait_with_the_plan(step_s);
}

/// While the robot stands the plan's clock runs through its own stop, and waits at the stop's end.
void CourseProgress::wait_with_the_plan(double step_s) {
  const std::vector<double>& time_s = course_->time_s;
  rest_clock_s_ += step_s;
  while (waits() && time_s[index_ + 1] - time_s[index_] <= rest_clock_s_) {
    rest_clock_s_ -= time_s[index_ + 1] - time_s[index_];
    ++index_;
  }
}

bool CourseProgress::waits() const {
  const std::vector<double>& travel = course_->travel_m;
  return index_ + 1 < travel.size() && travel[index_ + 1] - travel[index_] <= kNoTravel_m;
}

bool CourseProgress::has_arrived() const { return course_->travel_m.back() - travel_m_ <= stop_within_m(); }

double CourseProgress::stop_within_m() const { return std::max(kStopWithin_m, kStopWithin * since_stop_m_); }

void CourseProgress::snap_to_stop() {
  const std::size_t* nearest = nullptr;
  const auto off_m = [&](std::size_t stop) { return std::abs(course_->travel_m[stop] - travel_m_); };
  for (const std::size_t& stop : stops_)
    if (off_m(stop) <= stop_within_m() && (!nearest || off_m(stop) < off_m(*nearest))) nearest = &stop;
  if (!nearest || since_stop_m_ <= kStopWithin_m * kStopWithin) return;
  index_ = std::max(index_, *nearest);
  travel_m_ = course_->travel_m[index_];
  since_stop_m_ = 0;
  made_stop_ = true;
}

double CourseProgress::leg_begin_J(std::size_t leg) const {
  const auto first = std::ranges::find(course_->leg, leg);
  return first == course_->leg.end()
             ? course_->energy_J.back()
             : course_->energy_J[static_cast<std::size_t>(first - course_->leg.begin())];
}

double CourseProgress::at(const std::vector<double>& values) const {
  const std::vector<double>& travel = course_->travel_m;
  if (index_ + 1 >= travel.size()) return values.back();
  const double step_m = travel[index_ + 1] - travel[index_];
  if (step_m <= kNoTravel_m) return values[index_];
  const double share = std::clamp((travel_m_ - travel[index_]) / step_m, 0.0, 1.0);
  return values[index_] + share * (values[index_ + 1] - values[index_]);
}

}  // namespace joulepath
