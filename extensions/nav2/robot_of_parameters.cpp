#include "extensions/nav2/robot_of_parameters.hpp"

#include <algorithm>
#include <filesystem>

#include "extensions/nav2/controller_settings.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

std::string place_in_file(const Node& node) {
  return std::filesystem::path(node.mark().file).filename().string() + " line " +
         std::to_string(node.mark().line) + ": " + node.path();
}

/// The first parameter of a name, at any depth.
std::optional<Node> parameter_named(const Node& node, const std::string& name) {
  if (node.kind() != Value::Kind::map) return std::nullopt;
  for (const auto& [key, value] : node.entries()) {
    if (key == name && value.kind() == Value::Kind::scalar) return value;
    if (auto below = parameter_named(value, name)) return below;
  }
  return std::nullopt;
}

struct LimitOfSettings {
  const char* key;
  std::optional<double> ControllerFile::*field;
};
constexpr LimitOfSettings kLimitsOfSettings[] = {
    {"limits.speed_m_s", &ControllerFile::speed_m_s},
    {"limits.acceleration_m_s2", &ControllerFile::acceleration_m_s2},
    {"limits.deceleration_m_s2", &ControllerFile::deceleration_m_s2},
    {"limits.reverse_speed_m_s", &ControllerFile::reverse_speed_m_s},
    {"limits.yaw_rate_rad_s", &ControllerFile::yaw_rate_rad_s},
    {"limits.yaw_acceleration_rad_s2", &ControllerFile::yaw_acceleration_rad_s2}};

void state_limits(const std::string& file, RobotDraft& draft) {
  const ControllerFile settings = read_controller_settings(file);
  const std::string name = std::filesystem::path(file).filename().string();
  for (const auto& [key, stated] : kLimitsOfSettings) {
    // A controller without a deceleration brakes as it accelerates.
    const bool as_up = stated == &ControllerFile::deceleration_m_s2 && !(settings.*stated);
    const auto field = as_up ? &ControllerFile::acceleration_m_s2 : stated;
    if (!(settings.*field) || *(settings.*field) == 0) continue;
    const auto at = std::ranges::find(settings.sizes, std::pair(field, *(settings.*field)));
    const auto i = static_cast<std::size_t>(at - settings.sizes.begin());
    draft.state(key, *(settings.*field),
                name + " line " + std::to_string(settings.lines[i]) + ": " + settings.read[i] +
                    (as_up ? ", as no deceleration is stated" : ""));
  }
}

/// The corners of a footprint, which is a text that holds a list. Fewer than three are no footprint.
std::vector<std::string> corners_of(const Node& text) {
  std::vector<std::string> corners;
  if (text.text().find('[') == std::string::npos) return corners;
  const Document list = Document::parse(text.text(), text.mark().file, text.mark().line);
  for (const Node& corner : list.root().items()) {
    const std::vector<Node> xy = corner.items();
    if (xy.size() != 2) text.fail("[[x, y], ...]");
    corners.push_back("[" + significant_text(xy[0].number()) + ", " + significant_text(xy[1].number()) + "]");
  }
  return corners.size() < 3 ? std::vector<std::string>() : corners;
}

/// Of the first costmap that states one: its footprint, else its radius.
bool state_footprint_of(const Node& node, RobotDraft& draft) {
  if (node.kind() != Value::Kind::map) return false;
  const auto scalar = [&](const char* key) {
    const auto found = node.find(key);
    return found && found->kind() == Value::Kind::scalar ? found : std::nullopt;
  };
  const auto text = scalar("footprint"), radius = scalar("robot_radius");
  if (const auto corners = text ? corners_of(*text) : std::vector<std::string>(); !corners.empty()) {
    draft.values.push_back(
        {"footprint.polygon_m", "[" + text_of_list(corners) + "]",
         place_in_file(*text) + ", about the base frame: shift it to the middle of the axle"});
    return true;
  }
  if (radius) {
    draft.state("footprint.radius_m", radius->number(), place_in_file(*radius));
    return true;
  }
  return std::ranges::any_of(node.entries(),
                             [&](const auto& entry) { return state_footprint_of(entry.second, draft); });
}

}  // namespace

