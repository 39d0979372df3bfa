#pragma once

#include "diagnosis/values/dataset.hpp"
#include "model/estimate.hpp"

namespace joulepath {

/// The motion of a run, from its log or as prescribed, and how its energy is estimated.
struct RunMotion {
  Trajectory trajectory{};
  EstimateOptions options{};
};
[[nodiscard]] RunMotion run_motion(const Run& run, const Robot& robot, EstimateOptions options = {});

/// Energies that a run measures.
struct MeasuredEnergy {
  std::optional<Sided<double>> motor_J{};  ///< with the robot's regeneration efficiency
  std::optional<double> battery_J{};
};
[[nodiscard]] MeasuredEnergy measured_energy(const Run& run, const Robot& robot);

}  // namespace joulepath
