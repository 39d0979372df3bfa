#include "extensions/onboard/replan/follower.hpp"

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
constexpr double kSameTime_s = 1e-9;
constexpr double kSlowest = 0.9;  ///< of the profile's rate, for the sake of the course
constexpr double kSlips = 0.25;   ///< if less of the wheels' difference from the profile is in the pose

double sinc(double x) { return std::abs(x) < 1e-6 ? 1.0 : std::sin(x) / x; }

CommandedMotion first_command(const ProfileRequest& request, const Profile& plan) {
  const double rate = plan.rate.front();
  if (is_turn(request.piece)) return {.yaw_rate_rad_s = turn_sign(request.piece) * rate};
  return {.rate = rate, .yaw_rate_rad_s = rate * piece_point(request.piece, 0).curvature_per_m};
}

}  // namespace

Follower::Follower(const ProfileRequest& request, const Profile& plan, double deadline_s,
                   const FollowerSettings& settings)
    : request_(request),
      settings_(settings),
      limits_(request.plant.robot, request.limits, request.payload),
      replanner_(request_, plan),
      plan_(plan),
      profile_(&plan_),
      deadline_s_(deadline_s),
      projection_(request_.piece),
      shaper_(request.plant, travel_sign(request_.piece), first_command(request_, plan)),
      last_payload_kg_(request.payload.from_kg) {}

