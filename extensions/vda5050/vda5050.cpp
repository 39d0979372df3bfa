#include "extensions/vda5050/order_json.hpp"
#include "extensions/vda5050/order_mission.hpp"
#include "extensions/vda5050/state_lines.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/counted.hpp"
// Design: docs/decisions/0603-orders-and-exports.md

namespace joulepath {
namespace {

FileSummary check_order_file(const std::string& file, const ReadOptions&) {
  const Order order = read_order(file);
  std::string way = ", reached from where the robot stands";
  if (order.released_count() > 1) {
    MissionRequest mission{.order_file = file};
    follow_order(mission);
    way = ", driven in " + counted(mission.legs.size(), "leg");
  }
  FileSummary summary{"order", counted(order.nodes.size(), "node") + way, order_notes(order)};
  if (const std::size_t horizon = order.nodes.size() - order.released_count(); horizon > 0)
    summary.notes.push_back(counted(horizon, "node") + " of the horizon: not planned");
  return summary;
}

void read_named_order(MissionRequest& mission, const Node& name) { follow_order(mission, NamedBy(name)); }

std::vector<std::string> notes_of_order(const std::string& file) { return order_notes(read_order(file)); }

void read_order_as_mission(MissionRequest& mission) {
  mission.order_file = mission.file;
  follow_order(mission);
}

/// A field of version 2, then that of version 3.
std::vector<std::pair<std::string, std::vector<std::string>>> state_columns() {
  return {{"linear_speed_m_s", {"velocity.vx"}},
          {"angular_speed_rad_s", {"velocity.omega"}},
          {"position_x_m", {"agvPosition.x", "mobileRobotPosition.x"}},
          {"position_y_m", {"agvPosition.y", "mobileRobotPosition.y"}},
          {"heading_rad", {"agvPosition.theta", "mobileRobotPosition.theta"}},
          {"battery_voltage_V", {"batteryState.batteryVoltage", "powerSupply.batteryVoltage"}},
          {"battery_current_A", {"powerSupply.batteryCurrent"}}};
}

}  // namespace

void add_vda5050(Registry& registry) {
  registry.messages.push_back({is_state_lines, read_state_lines, kStateType, state_columns()});
  registry.files.push_back(
      {.kind = "order", .recognizes_document = is_order, .key = "orderId", .check = check_order_file});
  registry.mission_keys.push_back({.key = "order", .read = read_named_order});
  registry.mission_documents.push_back(
      {.says = "a VDA 5050 order",
       .use = "plan takes an order with --robot; elsewhere a mission names it with order:",
       .example = "order.json --robot robot.yaml --out out   # a VDA 5050 order",
       .recognizes = is_order,
       .read = read_order_as_mission,
       .notes = notes_of_order});
  registry.exports.push_back(
      {.name = "vda5050",
       .says = "the order with a maximum speed on each edge (JSON), and the resulting energy loss",
       .write = export_vda5050,
       .example = "order.json --robot robot.yaml --to vda5050 --out slower.json"});
}

}  // namespace joulepath
