#include "extensions/vda5050/order_mission.hpp"

#include <algorithm>
#include <cmath>

#include "extensions/vda5050/order_path.hpp"

namespace joulepath {
namespace {

using Blocking = OrderAction::Blocking;

constexpr double kHeadingRounding_rad = 0.01;
constexpr double kFarNeighbor_m = 300;  ///< between neighbors in a building or a yard

bool keeps_standing(const OrderAction& action) {
  return action.blocking == Blocking::soft || action.blocking == Blocking::hard;
}

/// Payload after some actions.
double payload_after_kg(double payload_kg, const std::vector<OrderAction>& actions,
                        const std::map<std::string, double>& by_action_kg) {
  for (const OrderAction& action : actions) {
    const auto found = by_action_kg.find(action.type);
    if (action.type == "drop")
      payload_kg = found == by_action_kg.end() ? 0.0 : std::max(0.0, payload_kg - found->second);
    else if (found != by_action_kg.end())
      payload_kg += found->second;
  }
  return payload_kg;
}

/// Actions at a node before the robot drives on: the node's, and those of the next edge.
std::vector<OrderAction> actions_at(const Order& order, std::size_t node, std::size_t nodes) {
  std::vector<OrderAction> actions = order.nodes[node].actions;
  if (node + 1 < nodes)
    actions.insert(actions.end(), order.edges[node].actions.begin(), order.edges[node].actions.end());
  return actions;
}

/// Places the robot on the first node, or checks that the mission's start is there.
void place_start(MissionRequest& mission, const Order& order) {
  const OrderNode& first = order.nodes.front();
  if (mission.marks.keys.contains("start")) {
    const double off_m = std::hypot(mission.start.pose.x_m - first.x_m, mission.start.pose.y_m - first.y_m);
    if (off_m > std::max(first.deviation_m, kTrajectoryRounding_m))
      throw ConfigError({mission.marks.at("start"), "start",
                         "a start beside the order's first node " + first.id,
                         "that node's place, or no start", "an order begins where the robot stands"});
  }
  const bool heading_known = mission.marks.keys.contains("start") && mission.start.heading_given;
  const double heading_rad =
      heading_known ? mission.start.pose.heading_rad : first.heading_rad.value_or(heading_into(order, 0));
  mission.start.pose = {first.x_m, first.y_m, heading_rad};
  mission.start.heading_given = true;
}

/// Whether the robot is at a node, in its heading where both have one.
bool stands_there(const MissionRequest& mission, const OrderNode& node) {
  if (!mission.marks.keys.contains("start")) return false;
  const Pose& here = mission.start.pose;
  if (node.heading_rad && mission.start.heading_given &&
      std::abs(wrapped_angle_rad(*node.heading_rad - here.heading_rad)) >
          std::max(node.deviation_rad, kHeadingRounding_rad))
    return false;
  return std::hypot(here.x_m - node.x_m, here.y_m - node.y_m) <=
         std::max(node.deviation_m, kTrajectoryRounding_m);
}

[[noreturn]] void refuse_one_node(const OrderNode& node, const std::string& hint) {
  throw ConfigError({node.marks.item, "/nodes", "a base of one node", "at least two released nodes", hint});
}

/// The way from the robot's pose to the one node of an order, by the search.
void drive_to_only_node(MissionRequest& mission, const Order& order) {
  const OrderNode& node = order.nodes.front();
  if (!mission.marks.keys.contains("start"))
    refuse_one_node(node, "a mission with order:, start: and map: plans the way from the robot's pose");
  mission.stations.insert_or_assign(
      node.id,
      Station{.x_m = node.x_m, .y_m = node.y_m, .heading_rad = node.heading_rad, .marks = node.marks});
  mission.legs.push_back(
      {.to = node.id, .dwell_s = standing_s(node.actions, mission.dwell_by_action_s), .marks = node.marks});
}

double lowest(const std::optional<double>& cap, double other) { return cap ? std::min(*cap, other) : other; }

/// The leg over edges `first` to `last` (not included).
LegRequest leg_over(const Order& order, std::size_t first, std::size_t last, const Pose& start) {
  OrderPath way = order_path(order, first, last, start);
  LegRequest leg{.to = order.nodes[last].id,
                 .path = PathRequest{.ready = std::move(way.path)},
                 .parts = std::move(way.parts),
                 .marks = order.nodes[last].marks};
  for (std::size_t edge = first; edge < last; ++edge)
    if (const auto cap = order.edges[edge].yaw_rate_rad_s)
      leg.yaw_rate_rad_s = lowest(leg.yaw_rate_rad_s, *cap);
  return leg;
}

void append_zones(MissionRequest& mission, const Order& order, std::size_t first) {
  const LegRequest& leg = mission.legs.back();
  for (std::size_t k = 0; k < leg.parts.size(); ++k) {
    const OrderEdge& edge = order.edges[first + k];
    if (edge.speed_m_s && leg.parts[k].from_m < leg.parts[k].to_m)
      mission.speed_zones.push_back({.leg = mission.legs.size() - 1,
                                     .from_m = leg.parts[k].from_m,
                                     .to_m = leg.parts[k].to_m,
                                     .speed_m_s = *edge.speed_m_s,
                                     .marks = edge.marks});
  }
}

/// Whether distances suggest millimeters.
bool looks_like_millimeters(const Order& order) {
  std::vector<double> apart_m;
  for (std::size_t i = 0; i + 1 < order.nodes.size(); ++i)
    apart_m.push_back(
        std::hypot(order.nodes[i + 1].x_m - order.nodes[i].x_m, order.nodes[i + 1].y_m - order.nodes[i].y_m));
  std::ranges::sort(apart_m);
  return !apart_m.empty() && apart_m[apart_m.size() / 2] > kFarNeighbor_m;
}

}  // namespace

std::vector<std::string> order_notes(const Order& order) {
  if (!looks_like_millimeters(order)) return {};
  return {"nodes are more than " + std::to_string(static_cast<int>(kFarNeighbor_m)) +
          " m apart (median): are the coordinates millimetres? VDA 5050 has metres"};
}

double standing_s(const std::vector<OrderAction>& actions,
                  const std::map<std::string, double>& dwell_by_action_s) {
  double begin_s = 0, busy_s = 0, standing_s = 0;
  for (const OrderAction& action : actions) {
    const auto found = dwell_by_action_s.find(action.type);
    const double lasts_s = action.duration_s.value_or(found == dwell_by_action_s.end() ? 0.0 : found->second);
    const bool alone = action.blocking == Blocking::hard || action.blocking == Blocking::single;
    if (alone) begin_s = busy_s;
    const double end_s = begin_s + lasts_s;
    busy_s = std::max(busy_s, end_s);
    if (alone) begin_s = end_s;
    if (keeps_standing(action)) standing_s = std::max(standing_s, end_s);
  }
  return standing_s;
}

void follow_order(MissionRequest& mission, const NamedBy& named_by) {
  const Order order = read_order(mission.order_file, named_by);
  const std::size_t nodes = order.released_count();
  if (nodes < 2 && !stands_there(mission, order.nodes.front())) return drive_to_only_node(mission, order);
  place_start(mission, order);
  Pose here = mission.start.pose;
  double payload_kg = 0.0;
  std::size_t first = 0;
  for (std::size_t node = 0; node < nodes; ++node) {
    const std::vector<OrderAction> actions = actions_at(order, node, nodes);
    const double after_kg = payload_after_kg(payload_kg, actions, mission.payload_by_action);
    const bool stops = node + 1 == nodes || after_kg != payload_kg ||
                       std::any_of(actions.begin(), actions.end(), keeps_standing);
    if (!stops) continue;
    const double dwell_s = standing_s(actions, mission.dwell_by_action_s);
    if (node > 0 || dwell_s > 0) {
      mission.legs.push_back(node > 0 ? leg_over(order, first, node, here)
                                      : LegRequest{.to = order.nodes[0].id,
                                                   .path = PathRequest{.ready = Path{}},
                                                   .marks = order.nodes[0].marks});
      LegRequest& leg = mission.legs.back();
      leg.payload = {payload_kg, payload_kg};
      leg.dwell_s = dwell_s;
      append_zones(mission, order, first);
      if (!leg.path->ready->pieces.empty()) here = leg.path->ready->end();
    }
    payload_kg = after_kg;
    first = node;
  }
  if (mission.legs.empty())
    refuse_one_node(order.nodes.front(), "the robot stands there and no action holds it: nothing to plan");
}

}  // namespace joulepath
