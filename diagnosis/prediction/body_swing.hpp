#pragma once

#include "diagnosis/prediction/body_lag.hpp"
#include "diagnosis/signals/run_signals.hpp"

namespace joulepath {

/// What a body lags behind its rotors by 1 s^2 along the way or in yaw, per second derivative of their
/// motion: tires and gears are springs, on which the body of a natural frequency w swings by 1 / w^2.
/// Encoders read the rotors.
[[nodiscard]] BodyLag swing_along(const RunSignals& signals, const Geometry& geometry);
[[nodiscard]] BodyLag swing_in_yaw(const RunSignals& signals, const Geometry& geometry);

}  // namespace joulepath
