#include "extensions/nav2/controller_settings.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>

#include "extensions/nav2/exports.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

using Field = std::optional<double> ControllerFile::*;

/// Decelerations are written as negative numbers.
enum class Sign { positive, negative };

/// A scalar parameter.
struct Parameter {
  const char* key;
  Field field;
  Sign sign{Sign::positive};
};
constexpr Parameter kParameters[] = {
    {"desired_linear_vel", &ControllerFile::speed_m_s},  // RPP
    {"rotate_to_heading_angular_vel", &ControllerFile::turn_rate_rad_s},
    {"max_angular_accel", &ControllerFile::turn_acceleration_rad_s2},
    {"vx_max", &ControllerFile::speed_m_s},  // MPPI
    {"wz_max", &ControllerFile::yaw_rate_rad_s},
    {"ax_max", &ControllerFile::acceleration_m_s2},
    {"ax_min", &ControllerFile::deceleration_m_s2, Sign::negative},
    {"az_max", &ControllerFile::yaw_acceleration_rad_s2},
    {"max_vel_x", &ControllerFile::speed_m_s},  // DWB
    {"max_speed_xy", &ControllerFile::speed_m_s},
    {"max_vel_theta", &ControllerFile::yaw_rate_rad_s},
    {"acc_lim_x", &ControllerFile::acceleration_m_s2},
    {"decel_lim_x", &ControllerFile::deceleration_m_s2, Sign::negative},
    {"acc_lim_theta", &ControllerFile::yaw_acceleration_rad_s2},
    {"decel_lim_theta", &ControllerFile::yaw_deceleration_rad_s2, Sign::negative},
};

/// A parameter with a value along x and one about z.
struct PlanarParameter {
  const char* key;
  Field along, about;
  Sign sign{Sign::positive};
};
/// Of the velocity smoother, as [x, y, theta].
constexpr PlanarParameter kTriples[] = {
    {"max_velocity", &ControllerFile::speed_m_s, &ControllerFile::yaw_rate_rad_s},
    {"max_accel", &ControllerFile::acceleration_m_s2, &ControllerFile::yaw_acceleration_rad_s2},
    {"max_decel", &ControllerFile::deceleration_m_s2, &ControllerFile::yaw_deceleration_rad_s2,
     Sign::negative},
};

/// Of diff_drive_controller, in linear: x: and angular: z:.
constexpr PlanarParameter kAxes[] = {
    {"max_velocity", &ControllerFile::speed_m_s, &ControllerFile::yaw_rate_rad_s},
    {"max_acceleration", &ControllerFile::acceleration_m_s2, &ControllerFile::yaw_acceleration_rad_s2},
    {"max_deceleration", &ControllerFile::deceleration_m_s2, &ControllerFile::yaw_deceleration_rad_s2,
     Sign::negative},
};

/// Sizes beyond these have a wrong unit or digit.
constexpr double kLeastSize = 1e-3, kMostSize = 100;

/// What a node of a parameter file may hold that drives the robot.
struct Roles {
  bool plugins{true}, smoother{true};
};

/// Roles of a node, by its name or by a key that only one kind of node has. The axes of a
/// diff_drive_controller tell themselves, under any name.
Roles roles_of(const std::string& name, const Node& parameters) {
  const auto called = [&](const char* part) { return name.find(part) != std::string::npos; };
  if (called("**")) return {};  // for every node
  return {.plugins = called("controller_server") || parameters.has("controller_plugins"),
          .smoother = called("velocity_smoother") || parameters.has("smoothing_frequency")};
}

constexpr const char* kMotionWords[] = {"vel_", "_vel",  "velocity", "speed",    "accel",
                                        "acc_", "decel", "v_linear", "v_angular"};
/// Words of keys that limit no drive forward: least values, other directions, thresholds, weights.
constexpr const char* kOtherWords[] = {"min",  "scal",   "std",       "threshold", "stopped", "timeout",
                                       "cost", "weight", "deadband",  "dist",      "cancel",  "window",
                                       "_y",   "_time",  "backwards", "reverse",   "factor",  "tolerance"};

template <std::size_t n>
bool holds_one_of(const std::string& key, const char* const (&words)[n]) {
  return std::ranges::any_of(words, [&](const char* word) { return key.find(word) != std::string::npos; });
}

