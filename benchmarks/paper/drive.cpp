#include "benchmarks/paper/drive.hpp"

#include <algorithm>
#include <cmath>

#include "model/operating_point.hpp"

namespace joulepath::bench {
namespace {

/// Calls visit(sample, step_s) for the middle of every step.
template <class Visit>
void for_each_step(const Plant& plant, double payload_kg, const Track& track, const SpeedProfile& profile,
                   double step_s, Visit&& visit) {
  double time_s = 0, distance_m = 0;
  for (const Phase& phase : profile) {
    const int steps = std::max(1, static_cast<int>(std::ceil(phase.duration_s / step_s)));
    const double h = phase.duration_s / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * h;
      const double v = phase.start_speed_m_s + phase.acceleration_m_s2 * t;
      const double s = distance_m + phase.start_speed_m_s * t + 0.5 * phase.acceleration_m_s2 * t * t;
      const PathPoint point =
          track.curve ? track.curve->at(std::min(s, track.length_m())) : PathPoint{.pose = {.x_m = s}};
      const double k = point.curvature_per_m;
      const BodyMotion<double> motion{
          .speed_m_s = v,
          .acceleration_m_s2 = phase.acceleration_m_s2,
          .yaw_rate_rad_s = k * v,
          .yaw_acceleration_rad_s2 = k * phase.acceleration_m_s2 + point.curvature_slope_per_m2 * v * v};
      const Site site = site_of(plant.robot.geometry, point.pose, payload_kg, 1.0, k);
      const Sided<WheelState<double>> wheels = operating_point(plant, motion, site);
      visit(DriveSample{time_s + t, v, {wheels.left.power_W, wheels.right.power_W}}, h);
    }
    time_s += phase.duration_s;
    distance_m += phase.distance_m();
  }
}

}  // namespace

Track paper_curve(double bend) {
  return {.curve = BezierSegment({{{0, 0}, {2.7, 0}, {2.7, 0}, {2.7, bend * 2.7}}})};
}

std::vector<DriveSample> drive(const Plant& plant, double payload_kg, const Track& track,
                               const SpeedProfile& profile, double step_s) {
  std::vector<DriveSample> samples;
  for_each_step(plant, payload_kg, track, profile, step_s,
                [&](const DriveSample& sample, double) { samples.push_back(sample); });
  return samples;
}

Sided<double> drive_energy_J(const Plant& plant, double payload_kg, const Track& track,
                             const SpeedProfile& profile, NegativePower negative) {
  Sided<double> sum_J{};
  for_each_step(plant, payload_kg, track, profile, 0.002, [&](const DriveSample& sample, double step_s) {
    for (Side side : kSides) {
      const double watts = sample.power_W[side];
      sum_J[side] += step_s * (negative == NegativePower::lost ? std::max(0.0, watts) : watts);
    }
  });
  return sum_J;
}

}  // namespace joulepath::bench
