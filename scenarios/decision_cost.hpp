#pragma once

#include <cstddef>

#include "model/robot.hpp"

namespace joulepath {

/// What planning with the wrong model costs.
struct DecisionCost {
  std::size_t missions{};        ///< that could be planned with both models
  double joules_lost_percent{};  ///< of the motion's energy, on the corrected plant
};

/// Plans standard missions (straight and curved, without and with half of the payload, along given paths)
/// with the nominal and with the corrected robot, each free to choose its time, and drives both plans on the
/// corrected plant: what the nominal plan takes on top, standby included, relative to the better plan.
///
/// Limits come from the robot file; where it gives none, 1 m/s, 0.5 m/s^2 and 1 rad/s^2 are taken.
[[nodiscard]] DecisionCost decision_cost(const Robot& nominal, const Robot& corrected);

/// The same with both plans driven on a robot of its own: what the correction is worth where the truth is
/// known (negative: the corrected robot plans worse).
[[nodiscard]] DecisionCost decision_cost(const Robot& nominal, const Robot& corrected, const Robot& driven);

}  // namespace joulepath
