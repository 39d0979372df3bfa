#pragma once

#include <string>
#include <vector>

#include "signals.hpp"

namespace blind {

/// How far a single effect is from what it may be mistaken for.
struct Separation {
  double ratio{};         ///< expected 2 ln(likelihood ratio) against the best rival or pair of rivals
  double single_ratio{};  ///< the same against the best single rival
  std::string rival{};    ///< the best rival or pair: names joined by `+`
};

/// An observer who knows the plant, but neither the calibration error nor the scatter from run to run, nor
/// `kFormSigma` of the form of each law, nor the amplitudes of the rivals. `full` holds the whitened runs
/// with the effect, `directions` those of the machine without it, `none_ratio` the ratio against no effect.
[[nodiscard]] Separation separation_of(const Case& c, const std::vector<Vector>& full,
                                       const std::vector<RunDirections>& directions, double none_ratio);

inline constexpr double kFormSigma = 0.12;

}  // namespace blind
