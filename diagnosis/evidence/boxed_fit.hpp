#pragma once

#include <vector>

#include "diagnosis/evidence/identify.hpp"

namespace joulepath {

/// What calibration errors explain inside their box, and which of them are at its border.
struct BoxedFit {
  double loss{};
  std::vector<int> held{};  ///< columns, the one furthest out first
};

/// Loss without any effect, with calibration errors inside their box: an unbounded one makes any gap with
/// its signature seem small.
[[nodiscard]] BoxedFit fit_within_calibration(const Identification& identification);

/// Score of a calibration constant (its column) that is free to leave its uncertainty, as of an explanation
/// with one law.
[[nodiscard]] double score_of_constant(const Identification& identification, int column);

/// The effect of the catalog that changes the same number as a calibration constant (its column); none: -1.
[[nodiscard]] int effect_of_constant(const Identification& identification, int column);

/// A calibration constant in words: "wheel_radius_m" or "friction_torque_Nm (left)".
[[nodiscard]] std::string calibration_name(const Identification& identification, int column);

}  // namespace joulepath
