#include "scenarios/robot_files/physical_bounds.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
// Design: docs/decisions/0600-input-files.md

namespace joulepath {
namespace {

/// The accepted sizes of a number whose key ends like this; 0 is accepted if the key's own range accepts it.
struct Bounds {
  std::string_view ending{};
  double least{};
  double most{};
  const char* why{};
};

constexpr double kFullTurn_rad = 6.2832;
constexpr const char* kShaft = "seen at the motor's shaft, in SI units";

/// The first matching row applies: names before units, longer units before shorter ones.
constexpr Bounds kBounds[] = {
    {"wheel_radius_m", 1e-3, 5, "a radius in meters"},
    {"radius_m", 1e-3, kFarthest_m, "a radius in meters"},
    {"distance_m", 1e-3, kFarthest_m, "a length in meters"},
    {"to_m", 1e-3, kFarthest_m, "meters along the leg"},
    {"angle_rad", 1e-6, 1e4, "an angle in radians"},
    {"half_track_m", 1e-3, 10, "half of the track in meters"},
    {"heading_rad", 0, kFullTurn_rad, "a heading is within one turn; is it in degrees?"},
    {"chassis_mass_kg", 1e-3, 1e5, "a mass in kilograms"},
    {"capacity_Wh", 1e-3, 1e8, "watt hours"},
    {"start_time_s", 0, 1e12, "seconds"},
    {"from_s", 0, 1e12, "seconds on the clock of the log"},
    {"gear_ratio", 1e-3, 1e5, "motor turns per wheel turn"},
    {"traction_coefficient", 1e-3, 10, "a friction coefficient of wheels"},
    {"resolution", 1e-3, 100, "meters per pixel"},
    {"origin", 0, kFarthest_m, "meters and radians"},
    {"payload_by_action", 0, 1e5, "kilograms"},
    {"torque_constant_Nm_A", 1e-6, 1e3, kShaft},
    {"voltage_constant_V_s_rad", 1e-6, 1e3, kShaft},
    {"_Nm_s_rad", 0, 1e4, "newton meters per radian per second"},
    {"_inertia_m2", 0, 1e4, "a yaw inertia per kilogram"},
    {"_kg_m2", 0, 1e6, "kilogram square meters"},
    {"_m_s3", 1e-3, 1e6, "meters per cubic second"},
    {"_m_s2", 1e-4, 1e4, "meters per square second"},
    {"_rad_s2", 1e-4, 1e6, "radians per square second"},
    {"_rad_s", 1e-4, 1e4, "radians per second"},
    {"_m_s", 1e-3, 100, "meters per second"},
    {"_Nm", 0, 1e5, "newton meters"},
    {"_Wh", 0, 1e8, "watt hours"},
    {"_ohm", 1e-6, 1e4, "ohms"},
    {"_kg", 0, 1e5, "kilograms"},
    {"_rad", 0, 1e4, "radians"},
    {"_m", 0, kFarthest_m, "meters; coordinates lose their accuracy farther from the origin"},
    {"_s", 0, 1e7, "seconds"},
    {"_V", 1e-3, 1e4, "volts"},
    {"_A", 1e-3, 1e4, "amperes"},
    {"_W", 0, 1e7, "watts"},
    {"_H", 0, 10, "henries"},
    {"_J", 0, 1e12, "joules"},
};

const Bounds* bounds_of(std::string_view key) {
  const auto* found = std::find_if(std::begin(kBounds), std::end(kBounds),
                                   [&](const Bounds& row) { return key.ends_with(row.ending); });
  return found == std::end(kBounds) ? nullptr : found;
}

void bind(Schema& schema, std::string_view key) {
  if (key == "effects" || key == "uncertainty") return;
  if (schema.kind == Schema::Kind::number)
    if (const Bounds* bounds = bounds_of(key)) {
      Range& range = schema.range;
      range.max = std::min(range.max, bounds->most);
      range.min = std::max(range.min, -bounds->most);
      if (range.above_min && range.min == 0.0 && bounds->least > 0.0) {
        range.min = bounds->least;
        range.above_min = false;
      }
      range.least_size = bounds->least;
      range.why = bounds->why;
    }
  for (Schema& part : schema.parts) bind(part, key);
  for (Schema::Key& below : schema.keys) {
    const bool side =
        below.name == "left" || below.name == "right" || below.name == "from" || below.name == "to";
    bind(below.schema, side ? key : std::string_view(below.name));
  }
}

}  // namespace

Schema with_physical_bounds(Schema schema) {
  bind(schema, "");
  return schema;
}

double greatest_size(std::string_view key) {
  const Bounds* bounds = bounds_of(key);
  return bounds ? bounds->most : std::numeric_limits<double>::infinity();
}

}  // namespace joulepath
