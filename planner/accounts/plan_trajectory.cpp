#include "planner/accounts/plan_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "planner/legs/leg_motion.hpp"

namespace joulepath {
namespace {

/// Greatest number of samples: plans of more than 2.8 hours at 50 Hz get a longer period, which bounds the
/// memory.
constexpr double kMostSamples = 5e5;

/// The content of one sample of the trajectory.
struct Sample {
  BodyMotion<double> motion{};
  Site site{};
  double arc_length_m{};
  double curvature_per_m{};
};

Sample sample_stretch(const StretchPlan& stretch, const PathMotion& path, const ProfileState& state,
                      double offset_m) {
  const PathRates rates = path.rates(state.s);
  const bool turn = is_turn(stretch.request.piece);
  return {.motion = PathMotion::body_motion(rates, state.rate, state.acceleration),
          .site = path.site(state.s, state.time_s),
          .arc_length_m = offset_m + (turn ? 0.0 : state.s),
          .curvature_per_m = turn ? 0.0 : piece_point(stretch.request.piece, state.s).curvature_per_m};
}

/// State of a leg `elapsed_s` after its departure; at rest at its end during dwell.
Sample sample_leg(const LegPlan& leg, const LegMotion& motion, double elapsed_s) {
  if (motion.prescribed()) {
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
      const ProfileState state = stretch.profile.at_time(std::min(elapsed_s, duration_s));
      Sample sample = sample_stretch(stretch, motion.stretch(k), state, offset_m);
      if (elapsed_s >= duration_s && stretch.request.end_rate == 0.0) sample.motion = {};
      return sample;
    }
    elapsed_s -= duration_s;
    if (!is_turn(stretch.request.piece)) offset_m += piece_length(stretch.request.piece);
  }
  return {.site = {.pose = leg.start_pose}};
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

/// Energy (J) of a plan between two instants, over all legs between them.
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

/// End of a leg: the end of its dwell.
double end_s(const LegPlan& leg) { return leg.start_s + leg.duration_s + leg.dwell_s; }

/// Rows of a plan in the order of time, with the energy between them.
class PlanRows {
 public:
  PlanRows(const Plan& plan, const Plant& plant) : plan_(plan) {
    for (const LegPlan& leg : plan.legs) plants_.push_back(plant_in(plant, leg.state));
    for (std::size_t k = 0; k < plants_.size(); ++k) motions_.emplace_back(plan.legs[k], plants_[k]);
  }

  const LegMotion& motion(std::size_t leg) const { return motions_[leg]; }
  Sample at(std::size_t leg, double elapsed_s) const {
    return sample_leg(plan_.legs[leg], motions_[leg], elapsed_s);
  }

  void append(const Sample& sample, double time_s, std::size_t leg) {
    const LegPlan& from = plan_.legs[leg];
    const double payload_kg = from.stretches.empty() ? from.payload.from_kg : sample.site.payload_kg;
    rows_.energy_J.push_back(rows_.size() == 0
                                 ? 0.0
                                 : rows_.energy_J.back() +
                                       plan_energy_J(plan_, motions_, rows_.time_s.back(), time_s));
    const double before_rad = rows_.size() == 0 ? sample.site.pose.heading_rad : rows_.heading_rad.back();
    joulepath::append(rows_, plants_[leg], sample, time_s, payload_kg, leg);
    double& heading_rad = rows_.heading_rad.back();
    heading_rad = before_rad + wrapped_angle_rad(heading_rad - before_rad);
  }

  Trajectory& rows() { return rows_; }

