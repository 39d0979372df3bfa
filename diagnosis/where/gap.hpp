#pragma once

#include <vector>

#include "diagnosis/evidence/whitening.hpp"
#include "diagnosis/prediction/model_state.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// A run's energy (J), measured and predicted for the motion that it measured: of both motors, or at the
/// battery's terminals where nothing measures the motors.
struct RunEnergy {
  double measured_J{};
  double predicted_J{};
  double gap_J() const { return predicted_J - measured_J; }
};

/// Measured power of one wheel (W) per sample: voltage times current, or empty.
[[nodiscard]] Eigen::VectorXd measured_power_W(const RunSignals& run, Side side);

/// One model for each run.
using ModelPoints = std::vector<ModelPoint>;

/// Where the energy of a run is compared: at the motors, or at the battery where nothing measures them; or at
/// the battery in any case.
enum class EnergyAt { motors_first, battery };

/// Nothing for a run that does not measure the energy there.
[[nodiscard]] std::vector<RunEnergy> run_energies(const std::vector<RunSignals>& signals,
                                                  const ModelPoints& points,
                                                  EnergyAt at = EnergyAt::motors_first);

/// Whether a run measures the energy at both places.
[[nodiscard]] bool measures_both_energies(const std::vector<RunSignals>& signals);

/// sum |gap| over runs, J.
[[nodiscard]] double absolute_gap_J(const std::vector<RunEnergy>& runs);

/// sum |gap| / sum |measured|, percent.
[[nodiscard]] double energy_gap_percent(const std::vector<RunEnergy>& runs);

/// sum gap / sum |measured|, percent.
[[nodiscard]] double energy_bias_percent(const std::vector<RunEnergy>& runs);

struct GapInput {
  const std::vector<RunSignals>& before_signals;
  const std::vector<RunSignals>& after_signals;  ///< read at the corrected model's delay
  ModelPoint before{};
  ModelPoints after{};
  double noise_floor_percent{};
  double battery_floor_percent{};  ///< the same of the battery's energy
  std::size_t bootstrap{};
  /// Runs that the correction was fitted to, at its delay, and the model: with few held-out runs, they show
  /// how much the shrink differs from run to run.
  const std::vector<RunSignals>& fitted_signals;
  ModelPoint fitted{};
};

/// Mean |gap| (percent of the measured energy) that friction and resistance leave which differ from run
/// to run, together with the readings' noise: what no model of the robot can take away. The variances
/// come from the fit of everything, so that a wrong explanation does not count as scatter.
[[nodiscard]] double run_scatter_percent(const std::vector<RunSignals>& signals, const ModelPoint& point,
                                         const Eigen::VectorXd& run_variance, const NoiseModel& noise,
                                         EnergyAt at = EnergyAt::motors_first);

/// The gap on held-out runs, before and after, per channel and phase, with a paired interval over runs.
[[nodiscard]] GapReport measure_gap(const GapInput& input);

/// Whether a model shrinks the gap of a compared signal other than the energy (current, voltage, position,
/// heading or battery power, root mean square) by at least kNotableShrink, and widens none by as much.
[[nodiscard]] bool shrinks_a_signal(const std::vector<RunSignals>& before_signals, const ModelPoints& before,
                                    const std::vector<RunSignals>& after_signals, const ModelPoints& after);

/// Phase of a sample: standstill, accelerate, cruise, brake, turn, spin.
[[nodiscard]] const char* phase_of(const RunSignals& run, const Geometry& geometry, Eigen::Index sample);

}  // namespace joulepath
