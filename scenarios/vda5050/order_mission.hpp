#pragma once

#include "planner/values/mission_request.hpp"
#include "scenarios/vda5050/order.hpp"

namespace joulepath {

/// Fills a mission's start, legs and speed zones from the base of the order that it names; the horizon is not
/// planned.
///
/// A leg ends where an action keeps the robot from driving, where the payload changes, and at the last node.
/// An action lasts as long as its parameter `duration` says, else as `dwell_by_action_s`, else no time; on an
/// edge it is done before the edge. Without `start:` the robot stands on the first node. Throws ConfigError.
void follow_order(MissionRequest& mission, const NamedBy& named_by = {});

/// Standing time for actions (s): one after the other where one is HARD or SINGLE, else together.
[[nodiscard]] double standing_s(const std::vector<OrderAction>& actions,
                                const std::map<std::string, double>& dwell_by_action_s);

}  // namespace joulepath