 private:
  const Plan& plan_;
  std::vector<Plant> plants_{};  ///< of each leg
  std::vector<LegMotion> motions_{};
  Trajectory rows_{};
};

/// A row at a node: the values that hold until the next row.
struct NodeRow {
  double time_s{};
  std::size_t leg{};
  Sample sample{};
  double jerk_m_s3{};
};

/// Nodes of one leg; of two nodes at the same time the later one counts.
class NodeRows {
 public:
  void add(NodeRow row) {
    constexpr double kSame_s = 1e-9;
    if (!rows.empty() && row.time_s < rows.back().time_s + kSame_s) rows.pop_back();
    rows.push_back(row);
  }
  std::vector<NodeRow> rows{};
};

void add_stretch(const StretchPlan& stretch, const PathMotion& path, double start_s, double offset_m,
                 std::size_t leg, NodeRows& to) {
  const Profile& profile = stretch.profile;
  const bool turn = is_turn(stretch.request.piece);
  for (std::size_t k = 0; k < profile.s.size(); ++k) {
    const bool last = k + 1 == profile.s.size();
    ProfileState state{profile.time_s[k], profile.s[k], profile.rate[k], 0.0};
    if (!last) state.acceleration = profile.acceleration[k];
    Sample sample = sample_stretch(stretch, path, state, offset_m);
    if (last && profile.rate[k] == 0.0) sample.motion = {};
    const double along = turn ? 0.0 : path.rates(state.s).along;
    to.add({start_s + state.time_s, leg, sample, last ? 0.0 : along * profile.jerk[k]});
  }
}

void add_leg(const LegPlan& leg, std::size_t index, const PlanRows& rows, NodeRows& to) {
  if (leg.prescribed)
    for (double time_s : leg.prescribed->time_s) {
      const double elapsed_s = time_s - leg.prescribed->time_s.front();
      to.add({leg.start_s + elapsed_s, index, rows.at(index, elapsed_s)});
    }
  if (!leg.prescribed && leg.stretches.empty()) to.add({leg.start_s, index, rows.at(index, 0.0)});
  double start_s = leg.start_s, offset_m = 0;
  for (std::size_t k = 0; k < leg.stretches.size(); ++k) {
    const StretchPlan& stretch = leg.stretches[k];
    add_stretch(stretch, rows.motion(index).stretch(k), start_s, offset_m, index, to);
    start_s += stretch.profile.duration_s();
    if (!is_turn(stretch.request.piece)) offset_m += piece_length(stretch.request.piece);
  }
  to.add({end_s(leg), index, rows.at(index, end_s(leg) - leg.start_s)});
}

}  // namespace

Trajectory plan_trajectory_at(const Plan& plan, const Plant& plant, const std::vector<double>& times_s) {
  if (plan.legs.empty()) return {};
  PlanRows rows(plan, plant);
  std::size_t index = 0;
  for (const double time_s : times_s) {
    while (index + 1 < plan.legs.size() && time_s >= plan.legs[index + 1].start_s) ++index;
    rows.append(rows.at(index, time_s - plan.legs[index].start_s), time_s, index);
  }
  return std::move(rows.rows());
}

PlanNodes plan_nodes(const Plan& plan, const Plant& plant) {
  PlanRows rows(plan, plant);
  NodeRows nodes;
  for (std::size_t i = 0; i < plan.legs.size(); ++i) add_leg(plan.legs[i], i, rows, nodes);
  PlanNodes result;
  for (const NodeRow& node : nodes.rows) {
    rows.append(node.sample, node.time_s, node.leg);
    result.angular_acceleration_rad_s2.push_back(node.sample.motion.yaw_acceleration_rad_s2);
    result.linear_jerk_m_s3.push_back(node.jerk_m_s3);
  }
  result.rows = std::move(rows.rows());
  return result;
}

Trajectory plan_trajectory(const Plan& plan, const Plant& plant, double rate_Hz) {
  if (plan.legs.empty()) return {};
  const double last_s = end_s(plan.legs.back());
  rate_Hz = std::min(rate_Hz, kMostSamples / last_s);
  const auto count = static_cast<std::size_t>(std::floor(last_s * rate_Hz * (1 - 1e-12)));
  std::vector<double> times_s;
  for (std::size_t k = 0; k <= count + 1; ++k) {
    const double time_s = std::min(last_s, static_cast<double>(k) / rate_Hz);
    if (k > 0 && time_s <= times_s.back()) break;
    times_s.push_back(time_s);
  }
  return plan_trajectory_at(plan, plant, times_s);
}

}  // namespace joulepath
