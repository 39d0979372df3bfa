#pragma once

#include "diagnosis/signals/run_signals.hpp"
#include "model/operating_point.hpp"

namespace joulepath {

/// The moment that the contacts hold after a turn. Dry friction at rest holds any moment up to its bound: on
/// a straight line after a turn the motion does not tell the yaw moment.
class HeldTurn {
 public:
  /// `moment_Nm`: after a turn to the left or to the right, in the turn's direction.
  HeldTurn(const Plant& plant, const Sided<double>& moment_Nm) : plant_(plant), moment_Nm_(moment_Nm) {}

  /// Adds what the wheels do against it, at the samples of a run in their order.
  void load(const RunSignals& signals, const BodyMotion<double>& motion, const Site& site,
            Sided<WheelState<double>>& state);

 private:
  /// Share of the kernel in which they may hold a moment of the last turn, with its direction.
  double share(const RunSignals& signals, const BodyMotion<double>& motion, const Site& site);

  const Plant& plant_;
  Sided<double> moment_Nm_{};
  double direction_{};  ///< of the last turn since the robot rested
  double rested_s_{};
};

}  // namespace joulepath
