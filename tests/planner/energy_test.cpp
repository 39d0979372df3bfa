#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "model/estimate.hpp"
#include "model/sampled_motion.hpp"
#include "model/simulation/simulate.hpp"
#include "planner/mission/mission.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/replay.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr int kMotionsPerEffect = 18;  // 29 effects: 522 motions

/// A motion of up to three stretches, at rest between them, driven by a plant with one effect.
struct RandomMotion {
  std::string effect{};
  Robot robot{};
  double time_of_day_s{};
  std::vector<ProfileRequest> requests{};
  std::vector<Profile> profiles{};
};

class RandomMotions {
 public:
  RandomMotion next(const EffectDescription& effect) {
    RandomMotion motion{.effect = std::string(effect.info.name), .robot = robot()};
    motion.robot.effects = {setting(effect)};
    motion.time_of_day_s = uniform(0, 3600);
    const Plant plant = make_plant(motion.robot);
    Pose pose{uniform(-1, 1), uniform(-1, 1), uniform(-3, 3)};
    EffectMemory memory{};
    double time_s = motion.time_of_day_s, payload_kg = uniform(0, 10);
    for (int k = 0, count = 1 + choice(3); k < count; ++k) {
      ProfileRequest request{.piece = piece(pose), .plant = plant, .time_of_day_s = time_s, .memory = memory};
      const double length = piece_length(request.piece);
      request.payload = {payload_kg, choice(3) == 0 ? uniform(0, 10) : payload_kg};
      motion.profiles.push_back(profile(request.piece));
      pose = piece_point(request.piece, length).pose;
      payload_kg = request.payload.to_kg;
      memory = path_motion(request).memory(length);
      time_s += motion.profiles.back().duration_s();
      motion.requests.push_back(std::move(request));
    }
    return motion;
  }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  int choice(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }

 private:
  /// Wide drivers and a strong battery: the simulator can follow every motion.
  Robot robot() {
    Robot robot = testing::nomad();
    const double eta[] = {0, 0.6, 1};
    robot.power = {.standby_W = 5.0,
                   .regeneration_efficiency = eta[choice(3)],
                   .sharing = choice(2) == 0 ? PowerSharing::wheel : PowerSharing::bus};
    robot.battery.open_circuit_voltage_V = 100;
    for (Side side : kSides) {
      robot.motor[side].max_voltage_V = 100;
      robot.motor[side].max_current_A = 100;
    }
    return robot;
  }

  EffectSetting setting(const EffectDescription& effect) {
    EffectSetting setting{.name = std::string(effect.info.name)};
    // Soft contacts oscillate: the power model holds for creep that follows force within milliseconds.
    const double least = effect.info.stage == Stage::contact ? 1.0 : 0.3;
    for (const ParameterDescription& p : effect.parameters)
      setting.parameters[p.name] = std::clamp(p.typical * uniform(least, 2), p.min, p.max);
    if (effect.has_side) setting.side = choice(2) == 0 ? Side::left : Side::right;
    if (effect.has_cells) {
      const double x_m = uniform(-1, 1), y_m = uniform(-1, 1);
      setting.parameters["x_min_m"] = x_m - 0.6, setting.parameters["x_max_m"] = x_m + 0.6;
      setting.parameters["y_min_m"] = y_m - 0.6, setting.parameters["y_max_m"] = y_m + 0.6;
    }
    return setting;
  }

  /// A turn in place, a straight line or a corner of clothoids, forward or in reverse; corners below half
  /// the track turn the inner wheel backward.
  PathPiece piece(const Pose& start) {
    const Direction direction = choice(3) == 0 ? Direction::reverse : Direction::forward;
    const int kind = choice(4);
    if (kind == 0) return TurnInPlace{start, (choice(2) == 0 ? 1 : -1) * uniform(0.5, 2)};
    if (kind == 1) return straight_piece(start, uniform(0.5, 1.5), direction);
    std::vector<CurveSegment> segments;
    Pose pose = start;
    if (direction == Direction::reverse) pose.heading_rad += std::numbers::pi;
    const double radius_m = kind == 2 ? uniform(0.4, 1.5) : uniform(0.1, 0.16), turn = uniform(0.4, 1.4);
    const double ramp_m = turn * radius_m, peak = (choice(2) == 0 ? 1 : -1) / radius_m;
    const auto append = [&](double length_m, double curvature, double slope) {
      segments.emplace_back(LinearCurvature(pose, length_m, curvature, slope));
      pose = std::get<LinearCurvature>(segments.back()).at(length_m).pose;
    };
    append(uniform(0.2, 0.6), 0, 0);
    append(ramp_m, 0, peak / ramp_m);
    append(ramp_m, peak, -peak / ramp_m);
    append(uniform(0.2, 0.6), 0, 0);
    return Curve(std::move(segments), direction);
  }

