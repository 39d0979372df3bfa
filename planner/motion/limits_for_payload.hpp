#pragma once

#include "model/robot.hpp"

namespace joulepath {

/// Limits with `limits: by_payload` applied: per key, linear between the rows that name it.
[[nodiscard]] Limits limits_for_payload(const Robot& robot, double payload_kg);

}  // namespace joulepath
