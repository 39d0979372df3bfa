#pragma once

#include "diagnosis/calibration/calibration.hpp"
#include "diagnosis/calibration/smoothed_run.hpp"

namespace joulepath::calibration {

/// Means of the channels over stretches of straight motion of at least one second in which no wheel
/// accelerates by more than the noise of the smoothed speed explains (at least 0.1 rad/s^2).
[[nodiscard]] std::vector<SteadySegment> find_steady_segments(const std::vector<SmoothedRun>& runs);

/// Least squares of [P1, Eq. (30)] over segments, weighted by duration: i = b1 sign + b2 q', V = c1 sign + c2
/// q'.
[[nodiscard]] SteadyLine fit_steady_line(const std::vector<SteadySegment>& segments, Side side);

/// Procedure of the paper: T_m = b1 Kt n and nu = b2 Kt n per motor.
[[nodiscard]] CalibrationResult calibrate_steady(const Dataset& dataset,
                                                 const std::vector<SmoothedRun>& runs);

}  // namespace joulepath::calibration
