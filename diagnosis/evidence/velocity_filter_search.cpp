#include "diagnosis/evidence/velocity_filter_search.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// The windings' equation is linear: a wide kernel takes nothing from it but the noise, of which q' has most.
constexpr double kFilterKernel_s = 0.15;

/// Of all wheels, with the electrical channels read `shift_s` later.
struct WindingFit {
  double left{};           ///< sum of squares that V = a + b i + c q leaves
  double left_filtered{};  ///< with c T q' added
  double filter_s{};       ///< T, the wheels' mean by their sum of q'^2
  double own_share{};      ///< of the sum of q'^2, beyond what 1, i and q follow
  bool any{};              ///< whether a wheel has both voltage and current
};

/// Values of a channel at `count` samples from `begin` on, `shift` samples later.
Eigen::VectorXd read_later(const Eigen::VectorXd& channel, Eigen::Index begin, Eigen::Index count,
                           double shift) {
  const double whole = std::floor(shift), part = shift - whole;
  const Eigen::Index from = begin + static_cast<Eigen::Index>(whole);
  return (1 - part) * channel.segment(from, count) + part * channel.segment(from + 1, count);
}

WindingFit fit_windings(const std::vector<RunSignals>& signals, double shift_s) {
  WindingFit sum;
  double slopes = 0, own = 0, gain = 0, gain_of_slope = 0;
  for (const RunSignals& run : signals)
    for (Side side : kSides) {
      const auto margin = static_cast<Eigen::Index>(std::ceil(kLatestReading_s / run.period_s)) + 1;
      const Eigen::Index count = run.size() - 2 * margin;
      if (run.motor_voltage_V[side].size() != run.size() || run.motor_current_A[side].size() != run.size() ||
          count <= 4)
        continue;
      const auto later = [&](const Eigen::VectorXd& channel) {
        return read_later(channel, margin, count, shift_s / run.period_s);
      };
      const Eigen::VectorXd volts = later(run.motor_voltage_V[side]);
      Eigen::MatrixX4d known(count, 4);
      const Eigen::VectorXd& speed = run.wheel_speed_rad_s[side];
      known << Eigen::VectorXd::Ones(count), later(run.motor_current_A[side]), speed.segment(margin, count),
          (speed.segment(margin + 1, count) - speed.segment(margin - 1, count)) / (2 * run.period_s);
      const Eigen::Matrix4d gram = known.transpose() * known;
      const Eigen::Vector4d product = known.transpose() * volts;
      const Eigen::Matrix3d gram_of_delay = gram.topLeftCorner<3, 3>();
      const Eigen::Vector3d delayed = gram_of_delay.ldlt().solve(product.head<3>()),
                            slope_followed = gram_of_delay.ldlt().solve(gram.col(3).head<3>());
      const double own_slope = gram(3, 3) - gram.col(3).head<3>().dot(slope_followed);
      const double left = (volts - known.leftCols<3>() * delayed).squaredNorm();
      sum.left += left, sum.any = true;
      slopes += gram(3, 3), own += own_slope;
      if (own_slope <= 0) {  // the wheel never changes its speed
        sum.left_filtered += left;
        continue;
      }
      const Eigen::Vector4d filtered = gram.ldlt().solve(product);
      sum.left_filtered += (volts - known * filtered).squaredNorm();
      gain += gram(3, 3) * filtered[2], gain_of_slope += gram(3, 3) * filtered[3];
    }
  sum.filter_s = gain != 0 ? gain_of_slope / gain : 0.0;
  sum.own_share = slopes > 0 ? own / slopes : 0.0;
  return sum;
}

}  // namespace

LateSpeeds examine_late_speeds(const LogSet& logs, double delay_s) {
  LogSet fine = logs;
  fine.options.period_s = 0;  // every sample of the log
  fine.options.kernel_sigma_s = std::max(kFilterKernel_s, fine.options.kernel_sigma_s);
  const std::vector<RunSignals> signals = read_signals(fine, 0.0);
  const WindingFit at_once = fit_windings(signals, 0.0);
  if (!at_once.any) return {.undecided = true};
  WindingFit delay = at_once, apart = at_once;
  for (double shift_s = std::max(kEarliestReading_s, delay_s - kDelayStep_s);
       shift_s <= std::min(kLatestReading_s, delay_s + kLongestFilter_s); shift_s += kFineDelayStep_s) {
    const WindingFit fit = fit_windings(signals, shift_s);
    if (fit.left < delay.left) delay = fit;
    if (2 * std::abs(shift_s) > signals.front().log_period_s && fit.left_filtered < apart.left_filtered)
      apart = fit;
  }
  const double notable = 1 - kNotableFilterGain;
  const auto is_possible = [](const WindingFit& f) {
    return f.filter_s > 0 && f.filter_s <= kLongestFilter_s;
  };
  const WindingFit& filter = apart.left_filtered < notable * at_once.left_filtered ? apart : at_once;
  if (filter.left_filtered < notable * delay.left && filter.own_share >= kLeastOwnSlope &&
      is_possible(filter))
    return {.filter_s = filter.filter_s};
  const bool is_alike = at_once.left_filtered >= notable * delay.left || at_once.own_share < kLeastOwnSlope;
  return {.undecided = is_possible(at_once) && is_alike && notable * at_once.left_filtered <= delay.left};
}

}  // namespace joulepath