bool is_parameter_file(const Document& document) {
  return inferred_kind(document.root()) == "ROS parameters";
}

RobotDraft read_parameters_of_robot(const std::string& file, const std::vector<std::string>&) {
  const Document document = Document::load(file);
  RobotDraft draft;
  const Node root = document.root();
  const auto factor = [&](const char* name) {
    const auto value = parameter_named(root, name);
    return value ? value->number() : 1.0;
  };
  if (const auto radius = parameter_named(root, "wheel_radius"); radius && radius->number() > 0) {
    const double left = factor("left_wheel_radius_multiplier"),
                 right = factor("right_wheel_radius_multiplier");
    draft.state("geometry.wheel_radius_m", left * radius->number(), right * radius->number(),
                place_in_file(*radius) + (left != 1 || right != 1 ? " times the wheels' multipliers" : ""));
  }
  if (const auto track = parameter_named(root, "wheel_separation"); track && track->number() > 0) {
    const double scale = factor("wheel_separation_multiplier");
    draft.state("geometry.half_track_m", 0.5 * scale * track->number(),
                place_in_file(*track) + ", half of it" + (scale != 1 ? " times its multiplier" : ""));
  }
  state_footprint_of(document.root(), draft);
  try {
    state_limits(file, draft);
  } catch (const ConfigError& error) {  // a file of wheels or costmaps alone, or several controllers
    if (draft.values.empty()) throw;
    draft.notes.push_back(std::string("limits are not read: ") + error.what());
  }
  return draft;
}

bool is_rmf_fleet(const Document& document) {
  return document.root().kind() == Value::Kind::map && document.root().has("rmf_fleet");
}

RobotDraft read_rmf_fleet(const std::string& file, const std::vector<std::string>&) {
  const Document document = Document::load(file);
  const Node fleet = document.root()["rmf_fleet"];
  RobotDraft draft{.name = fleet.text_or("name", "")};
  const auto section = [&](const char* name) -> std::optional<Node> {
    const auto found = fleet.find(name);
    return found && found->kind() == Value::Kind::map ? found : std::nullopt;
  };
  const auto state = [&](const std::optional<Node>& in, const char* name, const char* key,
                         const std::string& what = "") {
    const auto value = in ? in->find(name) : std::nullopt;
    if (value) draft.state(key, value->number(), place_in_file(*value) + what);
    return value;
  };
  const auto pair = [&](const char* name, const char* speed_key, const char* acceleration_key) {
    const auto limits = section("limits");
    const auto values = limits ? limits->find(name) : std::nullopt;
    if (!values) return;
    const std::vector<Node> items = values->items();
    if (items.size() != 2) values->fail("[speed, acceleration]");
    draft.state(speed_key, items[0].number(), place_in_file(*values));
    draft.state(acceleration_key, items[1].number(), place_in_file(*values));
  };
  pair("linear", "limits.speed_m_s", "limits.acceleration_m_s2");
  pair("angular", "limits.yaw_rate_rad_s", "limits.yaw_acceleration_rad_s2");
  const auto mechanics = section("mechanical_system");
  state(mechanics, "mass", "inertia.chassis_mass_kg", ", which includes the wheels: take both off");
  state(mechanics, "moment_of_inertia", "inertia.chassis_yaw_inertia_kg_m2");
  if (const auto friction = mechanics ? mechanics->find("friction_coefficient") : std::nullopt)
    draft.values.push_back({"effects",
                            "rolling_resistance: {coefficient: " + significant_text(friction->number()) + "}",
                            place_in_file(*friction) + " (a share of the weight)"});
  state(section("profile"), "footprint", "footprint.radius_m");
  state(section("ambient_system"), "power", "power.standby_W");
  const auto battery = section("battery_system");
  const auto voltage = state(battery, "voltage", "battery.open_circuit_voltage_V");
  if (const auto capacity = battery ? battery->find("capacity") : std::nullopt; capacity && voltage)
    draft.state("battery.capacity_Wh", voltage->number() * capacity->number(),
                place_in_file(*capacity) + " (Ah) * voltage");
  if (const auto threshold = fleet.find("recharge_threshold"))
    draft.state("battery.reserve_fraction", threshold->number(), place_in_file(*threshold));
  return draft;
}

}  // namespace joulepath