/// Whether a key names a speed or an acceleration that this reader does not know.
bool is_unknown_motion(const std::string& key, const Node& value) {
  const auto has_key = [&](const auto& parameter) { return key == parameter.key; };
  if (std::ranges::any_of(kParameters, has_key) || std::ranges::any_of(kTriples, has_key)) return false;
  if (!holds_one_of(key, kMotionWords) || holds_one_of(key, kOtherWords)) return false;
  return value.kind() == Value::Kind::list ||
         (value.kind() == Value::Kind::scalar && parse_number(value.text()).has_value());
}

class ControllerReader {
 public:
  ControllerFile take() { return std::move(settings_); }

  /// Reads every node of a parameter file. Of a file without `ros__parameters`, a part of one, all counts.
  void read(const Node& root) {
    if (!read_nodes(root, "")) look(root, {});
    if (plugins_.size() > 1)
      root.fail_found("several controllers that drive: " + text_of_list(plugins_), "one",
                      "leave the one to compare in the file, or in controller_plugins");
    if (unknown_.empty()) return;
    const std::string keys = text_of_list(unknown_, [](const Node& key) { return key.path(); });
    unknown_.front().fail_found(
        "speeds or accelerations of unknown names: " + keys,
        "parameters of velocity_smoother, controller_server (RPP, MPPI, DWB) or diff_drive_controller",
        "remove those that do not limit the drive, and write the others under a known name");
  }

 private:
  /// Whether the file has nodes; those that do not drive are left out.
  bool read_nodes(const Node& node, const std::string& name) {
    if (node.kind() != Value::Kind::map) return false;
    if (const auto parameters = node.find("ros__parameters")) {
      look(*parameters, roles_of(name, *parameters));
      return true;
    }
    bool found = false;
    for (const auto& [key, value] : node.entries()) found = read_nodes(value, key) || found;
    return found;
  }

  /// Reads the parameters of a map, and of the maps in it; where it lists its controllers, of those.
  void look(const Node& node, const Roles& roles) {
    if (node.kind() != Value::Kind::map) return;
    const auto listed = node.find("controller_plugins");
    std::size_t numbers = 0, triples = 0;
    for (const auto& [key, value] : node.entries()) {
      if (value.kind() == Value::Kind::scalar && roles.plugins) numbers += read_number(key, value);
      if (value.kind() == Value::Kind::list && roles.smoother) triples += read_triple(key, value);
      if (key == "linear" || key == "angular") read_axis(value, key == "linear");
      if (!listed || names_item(*listed, key)) look(value, roles);
    }
    const bool is_plugin = roles.plugins && (numbers > 0 || node.has("plugin"));
    const std::size_t unknown = is_plugin || triples > 0 ? note_unknown(node) : 0;
    if (is_plugin && numbers + unknown > 0) plugins_.push_back(node.path());
  }

  static bool names_item(const Node& list, const std::string& name) {
    return list.kind() != Value::Kind::list || std::ranges::any_of(list.items(), [&](const Node& item) {
             return item.kind() == Value::Kind::scalar && item.text() == name;
           });
  }

  std::size_t note_unknown(const Node& node) {
    const std::size_t before = unknown_.size();
    for (const auto& [key, value] : node.entries())
      if (is_unknown_motion(key, value)) unknown_.push_back(value);
    return unknown_.size() - before;
  }

  void take_least(Field field, Sign sign, const Node& value) {
    const bool down = sign == Sign::negative;
    const double size = down ? -value.number() : value.number();
    if (size == 0) return;  // no limit
    if (!(size >= kLeastSize && size <= kMostSize))
      value.fail(down ? "from -100 to -0.001 (SI units; decelerations are negative), or 0: no limit"
                      : "from 0.001 to 100 (SI units), or 0: no limit");
    std::optional<double>& known = settings_.*field;
    known = std::min(known.value_or(size), size);
    settings_.read.push_back(value.path());
  }

  /// Whether the key is one of a plugin.
  bool read_number(const std::string& key, const Node& value) {
    const Parameter* found =
        std::ranges::find_if(kParameters, [&](const Parameter& parameter) { return key == parameter.key; });
    if (found == std::end(kParameters)) return false;
    take_least(found->field, found->sign, value);
    return true;
  }

