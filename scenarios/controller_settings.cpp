#include "scenarios/controller_settings.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/document.hpp"

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
    {"max_angular_accel", &ControllerFile::yaw_acceleration_rad_s2},
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

void lower(double& value, const std::optional<double>& to) {
  if (to) value = std::min(value, *to);
}

}  // namespace

ControllerFile read_controller_settings(const std::string& file) {
  const Document document = Document::load(file);
  ControllerReader reader;
  reader.look(document.root());
  ControllerFile settings = reader.take();
  if (settings.read.empty())
    document.root().fail_found(
        "no speed and no acceleration of a controller",
        "parameters of velocity_smoother, controller_server (RPP, MPPI, DWB) or diff_drive_controller");
  return settings;
}

ControlledDrive drive_with(const Plan& plan, const ControllerFile& file) {
  const auto settings = [&](const StretchPlace& place, const StretchPlan& stretch,
                            const TrapezoidFamily& family) {
    TrapezoidSettings own = fastest_settings(place, stretch, family);
    if (is_turn(stretch.request.piece)) {
      lower(own.rate, file.yaw_rate_rad_s);
      lower(own.rate, file.turn_rate_rad_s);
      lower(own.acceleration, file.yaw_acceleration_rad_s2);
      lower(own.deceleration,
            file.yaw_deceleration_rad_s2 ? file.yaw_deceleration_rad_s2 : file.yaw_acceleration_rad_s2);
    } else {
      lower(own.rate, file.speed_m_s);
      lower(own.acceleration, file.acceleration_m_s2);
      lower(own.deceleration, file.deceleration_m_s2 ? file.deceleration_m_s2 : file.acceleration_m_s2);
    }
    return own;
  };
  return drive_by_controller(plan, settings);
}

}  // namespace joulepath
