#include "extensions/nav2/controller_settings.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <string_view>

#include "extensions/nav2/exports.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

using Field = std::optional<double> ControllerFile::*;

/// Decelerations are written as negative numbers, by old controllers as positive ones. Only a negative least
/// speed allows driving backward.
enum class Sign { positive, negative, either, reverse };

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
    {"max_linear_vel", &ControllerFile::speed_m_s},  // RPP since its dynamic window
    {"max_angular_vel", &ControllerFile::yaw_rate_rad_s},
    {"max_linear_accel", &ControllerFile::acceleration_m_s2},
    {"max_linear_decel", &ControllerFile::deceleration_m_s2, Sign::either},
    {"max_angular_decel", &ControllerFile::yaw_deceleration_rad_s2, Sign::negative},
    {"vx_max", &ControllerFile::speed_m_s},  // MPPI
    {"vx_min", &ControllerFile::reverse_speed_m_s, Sign::reverse},
    {"wz_max", &ControllerFile::yaw_rate_rad_s},
    {"ax_max", &ControllerFile::acceleration_m_s2},
    {"ax_min", &ControllerFile::deceleration_m_s2, Sign::negative},
    {"az_max", &ControllerFile::yaw_acceleration_rad_s2},
    {"max_vel_x", &ControllerFile::speed_m_s},  // DWB and TEB
    {"min_vel_x", &ControllerFile::reverse_speed_m_s, Sign::reverse},
    {"max_speed_xy", &ControllerFile::speed_m_s},
    {"max_vel_theta", &ControllerFile::yaw_rate_rad_s},
    {"acc_lim_x", &ControllerFile::acceleration_m_s2},
    {"decel_lim_x", &ControllerFile::deceleration_m_s2, Sign::negative},
    {"acc_lim_theta", &ControllerFile::yaw_acceleration_rad_s2},
    {"decel_lim_theta", &ControllerFile::yaw_deceleration_rad_s2, Sign::negative},
    {"v_linear_max", &ControllerFile::speed_m_s},  // Graceful
    {"v_angular_max", &ControllerFile::yaw_rate_rad_s},
    {"deceleration_max", &ControllerFile::deceleration_m_s2},
};

/// A parameter with a value along x and one about z.
struct PlanarParameter {
  const char* key;
  Field along, about;
  Sign sign{Sign::positive};
};
/// Of the velocity smoother, as [x, y, theta] or [x, y, z, roll, pitch, yaw].
constexpr PlanarParameter kTwists[] = {
    {"max_velocity", &ControllerFile::speed_m_s, &ControllerFile::yaw_rate_rad_s},
    {"min_velocity", &ControllerFile::reverse_speed_m_s, nullptr, Sign::reverse},
    {"max_accel", &ControllerFile::acceleration_m_s2, &ControllerFile::yaw_acceleration_rad_s2},
    {"max_decel", &ControllerFile::deceleration_m_s2, &ControllerFile::yaw_deceleration_rad_s2,
     Sign::negative},
};

/// Of diff_drive_controller, below linear.x and angular.z, and the flag that switches each off.
struct AxisParameter {
  PlanarParameter parameter;
  const char* flag;
};
constexpr AxisParameter kAxes[] = {
    {{"max_velocity", &ControllerFile::speed_m_s, &ControllerFile::yaw_rate_rad_s}, "has_velocity_limits"},
    {{"min_velocity", &ControllerFile::reverse_speed_m_s, nullptr, Sign::reverse}, "has_velocity_limits"},
    {{"max_acceleration", &ControllerFile::acceleration_m_s2, &ControllerFile::yaw_acceleration_rad_s2},
     "has_acceleration_limits"},
    {{"min_acceleration", &ControllerFile::deceleration_m_s2, &ControllerFile::yaw_deceleration_rad_s2,
      Sign::negative},
     "has_acceleration_limits"},
    {{"max_deceleration", &ControllerFile::deceleration_m_s2, &ControllerFile::yaw_deceleration_rad_s2,
      Sign::negative},
     "has_acceleration_limits"},
};

