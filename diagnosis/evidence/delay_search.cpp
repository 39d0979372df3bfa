#include "diagnosis/evidence/delay_search.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/rms.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/local_fit.hpp"
// Method: [GolubVanLoan1980]

namespace joulepath {
namespace {

/// White noise of a wheel's voltage, current and speed as logged, and 1e-6 of their size in a log without.
/// Speeds of the body alone count as exact.
Eigen::Array3d noise_of_wheel(const Trajectory& log, const RunSignals& run, Side side) {
  const auto of = [](const std::vector<double>& channel, const Eigen::VectorXd& smoothed) {
    return std::max({noise_of_readings(channel), 1e-6 * rms(smoothed), 1e-12});
  };
  return {of(log.motor_voltage_V[side], run.motor_voltage_V[side]),
          of(log.motor_current_A[side], run.motor_current_A[side]),
          of(log.wheel_speed_rad_s[side], run.wheel_speed_rad_s[side])};
}

/// Sum of squares that a + b V(t + shift) + c i(t + shift) + d q'(t) = 0 leaves at best over the noise that
/// it then has: total least squares, over `count` samples from `begin` on. The file's constants may be wrong,
/// and a resistance that is wrong imitates a shift: they are free. Where V alone had noise, a resistance that
/// is too small would take in less of the current's, and a shift with it would leave less than none. A
/// driver's drop is taken off: the current's sign is as good as exact.
double left_of_winding(const RunSignals& run, Side side, const Eigen::Array3d& noise, Eigen::Index shift,
                       Eigen::Index begin, Eigen::Index count, Eigen::Index stride) {
  const auto samples = [&](Eigen::Index from) { return Eigen::seqN(from, count, stride); };
  Eigen::MatrixX3d known(count, 3);
  known << run.motor_voltage_V[side](samples(begin + shift)),
      run.motor_current_A[side](samples(begin + shift)), run.wheel_speed_rad_s[side](samples(begin));
  Eigen::VectorXd sign = run.current_direction[side](samples(begin + shift));
  known.rowwise() -= known.colwise().mean();
  sign.array() -= sign.mean();
  if (const double size = sign.squaredNorm(); size > 0) known -= sign * (sign.transpose() * known / size);
  known.array().rowwise() /= noise.transpose();
  return std::pow(Eigen::JacobiSVD<Eigen::MatrixXd>(known).singularValues().minCoeff(), 2);
}

}  // namespace

double rough_channel_delay_s(const LogSet& logs) {
  if (logs.runs.empty()) return 0.0;
  LogSet fine = logs;
  fine.options.period_s = 0;  // every sample of the log
  const std::vector<RunSignals> signals = read_signals(fine, 0.0);
  const double period_s = signals.front().period_s;
  const int first = static_cast<int>(std::floor(kEarliestReading_s / period_s));
  const int last = static_cast<int>(std::ceil(kLatestReading_s / period_s));
  const int stride = std::max(1, static_cast<int>(std::lround(kDelayStep_s / period_s)));
  const int zero_first = -(std::abs(first) / stride) * stride;
  std::vector<Sided<Eigen::Array3d>> noise;
  for (const RunSignals& run : signals) {
    const Trajectory& log = logs.dataset->runs[run.run_index].log;
    noise.push_back({noise_of_wheel(log, run, Side::left), noise_of_wheel(log, run, Side::right)});
  }
  double best = 0, at_zero = 0;
  int best_shift = 0;
  bool any = false;
  for (int shift = zero_first; shift <= last; shift += stride) {
    double left_over = 0;
    for (std::size_t r = 0; r < signals.size(); ++r)
      for (Side side : kSides) {
        const RunSignals& run = signals[r];
        const Eigen::Index begin = std::max(0, -zero_first), end = run.size() - std::max(0, last);
        if (run.motor_voltage_V[side].size() != run.size() ||
            run.motor_current_A[side].size() != run.size() || end <= begin)
          continue;
        left_over += left_of_winding(run, side, noise[r][side], shift, begin,
                                     (end - begin + stride - 1) / stride, stride);
        any = true;
      }
    if (shift == 0) at_zero = left_over;
    if (shift == zero_first || left_over < best) best = left_over, best_shift = shift;
  }
  if (!any || best > (1 - kNotableDelayGain) * at_zero) return 0.0;
  return best_shift * period_s;
}

}  // namespace joulepath
