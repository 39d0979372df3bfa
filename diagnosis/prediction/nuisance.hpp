#pragma once

#include "diagnosis/thresholds.hpp"
#include "model/nuisance.hpp"

namespace joulepath {

/// Errors of every robot that no robot file contains: tires creep slightly under force, time stamps of
/// the electrical channels are accurate to a part of a sample only, and after a turn the contacts may hold a
/// yaw moment on a straight line.
inline const std::string kCreepNuisance = "contact_creep";
inline const std::string kStampNuisance = "time_stamps";
inline const std::string kHeldTurnNuisance = "held_turn";
/// Tires and gears are springs: the body swings behind its rotors, along the way and in yaw.
inline const std::string kSwingNuisance = "swing";
inline const std::string kYawSwingNuisance = "yaw_swing";
/// An instrument of its own is late or early by a part of its readings' period, a pose also where wheel
/// speeds are those at the stamp and not means over the sample; the battery's readings are also means of
/// another length than the motors'.
inline const std::string kGyroStampNuisance = "gyro_time_stamps";
inline const std::string kPoseStampNuisance = "pose_time_stamps";
inline const std::string kBatteryStampNuisance = "battery_time_stamps";
inline const std::string kBatteryMeanNuisance = "battery_mean";

/// 1-sigma of the creep compliance of a robot's tires, m/s per N.
inline double usual_creep_m_s_N(const Robot& robot) {
  return kUsualCreep_kg_m_s_N / robot.total_mass_kg(0.0);
}

/// 1-sigma of the moment that the contacts hold after a turn, N m.
double usual_held_moment_Nm(const Robot& robot);

/// True for errors of instruments' clocks and for the body's swing: columns of the linear problem only, too
/// small for a model of their own.
bool is_column_only(const Nuisance& nuisance);

/// True for a constant with a relative error. Creep, swing, time stamps and a held moment are errors about 0.
bool is_factor(const Nuisance& nuisance);

/// A calibration constant in words: "wheel_radius_m" or "friction_torque_Nm (left)".
std::string text_of(const Nuisance& nuisance);

/// Nuisances: the `uncertainty:` of the robot file, tire creep, the body's swing, errors of clocks and the
/// moment held after a turn.
std::vector<Nuisance> calibration_nuisances(const Robot& robot);

}  // namespace joulepath
