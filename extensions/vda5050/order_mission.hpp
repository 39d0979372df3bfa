#pragma once

#include "extensions/vda5050/order.hpp"
#include "planner/values/mission_request.hpp"

namespace joulepath {

/// Fills a mission's start, legs and speed zones from the base of its order; the horizon is not planned.
///
/// A leg ends where an action prevents driving, where the payload changes, and at the last node. The duration
/// of an action is its parameter `duration`, else that of `dwell_by_action_s`, else zero; an action of an
/// edge is done before the edge. Without `start:` the robot stands on the first node. The way to the only
/// node of an order, from a `start:` elsewhere, is searched. Throws ConfigError.
void follow_order(MissionRequest& mission, const NamedBy& named_by = {});

/// What is doubtful about an order: distances that suggest millimeters.
[[nodiscard]] std::vector<std::string> order_notes(const Order& order);

/// Standing time for actions (s): one after the other if one is HARD or SINGLE, else together.
[[nodiscard]] double standing_s(const std::vector<OrderAction>& actions,
                                const std::map<std::string, double>& dwell_by_action_s);

}  // namespace joulepath
