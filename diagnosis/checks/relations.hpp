#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// A law that ties channels of one run together, with coefficients that calibration errors and every
/// effect of the catalog leave inside a box.
struct Relation {
  std::string law{};
  double unexplained{};  ///< share of the sum of squares that no coefficient inside the box explains
  double sound{};        ///< what a sound log leaves at most
  /// Where it leaves more, a side or a sign may be wrong; `sound` where noise may leave as much.
  double doubtful{};
};

/// What the nominal robot's motors would have to do for the measured motion.
struct ExpectedMotors {
  Sided<Eigen::VectorXd> friction_A{}, viscous_A{}, inertia_A{};
  Eigen::VectorXd current_A(Side side) const { return friction_A[side] + viscous_A[side] + inertia_A[side]; }
};

[[nodiscard]] ExpectedMotors expected_motors(const RunSignals& run, const Robot& robot);

/// The relations that the run's channels and its motion allow, always in the same order; empty where
/// a channel is absent or the run does not move. `freedom` 1: a factor may be anywhere inside its box;
/// 0: factors are those of the robot file.
[[nodiscard]] std::vector<std::optional<Relation>> relations_of(const RunSignals& run, const Robot& robot,
                                                                double freedom = 1.0);

}  // namespace joulepath
