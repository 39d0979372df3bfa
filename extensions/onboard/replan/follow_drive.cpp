#include "extensions/onboard/replan/follow_drive.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "model/kinematics.hpp"

namespace joulepath {
namespace {

constexpr double kSample_s = 0.02;
constexpr double kSameInstant_s = 1e-9;
constexpr double kMostOvertime_s = 120.0;  ///< after the plan's end

DriveState standing_at(const Pose& pose) {
  DriveState state{};
  state[kX] = pose.x_m;
  state[kY] = pose.y_m;
  state[kYaw] = pose.heading_rad;
  return state;
}

/// The first rows of a log as FollowRun::record() writes it.
void keep_rows(Trajectory& log, std::size_t rows) {
  for (std::vector<double>* column :
       {&log.time_s, &log.linear_speed_m_s, &log.angular_speed_rad_s, &log.position_x_m, &log.position_y_m,
        &log.heading_rad, &log.payload_kg, &log.battery_power_W, &log.energy_J})
    column->resize(rows);
  for (const Side side : kSides)
    for (Sided<std::vector<double>>* column :
         {&log.wheel_speed_rad_s, &log.motor_voltage_V, &log.motor_current_A, &log.motor_power_W})
      (*column)[side].resize(rows);
}

class FollowRun {
 public:
  explicit FollowRun(const FollowRequest& request)
      : request_(request),
        controller_(request.controller, request.robot),
        audit_(make_plant(request.robot)),
        integrator_(Drive(make_plant(request.robot, request.effects), 0.0), standing_at(request.start), {}) {}

  FollowResult drive() {
    const double period_s = request_.controller.period_s;
    const double most_s = plan_end_s() + kMostOvertime_s;
    std::size_t tick = 0, sample = 0, look = 0;
    while (integrator_.time_s() < most_s && !done()) {
      const double t = integrator_.time_s();
      if (t > look * request_.follower.period_s - kSameInstant_s) command(t), ++look;
      if (t > tick * period_s - kSameInstant_s) control(t), ++tick;
      if (t > sample * kSample_s - kSameInstant_s) record(t), ++sample;
      slip(t);
      integrator_.advance_to(
          std::min({tick * period_s, sample * kSample_s, look * request_.follower.period_s}));
      watch_rest();
    }
    record(integrator_.time_s());
    return finish();
  }

 private:
  bool done() const {
    return result_.off_path ? integrator_.at_rest() || integrator_.time_s() > plan_end_s()
                            : piece_ >= request_.pieces.size() && integrator_.time_s() >= plan_end_s();
  }

  /// The plan's time on the simulation's clock, which begins with the first pose.
  double clock_s(double plan_s) const { return plan_s + request_.follower.latency_s; }
  double plan_end_s() const { return clock_s(request_.end_s); }

  Pose pose() const {
    const DriveState& state = integrator_.state();
    return {state[kX], state[kY], state[kYaw]};
  }

  template <class Use>
  void for_each_active(Disturbance::Kind kind, double t, Use&& use) {
    for (std::size_t i = 0; i < request_.disturbances.size(); ++i) {
      const Disturbance& d = request_.disturbances[i];
      if (d.kind == kind && t >= clock_s(d.at_s) && t < clock_s(d.at_s + d.for_s)) use(d, i);
    }
  }

  /// Seconds by which the robot is held back at the start.
  double late_start_s() const {
    for (const Disturbance& d : request_.disturbances)
      if (d.kind == Disturbance::Kind::late_start) return d.size;
    return 0.0;
  }

  double payload_factor(double t, bool as_known) const {
    for (const Disturbance& d : request_.disturbances)
      if (d.kind == Disturbance::Kind::payload && t >= clock_s(d.at_s + (as_known ? d.for_s : 0.0)))
        return d.size;
    return 1.0;
  }

  double planned_kg() const {
    if (request_.pieces.empty()) return 0.0;
    const std::size_t at = std::min(piece_, request_.pieces.size() - 1);
    return request_.pieces[at].request->payload.from_kg;
  }