  /// Up and down between random rates, from rest to rest.
  Profile profile(const PathPiece& piece) {
    constexpr int kParts = 6;
    const double length = piece_length(piece);
    std::vector<double> s = piece_breakpoints(piece), b;
    for (int i = 1; i < kParts; ++i) s.push_back(length * i / kParts);
    std::sort(s.begin(), s.end());
    s.erase(std::unique(s.begin(), s.end(), [&](double x, double y) { return y - x < 1e-3 * length; }),
            s.end());
    s.back() = length;
    for (const double place : s) {
      const double ramp = std::min({1.0, 3 * place / length, 3 * (1 - place / length)});
      const double rate = uniform(0.3, 0.6) / std::sqrt(1 + std::pow(0.3 * curvature(piece, place), 2));
      b.push_back(rate * rate * std::max(0.0, ramp));
    }
    b.front() = b.back() = 0;
    return profile_from_squares(s, b).divided({}, length / 60);
  }

  static double curvature(const PathPiece& piece, double s) { return piece_point(piece, s).curvature_per_m; }

  std::mt19937 random_{20};
};

/// The motion as a trajectory: samples at the profile's nodes and between them; payload that of the middle
/// of the interval that follows.
Trajectory sampled(const RandomMotion& motion, int parts) {
  Trajectory out;
  double start_s = 0;
  for (std::size_t k = 0; k < motion.requests.size(); ++k) {
    const PathMotion path = path_motion(motion.requests[k]);
    const Profile& profile = motion.profiles[k];
    const std::size_t first = out.time_s.empty() ? 0 : 1;
    for (std::size_t i = 0; i + 1 < profile.time_s.size(); ++i)
      for (int j = i == 0 && !first ? 0 : 1; j <= parts; ++j) {
        const double from_s = profile.time_s[i], length_s = profile.time_s[i + 1] - from_s;
        const double time_s = from_s + length_s * j / parts;
        const ProfileState state = profile.at_time(std::min(time_s, profile.time_s.back() * (1 - 1e-15)));
        const MotionInstant instant = motion_instant(path, state);
        out.time_s.push_back(start_s + time_s);
        out.linear_speed_m_s.push_back(instant.motion.speed_m_s);
        out.angular_speed_rad_s.push_back(instant.motion.yaw_rate_rad_s);
        out.position_x_m.push_back(instant.site.pose.x_m);
        out.position_y_m.push_back(instant.site.pose.y_m);
        out.heading_rad.push_back(instant.site.pose.heading_rad);
        out.payload_kg.push_back(path.payload_kg(profile.at_time(time_s + 0.5 * length_s / parts).s));
      }
    start_s += profile.time_s.back();
  }
  out.linear_speed_m_s.back() = out.angular_speed_rad_s.back() = 0;
  return out;
}

double planned_J(const RandomMotion& motion) {
  double energy_J = 0;
  for (std::size_t k = 0; k < motion.requests.size(); ++k)
    energy_J += energy_by_cause(path_motion(motion.requests[k]), motion.profiles[k]).total_J();
  return energy_J;
}

double replayed_J(const RandomMotion& motion) {
  double energy_J = 0;
  for (std::size_t k = 0; k < motion.requests.size(); ++k)
    energy_J += replay(motion.requests[k], motion.profiles[k]).energy_J;
  return energy_J;
}

double estimated_J(const RandomMotion& motion, const Trajectory& trajectory) {
  return estimate_energy(make_plant(motion.robot), trajectory,
                         {.reach_s = 0.0, .time_of_day_s = motion.time_of_day_s})
      .by_cause.total_J();
}

SimulationResult simulated(const RandomMotion& motion, const Trajectory& trajectory) {
  SimulationRequest request{.robot = motion.robot,
                            .reference = trajectory,
                            .start = {trajectory.position_x_m.front(), trajectory.position_y_m.front(),
                                      trajectory.heading_rad.front()},
                            .time_of_day_s = motion.time_of_day_s};
  request.controller.period_s = 0.004;
  request.sensors.sample_rate_Hz = 500;
  return simulate(request);
}

