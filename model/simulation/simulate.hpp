#pragma once

#include <cstdint>
#include <vector>

#include "model/motions.hpp"
#include "model/robot.hpp"
#include "model/simulation/controller.hpp"
#include "model/simulation/integrator.hpp"
#include "model/simulation/sensors.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// A trajectory for a robot that may differ from its file.
struct SimulationRequest {
  Robot robot{};                         ///< robot of the controller, with the effects of its file
  std::vector<EffectSetting> effects{};  ///< further effects of the plant, unknown to the controller
  Trajectory reference{};                ///< speeds (body or wheels) over time; payload_kg where it varies
  std::vector<Interval> coasting{};      ///< when the bridges are open, in the reference's time
  Pose start{};
  double time_of_day_s{};
  double payload_kg{};  ///< where the reference has no payload
  ControllerSettings controller{};
  SensorSettings sensors{};
  IntegratorOptions integrator{};
  double settle_s{1.0};   ///< upper bound, for a robot that ends at rest
  std::uint64_t seed{1};  ///< of the sensors' noise
};

/// Where the energy (J) went. motors = all losses + stored.
struct EnergyBalance {
  double motors_J{};  ///< V i of both drives
  double copper_J{};
  double driver_J{};  ///< voltage drop of the bridges
  double gear_J{};
  double wheel_friction_J{};  ///< Coulomb, viscous and what the effects add at the wheels
  double body_work_J{};       ///< against the effects' forces on the body: slope, drag, scrub
  double creep_J{};
  double stored_J{};  ///< change of kinetic (and magnetic) energy
};

struct SimulationResult {
  Trajectory log{};       ///< what the instruments show
  Trajectory executed{};  ///< the truth at the samples: speeds, pose, voltage, current, power, energy_J
  double duration_s{};
  Sided<double> motor_energy_J{};
  double energy_J{};        ///< at the battery's terminals, standby included
  double battery_loss_J{};  ///< in the internal resistance
  EnergyBalance balance{};
  Pose final_pose{};
  Pose planned_pose{};               ///< where exact following ends
  double worst_speed_error_rad_s{};  ///< of a wheel, at the controller's ticks
  double saturated_fraction{};       ///< of the control periods in which a driver was at its limit
  bool battery_gave_way{};           ///< the demand exceeded the battery's power
  bool came_to_rest{};
  std::size_t steps{};
  std::size_t events{};
};

/// Drives a reference: wheel-speed control with feed-forward, drivers with their limits, battery with
/// internal resistance, the plant in state space with dry friction, and sensors.
///
/// Throws ConfigError for a reference without speeds or an unknown effect.
[[nodiscard]] SimulationResult simulate(const SimulationRequest& request);

}  // namespace joulepath
