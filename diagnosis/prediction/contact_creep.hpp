#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/prediction/body_lag.hpp"
#include "diagnosis/signals/run_signals.hpp"
#include "model/plant.hpp"

namespace joulepath {

/// Solves lag_s y' + y = target from y = target at the first sample. Between two samples the target is the
/// parabola with these slopes that ends at the later one.
[[nodiscard]] Lagged lagged(const Eigen::VectorXd& target, const Eigen::VectorXd& slope,
                            const Eigen::VectorXd& lag_s, double period_s);

/// Creep of the contacts as a state: the body follows its wheels within mass / (2 stiffness), and its spin
/// within inertia / (2 stiffness half_track^2). `contact_force_N`: at each sample those that the body would
/// need if it followed its wheels at once.
[[nodiscard]] BodyLag contact_creep(const Plant& plant, const RunSignals& signals,
                                    const std::vector<Sided<double>>& contact_force_N);

}  // namespace joulepath
