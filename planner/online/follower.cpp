#include "planner/online/follower.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kClockGain_per_s = 2.0;  ///< with which the clock follows the place
constexpr double kPlaceGain_per_s = 1.0;  ///< of the rate, against the distance to where it should be
constexpr double kSamePayload_kg = 0.05;
constexpr double kArrived = 0.01;    ///< m or rad
constexpr double kPatience_s = 0.4;  ///< after the profile's end
constexpr double kAtRest = 0.02;     ///< m/s or rad/s

double sinc(double x) { return std::abs(x) < 1e-6 ? 1.0 : std::sin(x) / x; }

}  // namespace

Follower::Follower(const ProfileRequest& request, const Profile& plan, double deadline_s,
                   const FollowerSettings& settings)
    : request_(request),
      settings_(settings),
      replanner_(request_, plan),
      plan_(plan),
      profile_(&plan_),
      deadline_s_(deadline_s),
      projection_(request_.piece),
      last_payload_kg_(request.payload.from_kg) {}

FollowCommand Follower::command(const Measurement& measured) {
  FollowCommand command;
  look(measured, command);
  const bool turn = is_turn(request_.piece);
  if (std::abs(command.lateral_m) > settings_.off_path_m ||
      (!turn && std::abs(command.heading_error_rad) > settings_.off_path_rad)) {
    hand_over(measured, command);
    return command;
  }
  advance_clock(measured);
  const Profile& now = *profile_;
  // The clock is drawn to the place: a robot that is held back does not run out of profile.
  if (profile_time_s_ < now.time_s.back())
    profile_time_s_ +=
        kClockGain_per_s * settings_.period_s *
        (now.at_s(std::clamp(command.s, now.s.front(), now.s.back())).time_s - profile_time_s_);
  profile_time_s_ = std::clamp(profile_time_s_, 0.0, now.time_s.back() + kPatience_s);
  shift_s_ = measured.time_s + now.time_s.back() - profile_time_s_ - deadline_s_;
  if (has_to_replan(measured)) replan(measured, command);
  command.late_s = std::isfinite(deadline_s_) ? std::max(0.0, shift_s_) : 0.0;
  steer(measured, command);
  const bool to_end = !last_stop_m_ && profile_->s.back() >= replanner_.length() - kArrived;
  const double over_s = profile_time_s_ - profile_->time_s.back();
  const bool there = command.s >= replanner_.length() - kArrived;
  if (to_end && request_.end_rate == 0 && over_s >= (there ? -1e-9 : kPatience_s - 1e-9)) {
    command.speed_m_s = command.yaw_rate_rad_s = 0;
    command.acceleration_m_s2 = command.yaw_acceleration_rad_s2 = 0;
    if (rate_of(measured) < kAtRest) command.state = FollowState::finished;
  }
  return command;
}

double Follower::off_rate() const {
  return is_turn(request_.piece) ? settings_.off_yaw_rate_rad_s : settings_.off_speed_m_s;
}

double Follower::rate_of(const Measurement& measured) const {
  const bool turn = is_turn(request_.piece);
  const double rate = turn ? turn_sign(request_.piece) * measured.yaw_rate_rad_s
                           : travel_sign(request_.piece) * measured.speed_m_s;
  return std::max(0.0, rate);
}

void Follower::look(const Measurement& measured, FollowCommand& command) {
  const double elapsed_s = last_time_s_ ? measured.time_s - *last_time_s_ : 0.0;
  const PathOffset offset = projection_.look(measured.pose, rate_of(measured) * std::max(0.0, elapsed_s));
  command.s = offset.s;
  command.lateral_m = offset.lateral_m;
  command.heading_error_rad = offset.heading_error_rad;
}

void Follower::advance_clock(const Measurement& measured) {
  if (last_time_s_) profile_time_s_ += std::max(0.0, measured.time_s - *last_time_s_);
  last_time_s_ = measured.time_s;
}

bool Follower::has_to_replan(const Measurement& measured) const {
  if (measured.speed_limit_m_s != last_limit_m_s_ || measured.stop_at_m != last_stop_m_) return true;
  if (std::abs(measured.payload_kg - last_payload_kg_) > kSamePayload_kg) return true;
  const double end_s = profile_->time_s.back();
  if (profile_time_s_ >= end_s - settings_.latency_s - settings_.period_s) {
    const bool stopped_short = profile_->s.back() < replanner_.length() - kArrived && !last_stop_m_;
    return stopped_short && profile_time_s_ >= end_s;
  }
  const ProfileState due = profile_->at_time(profile_time_s_);
  return shift_s_ > settings_.late_s || std::abs(due.rate - rate_of(measured)) > off_rate();
}

