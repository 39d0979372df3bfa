#include "scenarios/controller_settings.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "scenarios/document.hpp"
#include "scenarios/output_schemas.hpp"

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

class ControllerReader {
 public:
  ControllerFile take() { return std::move(settings_); }

  void look(const Node& node) {
    if (node.kind() != Value::Kind::map) return;
    for (const auto& [key, value] : node.entries()) {
      if (value.kind() == Value::Kind::scalar) read_number(key, value);
      if (value.kind() == Value::Kind::list) read_triple(key, value);
      if (key == "linear" || key == "angular") read_axis(value, key == "linear");
      look(value);
    }
  }

 private:
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

  void read_number(const std::string& key, const Node& value) {
    for (const Parameter& parameter : kParameters)
      if (key == parameter.key) take_least(parameter.field, parameter.sign, value);
  }

  void read_triple(const std::string& key, const Node& value) {
    for (const PlanarParameter& triple : kTriples) {
      if (key != triple.key) continue;
      const std::vector<Node> items = value.items();
      if (items.size() != 3) value.fail("[x, y, theta]");
      take_least(triple.along, triple.sign, items[0]);
      take_least(triple.about, triple.sign, items[2]);
    }
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
  const std::string kind = told_kind(document.root());
  if (kind == "controller") return {.file = file, .legs = legs_of(document)};
  ControllerReader reader;
  reader.look(document.root());
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