  Measurement measured(double t) {
    const DriveState& state = integrator_.state();
    const FollowedPiece& piece = request_.pieces[piece_];
    const PathMotion motion = path_motion(*piece.request);
    Measurement m{.time_s = t - clock_s(piece.start_s),
                  .pose = pose(),
                  .speed_m_s = state[kVelocity + kTravel],
                  .yaw_rate_rad_s = state[kVelocity + kTurn],
                  .payload_kg = payload_factor(t, true) * motion.payload_kg(last_.s)};
    for_each_active(Disturbance::Kind::speed_limit, t,
                    [&](const Disturbance& d, std::size_t) { m.speed_limit_m_s = d.size; });
    stop_places_.resize(request_.disturbances.size());
    for_each_active(Disturbance::Kind::obstacle, t, [&](const Disturbance& d, std::size_t i) {
      if (!stop_places_[i]) stop_places_[i] = {piece_, last_.s + d.size};
      if (stop_places_[i]->first == piece_ && stop_places_[i]->second < motion.length())
        m.stop_at_m = stop_places_[i]->second;
    });
    return m;
  }

  void command(double t) {
    if (piece_ >= request_.pieces.size() || t < late_start_s()) return;
    const FollowedPiece& piece = request_.pieces[piece_];
    if (!follower_) {
      if (t < piece.start_s - kSameInstant_s) return;  // a latency before the piece is due
      follower_ = std::make_unique<Follower>(*piece.request, *piece.plan, piece.deadline_s - piece.start_s,
                                             request_.follower);
      last_ = {};
    }
    const Measurement now = measured(t);
    last_ = follower_->command(now);
    result_.replans += last_.replanned;
    result_.worst_lateral_m = std::max(result_.worst_lateral_m, std::abs(last_.lateral_m));
    pending_.push_back({t + request_.follower.latency_s, last_, now.payload_kg});
    if (last_.state == FollowState::off_path) result_.off_path = true;
    result_.stopped_by = last_.stopped_by;
    if (last_.state == FollowState::finished) arrive(t);
  }

  void arrive(double t) {
    result_.late_s = std::max(result_.late_s, t - clock_s(request_.pieces[piece_].deadline_s));
    result_.arrived_s = t;
    ++result_.finished;
    ++piece_;
    follower_.reset();
  }

  void control(double t) {
    while (!pending_.empty() && pending_.front().at_s <= t + kSameInstant_s) {
      active_ = pending_.front().command;
      active_since_s_ = pending_.front().at_s;
      audit_.add(active_since_s_, active_.speed_m_s, active_.yaw_rate_rad_s, pending_.front().payload_kg);
      pending_.pop_front();
    }
    const double since_s = std::min(t - active_since_s_, request_.follower.period_s);
    const auto held = [&](double value, double slope) { return value + since_s * slope; };
    const BodyMotion<double> motion{
        held(active_.speed_m_s, active_.acceleration_m_s2), active_.acceleration_m_s2,
        held(active_.yaw_rate_rad_s, active_.yaw_acceleration_rad_s2), active_.yaw_acceleration_rad_s2};
    const double stated_kg = planned_kg();
    const Site site =
        site_of(request_.robot.geometry, pose(), stated_kg, motion.speed_m_s, motion.yaw_rate_rad_s, t);
    const DriveState& state = integrator_.state();
    const Sided<double> wheels{state[kVelocity + kLeftWheel], state[kVelocity + kRightWheel]};
    const Sided<Motor>& motor = request_.robot.motor;
    DriveInput input{.payload_kg = payload_factor(t, false) * stated_kg};
    input.voltage_V =
        controller_.command_V(motion, site, wheels, {motor.left.max_voltage_V, motor.right.max_voltage_V});
    for_each_active(Disturbance::Kind::push, t,
                    [&](const Disturbance& d, std::size_t) { input.push_N += d.size; });
    integrator_.drive().set_input(input);
  }

