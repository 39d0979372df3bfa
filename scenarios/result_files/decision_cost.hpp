#pragma once

#include <cstddef>

#include "model/robot.hpp"

namespace joulepath {

/// The cost of planning with a wrong model.
struct DecisionCost {
  std::size_t missions{};        ///< with plans for both models
  double joules_lost_percent{};  ///< of the nominal plans' energy
};

/// Plans standard missions (straight and curved, without and with half of the payload, along given paths)
/// with the nominal and with the corrected robot, each in its own optimal time, and drives both plans on the
/// corrected plant: the additional energy of the nominal plan, standby included, in percent of its own
/// energy.
///
/// Limits come from the robot file; without any: 1 m/s, 0.5 m/s^2 and 1 rad/s^2.
[[nodiscard]] DecisionCost decision_cost(const Robot& nominal, const Robot& corrected);

/// The same with both plans driven on another robot: the value of the correction if the truth is known
/// (negative: plans of the corrected robot are worse).
[[nodiscard]] DecisionCost decision_cost(const Robot& nominal, const Robot& corrected, const Robot& driven);

}  // namespace joulepath