  /// Whether the key is one of the velocity smoother.
  bool read_triple(const std::string& key, const Node& value) {
    const PlanarParameter* found =
        std::ranges::find_if(kTriples, [&](const PlanarParameter& triple) { return key == triple.key; });
    if (found == std::end(kTriples)) return false;
    const std::vector<Node> items = value.items();
    if (items.size() != 3) value.fail("[x, y, theta]");
    take_least(found->along, found->sign, items[0]);
    take_least(found->about, found->sign, items[2]);
    return true;
  }

  void read_axis(const Node& axes, bool along) {
    if (axes.kind() != Value::Kind::map) return;
    const std::optional<Node> axis = axes.find(along ? "x" : "z");
    if (!axis || axis->kind() != Value::Kind::map) return;
    for (const PlanarParameter& parameter : kAxes)
      if (const auto value = axis->find(parameter.key))
        take_least(along ? parameter.along : parameter.about, parameter.sign, *value);
  }

  ControllerFile settings_{};
  std::vector<std::string> plugins_{};  ///< places of the controllers that drive
  std::vector<Node> unknown_{};
};

/// The settings for each leg in the result of export --to controller.
std::vector<LegSettings> legs_of(const Document& document) {
  check_document(document, "controller", controller_schema());
  std::vector<LegSettings> legs;
  const auto settings = [](const Node& leg, const char* rate, const char* up, const char* down) {
    return leg.has(rate)
               ? std::optional(TrapezoidSettings{leg[rate].number(), leg[up].number(), leg[down].number()})
               : std::nullopt;
  };
  for (const Node& leg : document.root()["legs"].items())
    legs.push_back(
        {.drive = settings(leg, "speed_m_s", "acceleration_m_s2", "deceleration_m_s2"),
         .turn = settings(leg, "yaw_rate_rad_s", "yaw_acceleration_rad_s2", "yaw_deceleration_rad_s2")});
  return legs;
}

/// The least of those that are there; above every setting if none is.
double least(std::initializer_list<std::optional<double>> settings) {
  double least = kMostSize;
  for (const std::optional<double>& setting : settings)
    if (setting) least = std::min(least, *setting);
  return least;
}

}  // namespace

ControllerFile read_controller_settings(const std::string& file) {
  const Document document = Document::load(file);
  const std::string kind = inferred_kind(document.root());
  if (kind == "controller") return {.file = file, .legs = legs_of(document)};
  ControllerReader reader;
  reader.read(document.root());
  ControllerFile settings = reader.take();
  if (settings.read.empty())
    document.root().fail_found((kind.empty() ? "" : "a file of kind " + kind + " with ") +
                                   std::string("no speed and no acceleration of a controller"),
                               "parameters of velocity_smoother, controller_server (RPP, MPPI, DWB) or "
                               "diff_drive_controller, or the "
                               "result of export --to controller");
  return settings;
}

LegSettings settings_of(const ControllerFile& file) {
  const auto or_up = [](const std::optional<double>& down, const std::optional<double>& up) {
    return down ? down : up;
  };
  return {.drive = TrapezoidSettings{least({file.speed_m_s}), least({file.acceleration_m_s2}),
                                     least({or_up(file.deceleration_m_s2, file.acceleration_m_s2)})},
          .turn = TrapezoidSettings{least({file.yaw_rate_rad_s, file.turn_rate_rad_s}),
                                    least({file.yaw_acceleration_rad_s2, file.turn_acceleration_rad_s2}),
                                    least({or_up(file.yaw_deceleration_rad_s2, file.yaw_acceleration_rad_s2),
                                           file.turn_acceleration_rad_s2})},
          .yaw_rate_rad_s = least({file.yaw_rate_rad_s}),
          .yaw_acceleration_rad_s2 = least({file.yaw_acceleration_rad_s2, file.yaw_deceleration_rad_s2})};
}

ControlledDrive drive_with(const Plan& plan, const ControllerFile& file) {
  if (file.legs.empty())
    return drive_with(plan, std::vector<LegSettings>(plan.legs.size(), settings_of(file)));
  if (file.legs.size() != plan.legs.size())
    throw ConfigError({{file.file, 1, 1},
                       "legs",
                       "settings for " + std::to_string(file.legs.size()) + " legs",
                       "one for each of the mission's " + std::to_string(plan.legs.size()) + " legs",
                       ""});
  return drive_with(plan, file.legs);
}

}  // namespace joulepath
