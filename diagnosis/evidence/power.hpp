#pragma once

#include <cmath>

#include "diagnosis/thresholds.hpp"

namespace joulepath {

/// Probability that a normal value of unit deviation about `expected` exceeds `least`.
inline double probability_above(double least, double expected) {
  return 0.5 * std::erfc((least - expected) / std::sqrt(2.0));
}

/// From which z on the search takes an effect up: the gain in log evidence, z^2/2, must exceed the cost of
/// the effect, of its prior width (in sigmas), and `more_evidence`.
inline double least_sigmas(double width, double more_evidence = 0.0) {
  return std::sqrt(2 * (kEffectCost + 0.5 * std::log1p(width * width) + more_evidence));
}

/// Probability that the search takes an effect up whose change of the data is `expected` sigmas: z is normal
/// about its expectation.
inline double probability_taken_up(double expected, double width, double more_evidence = 0.0) {
  return probability_above(least_sigmas(width, more_evidence), expected);
}

/// The least expectation, in sigmas, that the search takes up in kShareSeen of cases.
inline double sigmas_seen(double width) { return least_sigmas(width) + kSigmasOfShareSeen; }

/// Probability that a likelihood ratio with the expectation D of 2 ln LR tells two effects apart, added to
/// the 2 ln LR that other runs gave: 2 ln LR ~ N(D, 4 D).
inline double probability_told_apart(double likelihood_ratio, double given = 0.0) {
  if (likelihood_ratio <= 0) return 0.0;
  const double deviation = 2 * std::sqrt(likelihood_ratio);
  return probability_above(kStandInLoss / deviation, (likelihood_ratio + given) / deviation);
}

}  // namespace joulepath
