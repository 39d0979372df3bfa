#pragma once

#include "model/robot.hpp"

namespace joulepath {

/// What a robot without payload can do on a straight line: steady states of the power model [P1, Eqs.
/// (19)-(28)] with its effects, within the voltage and current of its motors.
struct Abilities {
  Sided<double> motor_torque_Nm{};     ///< at the wheel at standstill: Kt n min(max_current, max_voltage/R)
  Sided<double> friction_torque_Nm{};  ///< at the wheel, just above standstill
  double top_speed_m_s{};              ///< on a level floor; infinite where nothing bounds it; 0: cannot move
  double cruise_m_s{};                 ///< 1 m/s, or less where limits or motors allow less
  double energy_J_m{};                 ///< at that speed, standby included
  double grade{};                      ///< rise over run on which it can start; infinite: the torque lifts it
  double distance_m{};                 ///< at that speed until the battery's reserve; infinite: no capacity

  [[nodiscard]] bool can_move() const { return top_speed_m_s > 0; }
};

[[nodiscard]] Abilities abilities_of(const Robot& robot);

}  // namespace joulepath
