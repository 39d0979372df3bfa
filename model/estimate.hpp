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

/// What a motion takes, by the model. Nothing but the motion is looked at.
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
///   wheel speeds -> v, omega -> slopes -> operating_point() -> P, E = \int P dt   [P1, Eqs. (28), (29),
///   (35)]
///
/// A wheel slower than the noise of its speed stands: no friction is asked to turn it.
/// Throws ConfigError for a log with fewer than two samples or no speeds.
[[nodiscard]] EnergyEstimate estimate_energy(const Plant& plant, const Trajectory& log,
                                             const EstimateOptions& options = {});

/// Energy that the channels of a log show for each motor: power, or voltage and current; empty where they
/// are missing. `efficiency` is what of negative power counts.
[[nodiscard]] std::optional<Sided<double>> measured_motor_energy_J(const Trajectory& log, double efficiency);

/// Energy at the battery's terminals that a log shows, empty where it has no battery channels.
[[nodiscard]] std::optional<double> measured_battery_energy_J(const Trajectory& log);

/// 1-sigma (J) of the energy at the terminals, battery loss included, from the robot file's uncertainty:
/// central differences over every constant that `uncertainty:` names, errors independent.
[[nodiscard]] double energy_sigma_J(const Robot& robot, const Trajectory& log,
                                    const EstimateOptions& options = {});

}  // namespace joulepath