void Follower::replan(const Measurement& measured, FollowCommand& command) {
  const ProfileState due = profile_->at_time(std::min(profile_time_s_, profile_->time_s.back()));
  const double measured_rate = rate_of(measured);
  // Small differences are the drives' business: the profile goes on smoothly from what is due.
  const bool off = std::abs(due.rate - measured_rate) > off_rate();
  const SpeedCap cap{0, replanner_.length(), measured.speed_limit_m_s.value_or(0)};
  Situation situation{.s = command.s,
                      .rate = off ? measured_rate : due.rate,
                      .acceleration = due.acceleration,
                      .payload_kg = measured.payload_kg,
                      .time_left_s = deadline_s_ - measured.time_s,
                      .stop_at = measured.stop_at_m.value_or(kNoLimit)};
  if (measured.speed_limit_m_s) situation.speed_caps = {&cap, 1};
  const Replan& fresh = replanner_.replan(situation, settings_.budget);
  profile_ = fresh.profile;
  profile_time_s_ = 0;
  shift_s_ = measured.time_s + fresh.duration_s - deadline_s_;
  last_limit_m_s_ = measured.speed_limit_m_s;
  last_stop_m_ = measured.stop_at_m;
  last_payload_kg_ = measured.payload_kg;
  command.replanned = true;
}

/// Kinematic control about the path: with e the lateral and h the heading error, l the convergence length,
///   omega = kappa u cos h/(1 - kappa e) - v e sinc(h)/l^2 - 2 |v| h/l,
/// for which e^2/l^2 + h^2 never grows.                    [Samson 1993, path following of a unicycle]
void Follower::steer(const Measurement& measured, FollowCommand& command) const {
  const double end_s = profile_->time_s.back();
  const double ahead_s = profile_time_s_ + settings_.latency_s;
  const ProfileState due = profile_->at_time(std::min(profile_time_s_, end_s));
  ProfileState next = profile_->at_time(std::min(ahead_s, end_s));
  if (ahead_s >= end_s) next.acceleration = 0;
  double rate = std::max(0.0, next.rate + kPlaceGain_per_s * (due.s - command.s));
  if (measured.speed_limit_m_s && !is_turn(request_.piece) && next.rate <= *measured.speed_limit_m_s)
    rate = std::min(rate, *measured.speed_limit_m_s);
  if (is_turn(request_.piece)) {
    command.yaw_rate_rad_s = turn_sign(request_.piece) * rate;
    command.yaw_acceleration_rad_s2 = turn_sign(request_.piece) * next.acceleration;
    return;
  }
  const PathPoint place = piece_point(request_.piece, next.s);
  const double v = travel_sign(request_.piece) * rate, e = command.lateral_m, h = command.heading_error_rad;
  const double l = settings_.convergence_m;
  const double foot = std::max(0.2, 1 - travel_sign(request_.piece) * place.curvature_per_m * e);
  double yaw_rate =
      place.curvature_per_m * rate * std::cos(h) / foot - v * e * sinc(h) / (l * l) - 2 * std::abs(v) * h / l;
  const double most = request_.limits.yaw_rate_rad_s;
  const double share = std::abs(yaw_rate) > most ? most / std::abs(yaw_rate) : 1.0;
  command.speed_m_s = share * v;
  command.yaw_rate_rad_s = share * yaw_rate;
  command.acceleration_m_s2 = travel_sign(request_.piece) * next.acceleration;
  command.yaw_acceleration_rad_s2 =
      place.curvature_per_m * next.acceleration + place.curvature_slope_per_m2 * rate * rate;
}

/// Brakes on the present course at the limit of deceleration.
void Follower::hand_over(const Measurement& measured, FollowCommand& command) const {
  command.state = FollowState::off_path;
  const double rate = std::abs(measured.speed_m_s);
  const double lost = request_.limits.deceleration_m_s2 * (settings_.period_s + settings_.latency_s);
  const double share = rate > lost ? 1 - lost / rate : 0.0;
  command.speed_m_s = share * measured.speed_m_s;
  command.yaw_rate_rad_s = share * measured.yaw_rate_rad_s;
}

}  // namespace joulepath
