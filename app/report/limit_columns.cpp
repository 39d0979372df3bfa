#include <algorithm>
#include <cmath>

#include "app/report/columns.hpp"
#include "planner/motion/limits_for_payload.hpp"

namespace joulepath::report {

Columns limit_columns(const Robot& robot, const Columns& columns) {
  if (!robot.limits || !columns.contains("time_s")) return {};
  const std::size_t rows = columns.at("time_s").size();
  const auto payload = columns.find("payload_kg");
  Columns limits;
  const auto add = [&](const std::string& name, double Limits::*key, double sign) {
    std::vector<double> values(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      const double payload_kg = payload == columns.end() ? 0.0 : payload->second[row];
      values[row] = sign * (limits_for_payload(robot, payload_kg).*key);
    }
    if (std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
      limits[name] = values;
  };
  add("limit_speed_m_s", &Limits::speed_m_s, 1.0);
  add("limit_acceleration_m_s2", &Limits::acceleration_m_s2, 1.0);
  add("limit_deceleration_m_s2", &Limits::deceleration_m_s2, -1.0);
  return limits;
}

}  // namespace joulepath::report
