#include "diagnosis/evidence/delay_search.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {

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
        const Motor& motor = logs.dataset->robot.motor[side];
        const Eigen::VectorXd &volts = run.motor_voltage_V[side], &amperes = run.motor_current_A[side];
        const Eigen::Index begin = std::max(0, -zero_first), end = run.size() - std::max(0, last);
        if (volts.size() != run.size() || amperes.size() != run.size() || end <= begin) continue;
        // V(t + shift) - R i(t + shift) - Kv n q'(t), minus its mean, because constants may be wrong.
        double sum = 0, square = 0, count = 0;
        for (Eigen::Index j = begin; j < end; j += stride, ++count) {
          const double winding_V = volts[j + shift] - motor.resistance_ohm * amperes[j + shift] -
                                   motor.volts_per_speed_V_s_rad() * run.wheel_speed_rad_s[side][j];
          sum += winding_V, square += winding_V * winding_V;
        }
        left_over += square - sum * sum / count;
        any = true;
      }
    if (shift == 0) at_zero = left_over;
    if (shift == zero_first || left_over < best) best = left_over, best_shift = shift;
  }
  if (!any || best > (1 - kNotableDelayGain) * at_zero) return 0.0;
  return best_shift * period_s;
}

}  // namespace joulepath