/// What a kind of plugin (by a part of its type's name) does beside its limits, which no comparison models.
struct PluginKind {
  const char* type;
  const char* beside;
};
constexpr PluginKind kPluginKinds[] = {
    {"RegulatedPurePursuit", "slower in curves, near obstacles and on the approach to the goal"},
    {"MPPI", "sampled controls and their critics"},
    {"DWB", "the choice among sampled speeds by its critics"},
    {"Graceful", "slower in curves and on the approach to the goal"},
    {"Teb", "times stretched near obstacles"},
    {"RotationShim", "a turn towards the path before the primary controller drives"},
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

/// The row of a table with this key; its end where there is none.
template <class Row, std::size_t n>
const Row* row_of(const Row (&rows)[n], const std::string& key) {
  return std::ranges::find_if(rows, [&](const Row& row) { return key == row.key; });
}

/// Whether a key names a speed or an acceleration that this reader does not know.
bool is_unknown_motion(const std::string& key, const Node& value) {
  if (row_of(kParameters, key) != std::end(kParameters) || row_of(kTwists, key) != std::end(kTwists))
    return false;
  if (!holds_one_of(key, kMotionWords) || holds_one_of(key, kOtherWords)) return false;
  return value.kind() == Value::Kind::list ||
         (value.kind() == Value::Kind::scalar && parse_number(value.text()).has_value());
}

/// Parameters with one prefix: `FollowPath`, `linear.x`. A file may nest them or write dots.
struct ParameterGroup {
  std::string prefix{};
  std::vector<std::pair<std::string, Node>> values{};

  std::optional<Node> find(std::string_view key) const {
    for (const auto& [name, value] : values)
      if (name == key) return value;
    return std::nullopt;
  }
  bool ends_with(std::string_view part) const {
    return prefix == part || prefix.ends_with("." + std::string(part));
  }
};

/// The groups of a map, in the file's order.
class ParameterGroups {
 public:
  explicit ParameterGroups(const Node& parameters) { add(parameters, ""); }
  const std::vector<ParameterGroup>& all() const { return groups_; }

 private:
  void add(const Node& node, const std::string& prefix) {
    group(prefix);
    for (const auto& [key, value] : node.entries()) {
      const std::string name = prefix.empty() ? key : prefix + "." + key;
      const std::size_t dot = name.rfind('.');
      if (value.kind() == Value::Kind::map)
        add(value, name);
      else
        group(dot == std::string::npos ? "" : name.substr(0, dot))
            .values.emplace_back(name.substr(dot == std::string::npos ? 0 : dot + 1), value);
    }
  }
  ParameterGroup& group(const std::string& prefix) {
    const auto found = std::ranges::find(groups_, prefix, &ParameterGroup::prefix);
    return found != groups_.end() ? *found : groups_.emplace_back(ParameterGroup{.prefix = prefix});
  }

  std::vector<ParameterGroup> groups_{};
};

/// "FollowPath.vx_max in line 7".
std::string place_of(const Node& value) {
  return value.path() + " in line " + std::to_string(value.mark().line);
}

/// A drive's settings in one group of parameters.
struct Driver {
  std::string name{};  ///< its prefix, below the node's
  ControllerFile settings{};
  std::vector<Node> unknown{};
  const PluginKind* kind{};
};

class ControllerReader {
 public:
  explicit ControllerReader(std::string plugin) : plugin_(std::move(plugin)) {}

  /// Reads every node of a parameter file. Of a file without `ros__parameters`, a part of one, all counts.
  ControllerFile read(const Node& root) {
    refuse_ros_1(root);
    if (!read_nodes(root, "") && root.kind() == Value::Kind::map) look(root, {});
    choose_plugin(root);
    ControllerFile settings;
    std::vector<Node> unknown;
    for (Driver& driver : drivers_) {
      merge(driver.settings, settings);
      if (driver.kind != nullptr) {
        settings.not_modelled.push_back(driver.name + ": " + driver.kind->beside);
        for (const Node& value : driver.unknown) settings.unused.push_back(place_of(value));
      } else {
        unknown.insert(unknown.end(), driver.unknown.begin(), driver.unknown.end());
      }
    }
    if (!unknown.empty()) fail_unknown(unknown);
    return settings;
  }

 private:
  static void refuse_ros_1(const Node& root) {
    for (const char* name : {"TebLocalPlannerROS", "DWAPlannerROS", "TrajectoryPlannerROS"})
      if (const auto found = root.kind() == Value::Kind::map ? root.find(name) : std::nullopt)
        found->fail_found("parameters of ROS 1", "a parameter file of ROS 2, with ros__parameters",
                          "write its speeds and accelerations as velocity_smoother's");
  }

  [[noreturn]] static void fail_unknown(const std::vector<Node>& unknown) {
    const std::string keys = text_of_list(unknown, [](const Node& key) { return key.path(); });
    unknown.front().fail_found(
        "speeds or accelerations of unknown names: " + keys,
        "parameters of velocity_smoother, controller_server (RPP, MPPI, DWB, Graceful, TEB) or "
        "diff_drive_controller",
        "remove those that do not limit the drive, and write the others under a known name");
  }

  /// Of several controllers that drive, the one that the caller names is left.
  void choose_plugin(const Node& root) {
    const auto is_other = [&](const Driver& driver) { return driver.name != plugin_; };
    std::vector<std::string> names;
    for (const Driver& driver : drivers_)
      if (!driver.name.empty()) names.push_back(driver.name);
    const bool known = std::ranges::find(names, plugin_) != names.end();
    if (!plugin_.empty() && !known)
      root.fail_found("no controller " + plugin_ + " that drives",
                      names.empty() ? "a file with such a controller" : "one of " + text_of_list(names));
    if (known)
      std::erase_if(drivers_, [&](const Driver& d) { return !d.name.empty() && is_other(d); });
    else if (names.size() > 1)
      root.fail_found("several controllers that drive: " + text_of_list(names), "one",
                      "choose it with --plugin NAME, or leave it alone in controller_plugins");
  }

  /// Whether the file has nodes; those that do not drive are left out.
  bool read_nodes(const Node& node, const std::string& name) {
    if (node.kind() != Value::Kind::map) return false;
    if (const auto parameters = node.find("ros__parameters")) {
      if (parameters->kind() == Value::Kind::map) look(*parameters, roles_of(name, *parameters));
      return true;
    }
    bool found = false;
    for (const auto& [key, value] : node.entries()) found = read_nodes(value, key) || found;
    return found;
  }

  /// Reads the groups of a node's parameters; where it lists its controllers, those of the list.
  void look(const Node& node, const Roles& roles) {
    const auto listed = node.find("controller_plugins");
    const auto is_left_out = [&](const ParameterGroup& group) {
      return listed && !group.prefix.empty() &&
             !names_item(*listed, group.prefix.substr(0, group.prefix.find('.')));
    };
    const ParameterGroups groups(node);
    for (const ParameterGroup& group : groups.all()) {
      if (is_left_out(group)) continue;
      if (group.ends_with("linear.x")) read_axis(group, true);
      if (group.ends_with("angular.z")) read_axis(group, false);
      if (roles.plugins) read_plugin(group);
      if (roles.smoother) read_smoother(group);
    }
  }

  static bool names_item(const Node& list, const std::string& name) {
    return list.kind() != Value::Kind::list || std::ranges::any_of(list.items(), [&](const Node& item) {
             return item.kind() == Value::Kind::scalar && item.text() == name;
           });
  }

  static const PluginKind* kind_of(const ParameterGroup& group) {
    const auto type = group.find("plugin");
    if (!type || type->kind() != Value::Kind::scalar) return nullptr;
    const auto found = std::ranges::find_if(kPluginKinds, [&](const PluginKind& kind) {
      return type->text().find(kind.type) != std::string::npos;
    });
    return found != std::end(kPluginKinds) ? found : nullptr;
  }

  static std::vector<Node> unknown_in(const ParameterGroup& group) {
    std::vector<Node> unknown;
    for (const auto& [key, value] : group.values)
      if (is_unknown_motion(key, value)) unknown.push_back(value);
    return unknown;
  }

  void read_plugin(const ParameterGroup& group) {
    Driver driver{.name = group.prefix, .kind = kind_of(group)};
    for (const auto& [key, value] : group.values)
      if (const Parameter* row = row_of(kParameters, key);
          row != std::end(kParameters) && value.kind() == Value::Kind::scalar)
        take_least(driver.settings, row->field, row->sign, value);
    if (driver.settings.read.empty() && !group.find("plugin")) return;
    driver.unknown = unknown_in(group);
    if (!driver.settings.read.empty() || !driver.unknown.empty()) drivers_.push_back(std::move(driver));
  }

  void read_smoother(const ParameterGroup& group) {
    Driver driver;
    for (const auto& [key, value] : group.values) {
      const PlanarParameter* row = row_of(kTwists, key);
      if (row == std::end(kTwists)) continue;
      const std::vector<Node> items = value.kind() == Value::Kind::list ? value.items() : std::vector<Node>{};
      if (items.size() != 3 && items.size() != 6) value.fail("[x, y, theta] or [x, y, z, roll, pitch, yaw]");
      take_least(driver.settings, row->along, row->sign, items.front());
      take_least(driver.settings, row->about, row->sign, items.back());
    }
    if (driver.settings.read.empty()) return;
    driver.unknown = unknown_in(group);
    drivers_.push_back(std::move(driver));
  }

  void read_axis(const ParameterGroup& axis, bool along) {
    Driver driver;
    for (const AxisParameter& row : kAxes) {
      const auto flag = axis.find(row.flag);
      const auto value = axis.find(row.parameter.key);
      if (value && !(flag && !flag->boolean()))
        take_least(driver.settings, along ? row.parameter.along : row.parameter.about, row.parameter.sign,
                   *value);
    }
    if (!driver.settings.read.empty()) drivers_.push_back(std::move(driver));
  }

  /// Zero and `.nan` are no limit.
  static void take_least(ControllerFile& settings, Field field, Sign sign, const Node& value) {
    if (value.kind() == Value::Kind::scalar && is_nan(value.text())) return;
    if (field == nullptr) return;
    if (sign == Sign::reverse && value.number() >= 0) {
      settings.*field = 0.0;  // one source that drives forward alone is enough
      return;
    }
    const bool down = sign == Sign::negative || sign == Sign::reverse;
    const double size = sign == Sign::either ? std::abs(value.number())
                        : down               ? -value.number()
                                             : value.number();
    if (size == 0) return;
    if (!(size >= kLeastSize && size <= kMostSize))
      value.fail(down ? "from -100 to -0.001 (SI units; decelerations are negative), or 0: no limit"
                      : "from 0.001 to 100 (SI units), or 0: no limit");
    std::optional<double>& known = settings.*field;
    known = std::min(known.value_or(size), size);
    settings.read.push_back(value.path());
    settings.lines.push_back(value.mark().line);
    settings.sizes.emplace_back(field, size);
  }

  static bool is_nan(const std::string& text) {
    return text == ".nan" || text == ".NaN" || text == ".NAN" || text == "nan";
  }

  static void merge(const ControllerFile& from, ControllerFile& into) {
    for (const Field field :
         {&ControllerFile::speed_m_s, &ControllerFile::acceleration_m_s2, &ControllerFile::deceleration_m_s2,
          &ControllerFile::reverse_speed_m_s, &ControllerFile::yaw_rate_rad_s,
          &ControllerFile::turn_rate_rad_s, &ControllerFile::yaw_acceleration_rad_s2,
          &ControllerFile::yaw_deceleration_rad_s2, &ControllerFile::turn_acceleration_rad_s2})
      if (const std::optional<double>& value = from.*field)
        into.*field = std::min((into.*field).value_or(*value), *value);
    into.read.insert(into.read.end(), from.read.begin(), from.read.end());
    into.lines.insert(into.lines.end(), from.lines.begin(), from.lines.end());
    into.sizes.insert(into.sizes.end(), from.sizes.begin(), from.sizes.end());
  }

  std::string plugin_{};  ///< empty: the file has one that drives
  std::vector<Driver> drivers_{};
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

ControllerFile read_controller_settings(const std::string& file, const std::string& plugin) {
  const Document document = Document::load(file);
  const std::string kind = inferred_kind(document.root());
  if (kind == "controller") return {.file = file, .legs = legs_of(document)};
  ControllerFile settings = ControllerReader(plugin).read(document.root());
  if (settings.read.empty())
    document.root().fail_found(
        (kind.empty() ? "" : "a file of kind " + kind + " with ") +
            std::string("no speed and no acceleration of a controller"),
        "parameters of velocity_smoother, controller_server (RPP, MPPI, DWB, Graceful, "
        "TEB) or diff_drive_controller, or the result of export --to controller");
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