std::string told(const RandomMotion& motion, int index) {
  std::string text = motion.effect + ", motion " + std::to_string(index) + ":";
  for (const ProfileRequest& request : motion.requests)
    text += is_turn(request.piece) ? " turn" : travel_sign(request.piece) < 0 ? " reverse" : " forward";
  return text;
}

TEST(EnergyOfAMotion, IsTheSameByPlanEstimateAndReplayForEveryEffect) {
  RandomMotions random;
  for (int i = 0; i < kMotionsPerEffect; ++i)
    for (const EffectDescription& effect : effect_catalog()) {
      const RandomMotion motion = random.next(effect);
      const double planned = planned_J(motion);
      // The replay shares places and memories with the plan, but integrates time, path and energy itself.
      EXPECT_NEAR(replayed_J(motion) / planned, 1.0, 5e-5) << told(motion, i);
      // Speeds linear between samples miss a curve by the square of the step; 24 samples in each segment.
      EXPECT_NEAR(estimated_J(motion, sampled(motion, 24)) / planned, 1.0, 1e-4) << told(motion, i);
    }
}

/// The controller uses the plan's energy law without the plan's history (a caster's memory, the load of dry
/// friction), so a run does not repeat the plan exactly. Its energy is compared with that of its executed
/// motion: the simulator integrates forces and motion in one system of equations, the estimate uses the
/// motion only.
TEST(EnergyOfAMotion, IsTheSameBySimulationAndByTheEstimateOfWhatItExecuted) {
  RandomMotions random;
  for (int i = 0; i < kMotionsPerEffect / 3; ++i)
    for (const EffectDescription& effect : effect_catalog()) {
      const RandomMotion motion = random.next(effect);
      const SimulationResult run = simulated(motion, sampled(motion, 3));
      Trajectory body = run.executed;
      body.wheel_speed_rad_s = {};
      // Contacts creep with a delay in the simulator and without one in the estimate; casters fade in near
      // standstill.
      const bool lags = motion.effect == "wheel_slip" || motion.effect == "caster_swivel";
      EXPECT_NEAR(estimated_J(motion, body) / run.energy_J, 1.0, lags ? 1e-3 : 1e-4) << told(motion, i);
    }
}

Robot robot_with_casters() {
  Robot robot = testing::nomad();
  robot.effects = {{.name = "caster_swivel", .parameters = {{"moment_Nm", 3.0}, {"trail_m", 0.1}}}};
  return robot;
}

/// Moment times the angle over which it decays, M trail/l (1 - exp(-l angle/trail)), supplied by the wheels;
/// the current for it adds copper loss.
TEST(EnergyOfAMotion, APrescribedSpinPaysForItsCastersOnlyUntilTheyHaveComeRound) {
  const Robot robot = robot_with_casters();
  PrescribedMotion spin{.profile = MotionProfile::spin, .angle_rad = std::numbers::pi, .yaw_rate_rad_s = 1.0};
  const MissionRequest mission{.legs = {LegRequest{.motion = spin}}};
  const Plan plan = plan_mission(mission, {.robot = robot}, {}, nullptr);
  const double l_m = robot.geometry.half_track_m;
  EXPECT_NEAR(plan.energy.effects_J.at("caster_swivel"),
              3.0 * 0.1 / l_m * (1 - std::exp(-l_m * std::numbers::pi / 0.1)), 1e-4);
  EXPECT_NEAR(
      plan.energy.total_J(),
      estimate_energy(make_plant(robot), *plan.legs[0].prescribed, {.reach_s = 0.0}).by_cause.total_J(),
      1e-9);
}

TEST(EnergyOfAMotion, CastersRememberTheLegBefore) {
  const Robot robot = robot_with_casters();
  PrescribedMotion spin{.profile = MotionProfile::spin, .angle_rad = std::numbers::pi, .yaw_rate_rad_s = 1.0};
  const MissionRequest mission{.legs = {LegRequest{.motion = spin}, LegRequest{.motion = spin}}};
  const Plan plan = plan_mission(mission, {.robot = robot}, {}, nullptr);
  ASSERT_EQ(plan.legs.size(), 2U);
  const double left_over = std::exp(-robot.geometry.half_track_m * std::numbers::pi / 0.1);
  EXPECT_NEAR(plan.legs[1].energy.effects_J.at("caster_swivel"),
              left_over * plan.legs[0].energy.effects_J.at("caster_swivel"), 1e-4);
}

}  // namespace
}  // namespace joulepath
