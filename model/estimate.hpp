#pragma once

#include <optional>

#include "model/energy.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

struct EstimateOptions {
  /// Half width of the window in which noisy speeds are smoothed and differentiated. 0: speeds are taken
  /// as linear between the samples. Absent: 0 for speeds without noise, else kDefaultReach_s.
  std::optional<double> reach_s{};
  double time_of_day_s{};  ///< at the log's first sample
  double payload_kg{};     ///< where the log has no payload
};
inline constexpr double kDefaultReach_s = 0.15;

/// Energy of a motion by the model. The electrical channels of the log are not used.
struct EnergyEstimate {
  Trajectory power{};         ///< estimated wheel speed, torque, current, voltage, power over time
  Sided<double> motor_J{};    ///< V i, signed: braking energy is subtracted
  Sided<double> counted_J{};  ///< with the robot's regeneration efficiency: max(P, eta P)
  EnergyByCause by_cause{};   ///< at the battery's terminals
  double battery_loss_J{};    ///< in the internal resistance
  double duration_s{};
  double distance_m{};
  double reach_s{};  ///< as used
};

/// Power and energy from odometry: wheel speeds, or body speeds where a log has no wheels.
///
///   wheel speeds -> v, omega -> slopes -> operating_point() -> P, E = int P dt   [P1, Eqs. (28), (29),
///   (35)]
///
/// A wheel slower than the noise of its speed counts as standing and has no friction loss.
/// Throws ConfigError for a log with fewer than two samples or no speeds.
[[nodiscard]] EnergyEstimate estimate_energy(const Plant& plant, const Trajectory& log,
                                             const EstimateOptions& options = {});

/// Measured energy of each motor, from power or from voltage and current; empty if these channels are
/// missing. `efficiency`: the share of negative power that counts.
[[nodiscard]] std::optional<Sided<double>> measured_motor_energy_J(const Trajectory& log, double efficiency);

/// Measured energy at the battery's terminals; empty if the log has no battery channels.
[[nodiscard]] std::optional<double> measured_battery_energy_J(const Trajectory& log);

/// 1-sigma (J) of the energy at the terminals, battery loss included, from the robot file's uncertainty:
/// central differences over every constant that `uncertainty:` names, with its correlations.
[[nodiscard]] double energy_sigma_J(const Robot& robot, const Trajectory& log,
                                    const EstimateOptions& options = {});

}  // namespace joulepath
