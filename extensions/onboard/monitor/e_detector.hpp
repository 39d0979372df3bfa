#pragma once

#include <cstddef>
#include <vector>

namespace joulepath {

/// A sequential test for a change of a mean, for Gaussian estimates of known sigma. An e-detector of the
/// Shiryaev-Roberts kind [Shin2024], in units of time: for each alternative size delta
///
///   R <- (R + dt) L,   L = exp((delta - d)(|x| - d)/s^2 - (delta - d)^2/(2 s^2))
///
/// E[L] <= 1 as long as the mean is within the tolerance d, so that the mean of all R exceeds the elapsed
/// time by nothing in expectation. It is compared with H: the expected time to a false alarm is at least H.
class EDetector {
 public:
  /// `sizes`: changes beyond the tolerance that are looked for, both signs.
  EDetector(double tolerance, std::vector<double> sizes, double hours_per_false_alarm);

  /// An estimate after `hours` more; true for an alarm.
  bool add(double value, double sigma, double hours, double begin_s);
  /// Begins again, with the mean that counts as none.
  void restart(double reference);

  /// Begin of the change, as the CUSUM of the largest alternative has it.
  [[nodiscard]] double since_s() const;
  [[nodiscard]] bool suspicious() const;  ///< some CUSUM is above 0
  double reference() const { return reference_; }
  double evidence_hours() const;

 private:
  struct Alternative {
    double shift{};  ///< delta - d, > 0
    double sign{};
    double evidence_h{};
    double cusum{};
    double since_s{};
  };
  [[nodiscard]] const Alternative& largest() const;

  double tolerance_{}, limit_h_{}, reference_{};
  std::vector<Alternative> alternatives_{};
};

}  // namespace joulepath
