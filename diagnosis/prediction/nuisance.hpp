#pragma once

#include "diagnosis/thresholds.hpp"
#include "model/nuisance.hpp"

namespace joulepath {

/// Two errors of every robot that no robot file contains: tires creep slightly under force, and time stamps
/// of the electrical channels are accurate to a part of a sample only.
inline const std::string kCreepNuisance = "contact_creep";
inline const std::string kStampNuisance = "time_stamps";

/// 1-sigma of the creep compliance of a robot's tires, m/s per N.
inline double usual_creep_m_s_N(const Robot& robot) {
  return kUsualCreep_kg_m_s_N / robot.total_mass_kg(0.0);
}

/// A calibration constant in words: "wheel_radius_m" or "friction_torque_Nm (left)".
std::string text_of(const Nuisance& nuisance);

/// Nuisances: the `uncertainty:` of the robot file, tire creep and time stamps.
std::vector<Nuisance> calibration_nuisances(const Robot& robot);

}  // namespace joulepath
