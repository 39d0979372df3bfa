#pragma once

#include "model/nuisance.hpp"

namespace joulepath {

/// Two things that every robot has and no robot file tells: tires creep a little under force, and the
/// electrical channels' time stamps are good to a part of a sample only.
inline const std::string kCreepNuisance = "contact_creep";
inline const std::string kStampNuisance = "time_stamps";
inline constexpr double kUsualCreep_m_s_N = 7e-5;  ///< 1/creep stiffness of a rubber tire, order of magnitude
inline constexpr double kStampFraction = 0.2;      ///< of the log's period, 1-sigma

/// What `uncertainty:` says, then creep and time stamps: all that a calibration may have missed.
std::vector<Nuisance> calibration_nuisances(const Robot& robot);

}  // namespace joulepath
