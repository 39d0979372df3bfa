#include "diagnosis/evidence/delay_search.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

/// Sum of squares that V(t + shift) = a + b i(t + shift) + c q'(t) leaves at best, over `count` samples from
/// `begin` on. The file's constants may be wrong, and a resistance that is wrong imitates a shift.
double left_of_winding(const RunSignals& run, Side side, Eigen::Index shift, Eigen::Index begin,
                       Eigen::Index count, Eigen::Index stride) {
  const auto samples = [&](Eigen::Index from) { return Eigen::seqN(from, count, stride); };
  const Eigen::VectorXd volts = run.motor_voltage_V[side](samples(begin + shift));
  Eigen::MatrixX3d known(count, 3);
  known << Eigen::VectorXd::Ones(count), run.motor_current_A[side](samples(begin + shift)),
      run.wheel_speed_rad_s[side](samples(begin));
  return (volts - known * known.colPivHouseholderQr().solve(volts)).squaredNorm();
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
  double best = 0, at_zero = 0;
  int best_shift = 0;
  bool any = false;
  for (int shift = zero_first; shift <= last; shift += stride) {
    double left_over = 0;
    for (const RunSignals& run : signals)
      for (Side side : kSides) {
        const Eigen::Index begin = std::max(0, -zero_first), end = run.size() - std::max(0, last);
        if (run.motor_voltage_V[side].size() != run.size() ||
            run.motor_current_A[side].size() != run.size() || end <= begin)
          continue;
        left_over += left_of_winding(run, side, shift, begin, (end - begin + stride - 1) / stride, stride);
        any = true;
      }
    if (shift == 0) at_zero = left_over;
    if (shift == zero_first || left_over < best) best = left_over, best_shift = shift;
  }
  if (!any || best > (1 - kNotableDelayGain) * at_zero) return 0.0;
  return best_shift * period_s;
}

}  // namespace joulepath
