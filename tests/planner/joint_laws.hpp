#pragma once

#include "model/limit_table.hpp"
#include "planner/joint/drive_law.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::joint {

/// Both motors alike: what is mirrored costs the same.
inline Robot even_nomad() {
  Robot robot = testing::nomad();
  robot.motor.left = robot.motor.right;
  return robot;
}

inline DriveLaw law_of(const Robot& robot) {
  return drive_law(make_nominal_plant(robot), limits_for_payload(robot, 0), 0, {}, 0);
}

}  // namespace joulepath::joint
