#include "diagnosis/signals/manoeuvres.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/thresholds.hpp"

namespace joulepath {

Manoeuvres manoeuvres_of(const std::vector<RunSignals>& signals) {
  Manoeuvres share;
  double total = 0;
  for (const RunSignals& run : signals)
    for (Eigen::Index j = 0; j < run.size(); ++j) {
      const double left = run.wheel_speed_rad_s.left[j], right = run.wheel_speed_rad_s.right[j];
      total += 1;
      share.turning += std::abs(right - left) > kTurningShare * (std::abs(left) + std::abs(right)) &&
                       std::abs(right - left) > kMovingWheel_rad_s;
      share.reverse += left < -kMovingWheel_rad_s && right < -kMovingWheel_rad_s;
      share.still += std::abs(left) < kMovingWheel_rad_s && std::abs(right) < kMovingWheel_rad_s;
    }
  if (total == 0) return {1, 1, 1};
  return {share.turning / total, share.reverse / total, share.still / total};
}

bool has_yaw(const std::vector<RunSignals>& signals, const Geometry& geometry) {
  return std::ranges::any_of(signals, [&](const RunSignals& run) {
    const auto half = std::max<Eigen::Index>(1, std::lround(kAccelerationWindow_s / run.period_s));
    const double span_s = 2 * static_cast<double>(half) * run.period_s;
    Eigen::Index turning = 0;
    for (Eigen::Index j = half; j + half < run.size(); ++j) {
      const auto rolled_m = [&](Side side) {
        const Eigen::VectorXd& angle_rad = run.wheel_angle_rad[side];
        return geometry.wheel_radius_m[side] * (angle_rad[j + half] - angle_rad[j - half]);
      };
      const double turned_rad = (rolled_m(Side::right) - rolled_m(Side::left)) / (2 * geometry.half_track_m);
      turning += std::abs(turned_rad) > kMovingYawRate_rad_s * span_s;
    }
    return static_cast<double>(turning) > kLeastManoeuvreShare * static_cast<double>(run.size());
  });
}

RunSignals straightened(RunSignals run) {
  for (Sided<Eigen::VectorXd>* of :
       {&run.wheel_speed_rad_s, &run.wheel_acceleration_rad_s2, &run.wheel_jerk_rad_s3, &run.wheel_angle_rad,
        &run.wheel_along_x_rad, &run.wheel_along_y_rad})
    of->left = of->right = Eigen::VectorXd(0.5 * (of->left + of->right));
  return run;
}

RunSignals straightened_where_straight(RunSignals run) {
  Sided<Eigen::VectorXd>& speed = run.wheel_speed_rad_s;
  for (std::size_t k = 0; k < run.yawing.size(); ++k) {
    if (run.yawing[k]) continue;
    const auto j = static_cast<Eigen::Index>(k);
    speed.left[j] = speed.right[j] = 0.5 * (speed.left[j] + speed.right[j]);
  }
  return run;
}

bool has_two_payloads(const std::vector<RunSignals>& signals) {
  std::set<double> payloads;
  for (const RunSignals& run : signals)
    if (run.payload_known) payloads.insert(run.payload_kg.begin(), run.payload_kg.end());
  return payloads.size() > 1;
}

}  // namespace joulepath