FollowCommand Follower::command(const Measurement& measured) {
  FollowCommand command;
  const double elapsed_s = last_time_s_ ? std::max(0.0, measured.time_s - *last_time_s_) : 0.0;
  shaper_.advance(std::min(elapsed_s, settings_.period_s));
  look(measured, elapsed_s, command);
  advance_clock(measured, elapsed_s, command.s);
  const bool turn = is_turn(request_.piece);
  if (handed_over_ || std::abs(command.lateral_m) > settings_.off_path_m ||
      (!turn && std::abs(command.heading_error_rad) > settings_.off_path_rad)) {
    hand_over(measured, command);
    return command;
  }
  shift_s_ = measured.time_s + profile_->time_s.back() - profile_time_s_ - deadline_s_;
  if (has_to_replan(measured)) replan(measured, command);
  command.stopped_by = stopped_by_;
  command.late_s = std::isfinite(deadline_s_) ? std::max(0.0, shift_s_) : 0.0;
  steer(measured, command);
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

void Follower::look(const Measurement& measured, double elapsed_s, FollowCommand& command) {
  const PathOffset offset = projection_.look(measured.pose, rate_of(measured) * elapsed_s);
  pose_rate_ = elapsed_s > 0 ? (offset.s - place_) / elapsed_s : rate_of(measured);
  place_ = offset.s;
  command.s = offset.s;
  command.lateral_m = offset.lateral_m;
  command.heading_error_rad = offset.heading_error_rad;
}

/// The clock is drawn to the place: a robot that is held back does not run out of profile.
void Follower::advance_clock(const Measurement& measured, double elapsed_s, double s) {
  if (!last_time_s_) profile_time_s_ = std::clamp(measured.time_s, -settings_.latency_s, 0.0);
  last_time_s_ = measured.time_s;
  profile_time_s_ += elapsed_s;
  const Profile& now = *profile_;
  if (profile_time_s_ > 0 && profile_time_s_ < now.time_s.back())
    profile_time_s_ += kClockGain_per_s * settings_.period_s *
                       (now.at_s(std::clamp(s, now.s.front(), now.s.back())).time_s - profile_time_s_);
  profile_time_s_ = std::min(profile_time_s_, now.time_s.back() + kPatience_s);
}

bool Follower::has_to_replan(const Measurement& measured) const {
  if (measured.speed_limit_m_s != last_limit_m_s_ || measured.stop_at_m != last_stop_m_) return true;
  if (std::abs(measured.payload_kg - last_payload_kg_) > kSamePayload_kg) return true;
  const double end_s = profile_->time_s.back();
  if (profile_time_s_ >= end_s - settings_.latency_s - settings_.period_s) {
    const bool stopped_short = profile_->s.back() < replanner_.length() - kArrived && !last_stop_m_;
    return stopped_short && profile_time_s_ >= end_s;
  }
  const ProfileState due = profile_->at_time(std::max(0.0, profile_time_s_));
  return shift_s_ > accepted_s_ + settings_.late_s || is_off(measured, due.rate);
}

/// Off the rate that is due, as the wheels and the pose say. Where they contradict each other, wheels slip.
bool Follower::is_off(const Measurement& measured, double due_rate) const {
  const double by_wheels = rate_of(measured) - due_rate, by_pose = pose_rate_ - due_rate;
  return std::abs(by_wheels) > off_rate() && by_wheels * by_pose > kSlips * by_wheels * by_wheels;
}

void Follower::replan(const Measurement& measured, FollowCommand& command) {
  const ProfileState due = profile_->at_time(std::clamp(profile_time_s_, 0.0, profile_->time_s.back()));
  const double measured_rate = rate_of(measured);
  // Small differences are the drives' business: the profile goes on from what is due.
  const bool off = is_off(measured, due.rate);
  const double rate = off ? measured_rate : due.rate, s = off ? command.s : due.s;
  const SpeedCap cap{0, replanner_.length(), measured.speed_limit_m_s.value_or(0)};
  Situation situation{.s = s,
                      .rate = rate,
                      .acceleration = due.acceleration,
                      .payload_kg = measured.payload_kg,
                      .time_left_s = deadline_s_ - measured.time_s};
  if (measured.stop_at_m) situation.stop_at = std::max(s, *measured.stop_at_m - lost_to_jerk(measured, rate));
  if (measured.speed_limit_m_s) situation.speed_caps = {&cap, 1};
  const Replan& fresh = replanner_.replan(situation, settings_.budget);
  profile_ = fresh.profile;
  profile_time_s_ = 0;
  shift_s_ = measured.time_s + fresh.duration_s - deadline_s_;
  accepted_s_ = std::max(0.0, shift_s_);
  last_limit_m_s_ = measured.speed_limit_m_s;
  last_stop_m_ = measured.stop_at_m;
  last_payload_kg_ = measured.payload_kg;
  stopped_by_ = fresh.status == ReplanStatus::stopping ? fresh.limit : std::string_view{};
  command.replanned = true;
}

/// Way (m) by which a stop at the limit of deceleration is longer while the deceleration grows at the limit
/// of jerk: v d/(2 j).
double Follower::lost_to_jerk(const Measurement& measured, double rate) const {
  const Limits limits = limits_for(measured);
  const bool counts = std::isfinite(limits.jerk_m_s3) && !is_turn(request_.piece);
  return counts ? rate * limits.deceleration_m_s2 / (2 * limits.jerk_m_s3) : 0.0;
}

Limits Follower::limits_for(const Measurement& measured) const {
  return limits_.between(measured.payload_kg, measured.payload_kg);
}

/// The profile has led to the end: what is left is standing.
bool Follower::ends(const FollowCommand& command) const {
  const bool to_end = !last_stop_m_ && profile_->s.back() >= replanner_.length() - kArrived;
  const bool there = command.s >= replanner_.length() - kArrived;
  const double over_s = (there ? ahead_s() : profile_time_s_ - kPatience_s) - profile_->time_s.back();
  return to_end && request_.end_rate == 0 && over_s >= -kSameTime_s;
}

/// On the profile when the coming command ends.
double Follower::ahead_s() const { return profile_time_s_ + settings_.latency_s + settings_.period_s; }

/// Rates that are due at the end of the coming period and, under a jerk limit, thereafter.
std::span<const double> Follower::wanted_rates(const Measurement& measured, const FollowCommand& command,
                                               double spacing_s) {
  const Profile& now = *profile_;
  const double end_s = now.time_s.back();
  const double due = now.at_time(std::clamp(profile_time_s_, 0.0, end_s)).s;
  const bool to_stand = command.state == FollowState::off_path || ends(command);
  const std::size_t count = spacing_s > 0 ? wanted_.size() : 1;
  for (std::size_t m = 0; m < count; ++m) {
    const double at_s = ahead_s() + static_cast<double>(m) * spacing_s;
    const double rate = now.at_time(std::min(at_s, end_s)).rate;
    wanted_[m] = to_stand ? 0.0 : std::max(0.0, rate + kPlaceGain_per_s * (due - command.s));
    if (measured.speed_limit_m_s && !is_turn(request_.piece) && rate <= *measured.speed_limit_m_s)
      wanted_[m] = std::min(wanted_[m], *measured.speed_limit_m_s);
  }
  return {wanted_.data(), count};
}

/// Kinematic control about the path: with e the lateral and h the heading error, l the convergence length,
///   omega/|v| = kappa cos h/(1 - kappa e) -+ e sinc(h)/l^2 - 2 h/l,
/// for which e^2/l^2 + h^2 never grows.                    [Samson1993]
double Follower::yaw_per_meter(const FollowCommand& command) const {
  const ProfileState next = profile_->at_time(std::clamp(ahead_s(), 0.0, profile_->time_s.back()));
  const double kappa = piece_point(request_.piece, next.s).curvature_per_m;
  const double e = command.lateral_m, h = command.heading_error_rad, l = settings_.convergence_m;
  const int sign = travel_sign(request_.piece);
  const double foot = std::max(0.2, 1 - sign * kappa * e);
  return kappa * std::cos(h) / foot - sign * e * sinc(h) / (l * l) - 2 * h / l;
}

void Follower::steer(const Measurement& measured, FollowCommand& command) {
  const Limits limits = limits_for(measured);
  const double period_s = settings_.period_s;
  if (is_turn(request_.piece)) {
    shaper_.turn(limits, turn_sign(request_.piece) * wanted_rates(measured, command, 0).front(), period_s);
  } else {
    const std::span<const double> wanted =
        wanted_rates(measured, command, CommandShaper::spacing_s(limits, period_s));
    const double per_m = yaw_per_meter(command);
    wanted_[0] =
        std::min(wanted_[0], std::max(kSlowest * wanted_[0], shaper_.fastest_on(per_m, limits, period_s)));
    shaper_.turn(limits, shaper_.accelerate(limits, wanted, period_s) * per_m, period_s);
  }
  send(measured, limits, command);
  if (ends(command) && shaper_.at_rest() && rate_of(measured) < kAtRest)
    command.state = FollowState::finished;
}

void Follower::send(const Measurement& measured, const Limits& limits, FollowCommand& command) {
  shaper_.keep_drives(limits, measured.payload_kg, settings_.period_s);
  const CommandedMotion& now = shaper_.now();
  const int sign = travel_sign(request_.piece);
  command.speed_m_s = sign * now.rate;
  command.acceleration_m_s2 = sign * now.acceleration_m_s2;
  command.yaw_rate_rad_s = now.yaw_rate_rad_s;
  command.yaw_acceleration_rad_s2 = now.yaw_acceleration_rad_s2;
}

/// Brakes on the present course.
void Follower::hand_over(const Measurement& measured, FollowCommand& command) {
  command.state = FollowState::off_path;
  handed_over_ = true;
  const Limits limits = limits_for(measured);
  const double period_s = settings_.period_s;
  const double spacing_s = is_turn(request_.piece) ? 0 : CommandShaper::spacing_s(limits, period_s);
  const double rate = shaper_.now().rate, yaw_rate_rad_s = shaper_.now().yaw_rate_rad_s;
  const double then = shaper_.accelerate(limits, wanted_rates(measured, command, spacing_s), period_s);
  shaper_.turn(limits, rate > 0 ? yaw_rate_rad_s * then / rate : 0.0, period_s);
  send(measured, limits, command);
}

}  // namespace joulepath
