#include "planner/accounts/plan_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "planner/legs/leg_motion.hpp"

namespace joulepath {
namespace {

/// A plan of more than 2.8 hours at 50 Hz is sampled more slowly, so that its memory is bounded.
constexpr double kMostSamples = 5e5;

/// What one sample of the trajectory holds, whatever it comes from.
struct Sample {
  BodyMotion<double> motion{};
  Site site{};
  double arc_length_m{};
  double curvature_per_m{};
};

Sample sample_stretch(const StretchPlan& stretch, const PathMotion& path, double time_s, double offset_m) {
  const ProfileState state = stretch.profile.at_time(time_s);
  const PathRates rates = path.rates(state.s);
  const bool turn = is_turn(stretch.request.piece);
  return {.motion = PathMotion::body_motion(rates, state.rate, state.acceleration),
          .site = path.site(state.s, state.time_s),
          .arc_length_m = offset_m + (turn ? 0.0 : state.s),
          .curvature_per_m = turn ? 0.0 : piece_point(stretch.request.piece, state.s).curvature_per_m};
}

/// State of a leg `elapsed_s` after its departure; at rest at its end during dwell.
Sample sample_leg(const LegPlan& leg, const LegMotion& motion, double elapsed_s) {
  if (leg.prescribed) {
    const double time_s = leg.prescribed->time_s.front() + elapsed_s;
    const SampledState state = sampled_state(*leg.prescribed, time_s);
    const MotionInstant instant = motion.prescribed()->at(time_s);
    Sample sample{.motion = instant.motion,
                  .site = instant.site,
                  .arc_length_m = state.arc_length_m,
                  .curvature_per_m = state.curvature_per_m};
    if (elapsed_s >= leg.duration_s) sample.motion = {};
    return sample;
  }
  double offset_m = 0.0;
  for (std::size_t k = 0; k < leg.stretches.size(); ++k) {
    const StretchPlan& stretch = leg.stretches[k];
    const double duration_s = stretch.profile.duration_s();
    if (elapsed_s < duration_s || k + 1 == leg.stretches.size()) {
      Sample sample = sample_stretch(stretch, motion.stretch(k), std::min(elapsed_s, duration_s), offset_m);
      if (elapsed_s >= duration_s && stretch.request.end_rate == 0.0) sample.motion = {};
      return sample;
    }
    elapsed_s -= duration_s;
    if (!is_turn(stretch.request.piece)) offset_m += piece_length(stretch.request.piece);
  }
  return {};
}

void append(Trajectory& out, const Plant& plant, const Sample& sample, double time_s, double payload_kg,
            std::size_t leg) {
  const BodyMotion<double>& motion = sample.motion;
  const bool rest = motion.speed_m_s == 0.0 && motion.yaw_rate_rad_s == 0.0 &&
                    motion.acceleration_m_s2 == 0.0 && motion.yaw_acceleration_rad_s2 == 0.0;
  Sided<WheelState<double>> wheels{};
  if (!rest) wheels = operating_point(plant, motion, sample.site);
  out.time_s.push_back(time_s);
  out.linear_speed_m_s.push_back(motion.speed_m_s);
  out.angular_speed_rad_s.push_back(motion.yaw_rate_rad_s);
  for (Side side : kSides) {
    out.wheel_speed_rad_s[side].push_back(wheels[side].speed_rad_s);
    out.motor_voltage_V[side].push_back(wheels[side].voltage_V);
    out.motor_current_A[side].push_back(wheels[side].current_A);
    out.motor_power_W[side].push_back(wheels[side].power_W);
    out.wheel_torque_Nm[side].push_back(wheels[side].torque_Nm);
  }
  out.position_x_m.push_back(sample.site.pose.x_m);
  out.position_y_m.push_back(sample.site.pose.y_m);
  out.heading_rad.push_back(sample.site.pose.heading_rad);
  out.payload_kg.push_back(payload_kg);
  out.arc_length_m.push_back(sample.arc_length_m);
  out.linear_acceleration_m_s2.push_back(motion.acceleration_m_s2);
  out.curvature_per_m.push_back(sample.curvature_per_m);
  const double power_W = plant.robot.power.standby_W +
                         supply_power_W(plant.robot.power, {wheels.left.power_W, wheels.right.power_W});
  out.battery_power_W.push_back(power_W);
  out.leg.push_back(static_cast<double>(leg));
}

/// Joules between two instants of a plan, over as many legs as lie between.
double plan_energy_J(const Plan& plan, const std::vector<LegMotion>& motions, double from_s, double to_s) {
  double sum_J = 0;
  for (std::size_t k = 0; k < plan.legs.size(); ++k) {
    const LegPlan& leg = plan.legs[k];
    const double end_s = leg.start_s + leg.duration_s + leg.dwell_s;
    const double first_s = std::max(from_s, leg.start_s), last_s = std::min(to_s, end_s);
    if (last_s > first_s) sum_J += motions[k].energy_J(first_s - leg.start_s, last_s - leg.start_s);
  }
  return sum_J;
}

}  // namespace

Trajectory plan_trajectory(const Plan& plan, const Plant& plant, double rate_Hz) {
  Trajectory out;
  if (plan.legs.empty()) return out;
  std::vector<LegMotion> motions;
  for (const LegPlan& leg : plan.legs) motions.emplace_back(leg, plant);
  std::size_t index = 0;
  const auto end_of = [&](std::size_t k) {
    return plan.legs[k].start_s + plan.legs[k].duration_s + plan.legs[k].dwell_s;
  };
  const double end_s = end_of(plan.legs.size() - 1);
  rate_Hz = std::min(rate_Hz, kMostSamples / end_s);
  const auto count = static_cast<std::size_t>(std::floor(end_s * rate_Hz * (1 - 1e-12)));
  for (std::size_t k = 0; k <= count + 1; ++k) {
    const double time_s = std::min(end_s, static_cast<double>(k) / rate_Hz);
    if (k > 0 && time_s <= out.time_s.back()) break;
    while (index + 1 < plan.legs.size() && time_s >= plan.legs[index + 1].start_s) ++index;
    const LegPlan& leg = plan.legs[index];
    const Sample sample = sample_leg(leg, motions[index], time_s - leg.start_s);
    const double payload_kg = leg.stretches.empty() ? leg.payload.from_kg : sample.site.payload_kg;
    out.energy_J.push_back(
        k == 0 ? 0.0 : out.energy_J.back() + plan_energy_J(plan, motions, out.time_s.back(), time_s));
    append(out, plant, sample, time_s, payload_kg, index);
  }
  return out;
}

}  // namespace joulepath
