#pragma once

#include "extensions/simulators/mechanism.hpp"
#include "model/sided.hpp"
#include "scenarios/robot_files/robot_draft.hpp"

namespace joulepath {

/// The parts and the values of a model that an effect of the catalog changes.
struct DriveParts {
  Sided<const MechanismJoint*> joint{};
  Sided<std::vector<const MechanismLink*>> links{};  ///< of each wheel
  const MechanismLink* heaviest{};                   ///< link of the chassis; null: none has a mass
  Sided<double> radius_m{};                          ///< of collision shapes; 0: unknown
  double chassis_mass_kg{}, chassis_yaw_inertia_kg_m2{}, center_of_mass_offset_m{};
  double mass_kg{};  ///< of the whole robot
};
[[nodiscard]] DriveParts drive_parts_of(const Mechanism& mechanism, const std::vector<std::string>& wheels);

/// The robot file's values that a model of another simulator holds. `wheels`: names of the left and the right
/// drive joint (or of the wheels); empty: the drive plugin, a transmission or an actuator names them. Throws
/// ConfigError where the drive wheels stay unknown.
[[nodiscard]] RobotDraft draft_of(const Mechanism& mechanism, const std::vector<std::string>& wheels);

}  // namespace joulepath
