#pragma once

#include "model/effects/effect.hpp"

namespace joulepath {

namespace robot_measures {
/// Mean torque at a wheel on a level floor, from rolling and the drive's own friction: T_m + c N r, with the
/// rolling coefficient c = 0.01 of a hard tire.
double resisting_torque_Nm(const Robot& robot);
double resisting_force_N(const Robot& robot);    ///< sum of these torques over r
double resisting_moment_Nm(const Robot& robot);  ///< the force at half the track
double resisting_current_A(const Robot& robot);  ///< mean motor current that these torques take
double standby_W(const Robot& robot);
}  // namespace robot_measures

inline constexpr Yardstick kResistingTorque{robot_measures::resisting_torque_Nm, 0.463};
inline constexpr Yardstick kResistingForce{robot_measures::resisting_force_N, 9.27};
inline constexpr Yardstick kResistingMoment{robot_measures::resisting_moment_Nm, 1.53};
inline constexpr Yardstick kResistingCurrent{robot_measures::resisting_current_A, 0.27};
inline constexpr Yardstick kStandby{robot_measures::standby_W, 10.0};

}  // namespace joulepath