  void slip(double t) {
    slipped_.resize(request_.disturbances.size());
    for (std::size_t i = 0; i < request_.disturbances.size(); ++i) {
      const Disturbance& d = request_.disturbances[i];
      if (d.kind != Disturbance::Kind::slip || slipped_[i] || t < clock_s(d.at_s)) continue;
      slipped_[i] = true;
      integrator_.displace(-d.size, d.size / 3);
    }
  }

  void record(double t) {
    const DriveState& state = integrator_.state();
    const Drive::Instant instant = integrator_.instant();
    Trajectory& log = result_.executed;
    if (!log.time_s.empty() && t <= log.time_s.back() + kSameInstant_s) return;
    log.time_s.push_back(t);
    log.linear_speed_m_s.push_back(state[kVelocity + kTravel]);
    log.angular_speed_rad_s.push_back(state[kVelocity + kTurn]);
    for (const Side side : kSides) {
      log.wheel_speed_rad_s[side].push_back(state[kVelocity + surface_of(side)]);
      log.motor_voltage_V[side].push_back(instant.voltage_V[side]);
      log.motor_current_A[side].push_back(instant.current_A[side]);
      log.motor_power_W[side].push_back(instant.voltage_V[side] * instant.current_A[side]);
    }
    log.position_x_m.push_back(state[kX]);
    log.position_y_m.push_back(state[kY]);
    log.heading_rad.push_back(state[kYaw]);
    log.payload_kg.push_back(planned_kg());
    log.battery_power_W.push_back(instant.derivative[kBatteryEnergy]);
    log.energy_J.push_back(state[kBatteryEnergy]);
  }

  /// Remembers since when the robot stands.
  void watch_rest() {
    if (!integrator_.at_rest())
      rest_.reset();
    else if (!rest_)
      rest_ = Rest{integrator_.state()[kBatteryEnergy],
                   result_.executed.size() + 1,
                   {integrator_.time_s(), piece_, last_.s, pose()}};
  }

  /// A drive that did not arrive ends where it stopped.
  void end_at_stop() {
    if (result_.finished == request_.pieces.size() || !rest_) return;
    result_.stopped = rest_->stop;
    result_.energy_J = rest_->energy_J;
    result_.duration_s = rest_->stop.time_s;
    keep_rows(result_.executed, std::min(rest_->rows, result_.executed.size()));
  }

  FollowResult finish() {
    result_.energy_J = integrator_.state()[kBatteryEnergy];
    result_.duration_s = integrator_.time_s();
    result_.limits = audit_.uses();
    end_at_stop();
    if (request_.pieces.empty()) return std::move(result_);
    const PathPiece& last = request_.pieces.back().request->piece;
    const Pose end = piece_point(last, piece_length(last)).pose;
    result_.end_error_m = std::hypot(pose().x_m - end.x_m, pose().y_m - end.y_m);
    result_.end_error_rad = std::abs(wrapped_angle_rad(pose().heading_rad - end.heading_rad));
    if (result_.finished < request_.pieces.size()) result_.late_s = kNoLimit;
    return std::move(result_);
  }

  struct Pending {
    double at_s{};
    FollowCommand command{};
    double payload_kg{};  ///< as measured
  };

  struct Rest {
    double energy_J{};
    std::size_t rows{};  ///< of the log until then
    FollowStop stop{};
  };

  const FollowRequest& request_;
  std::optional<Rest> rest_{};
  WheelController controller_;
  CommandAudit audit_;
  DriveIntegrator integrator_;
  std::unique_ptr<Follower> follower_{};
  std::deque<Pending> pending_{};
  FollowCommand active_{}, last_{};
  double active_since_s_{};
  std::vector<std::optional<std::pair<std::size_t, double>>> stop_places_{};
  std::vector<bool> slipped_{};
  std::size_t piece_{};
  FollowResult result_{};
};

}  // namespace

FollowResult follow(const FollowRequest& request) { return FollowRun(request).drive(); }

}  // namespace joulepath
