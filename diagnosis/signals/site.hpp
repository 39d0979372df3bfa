#pragma once

#include "diagnosis/signals/run_signals.hpp"
#include "model/mean_power.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// Where and how a robot drives at a sample, for the model; directions are means over the kernel.
[[nodiscard]] Site site_at(const RunSignals& signals, Eigen::Index j, const Geometry& geometry,
                           const BodyMotion<double>& motion, const EffectMemory& memory);

/// Whether the body moves too slowly to count as moving.
[[nodiscard]] bool stands(const Geometry& geometry, const BodyMotion<double>& motion);

/// How much the wheels' quantities change within the kernel at a sample.
[[nodiscard]] Sided<WheelChange> change_at(const Plant& plant, const RunSignals& signals, Eigen::Index j,
                                           const BodyMotion<double>& motion, const Site& site);

}  // namespace joulepath
