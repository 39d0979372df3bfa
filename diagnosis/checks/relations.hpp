#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// A law that relates channels of one run. Its coefficients stay inside a box for every calibration error and
/// every effect of the catalog.
struct Relation {
  std::string law{};
  double unexplained{};  ///< share of the sum of squares that no coefficients inside the box explain
  double sound{};        ///< greatest unexplained share of a sound log
  /// Above this unexplained share a side or a sign may be wrong; equal to `sound` where noise may leave as
  /// much.
  double doubtful{};
};

/// Whether a wheel turns, and whether any does: of motors and battery, a run at rest shows noise and offsets.
[[nodiscard]] bool wheel_turns(const RunSignals& run, Side side);
[[nodiscard]] bool moves(const RunSignals& run);

/// Currents and voltages that the nominal robot's motors need for the measured motion.
struct ExpectedMotors {
  Sided<Eigen::VectorXd> friction_A{}, viscous_A{}, inertia_A{};
  Eigen::VectorXd current_A(Side side) const { return friction_A[side] + viscous_A[side] + inertia_A[side]; }
};

[[nodiscard]] ExpectedMotors expected_motors(const RunSignals& run, const Robot& robot);

/// Of one run, by law, always in the same order; empty where a channel is absent, where the run does not move
/// and where it has fewer than `kLeastFreeRows` rows more than the law has coefficients.
using Relations = std::vector<std::optional<Relation>>;

/// The relations that the run's channels and motion allow. With `freedom` 1 a factor may take any value
/// inside its box; with 0 it has the value of the robot file.
[[nodiscard]] Relations relations_of(const RunSignals& run, const Robot& robot, double freedom = 1.0);

}  // namespace joulepath
