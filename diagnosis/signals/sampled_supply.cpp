#include "diagnosis/signals/sampled_supply.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/numerics/smoothing.hpp"
#include "diagnosis/signals/site.hpp"
#include "model/operating_point.hpp"

namespace joulepath {
namespace {

/// What a jump adds grows with the width of the kernel: the difference of two widths tells that of none. Less
/// where the widths are close, and noise would be multiplied.
constexpr double kMostExtrapolated = 2;

/// Power of the supply without standby at each row of a run, W.
std::vector<double> supply_W(const Plant& plant, const RunSignals& signals) {
  std::vector<double> result;
  for (Eigen::Index j = 0; j < signals.size(); ++j) {
    const BodyMotion<double> motion = signals.rolled_motion(plant.robot.geometry, j);
    const Site site = site_at(signals, j, plant.robot.geometry, motion, {});
    const Sided<WheelState<double>> wheels = operating_point(plant, motion, site);
    const Sided<WheelChange> change = change_at(plant, signals, j, motion, site);
    const auto mean_W = [&](Side side) { return wheels[side].power_W + change[side].product_W(); };
    result.push_back(mean_supply_power_W(plant.robot.power, {mean_W(Side::left), mean_W(Side::right)},
                                         {change.left.power_W, change.right.power_W}));
  }
  return result;
}

}  // namespace

Eigen::VectorXd supply_beyond_mean_W(const RunSignals& mean, const RunSignals& samples, const Robot& robot) {
  const double sigma_s = mean.kernel_sigma_s, finer_s = samples.kernel_sigma_s;
  if (sigma_s <= finer_s || samples.size() == 0) return {};
  const Plant plant = make_plant(robot);
  const std::vector<double> of_mean_W = supply_W(plant, mean), of_samples_W = supply_W(plant, samples);
  const std::vector<double> weights =
      gaussian_kernel(std::sqrt(sigma_s * sigma_s - finer_s * finer_s), samples.period_s).weight;
  const double without_kernel = std::min(kMostExtrapolated, sigma_s / (sigma_s - finer_s));
  Eigen::VectorXd beyond_W(mean.size());
  for (Eigen::Index j = 0; j < mean.size(); ++j) {
    const auto center =
        static_cast<std::size_t>(std::lround((mean.time_s[j] - samples.time_s[0]) / samples.period_s));
    beyond_W[j] = without_kernel *
                  (convolve_at(of_samples_W, weights, center) - of_mean_W[static_cast<std::size_t>(j)]);
  }
  return beyond_W;
}

}  // namespace joulepath
