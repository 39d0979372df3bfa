#include <algorithm>
#include <cmath>

#include "app/report/columns.hpp"
#include "model/limit_table.hpp"

namespace joulepath::report {

Columns limit_columns(const Robot& robot, const Columns& columns) {
  if (!robot.limits || !columns.contains("time_s")) return {};
  const std::size_t rows = columns.at("time_s").size();
  const auto payload = columns.find("payload_kg");
  Columns limits;
  for (const std::string_view name : {"speed", "acceleration", "deceleration"}) {
    const Limit& limit = *limit_named(name);
    const double sign = name == "deceleration" ? -1.0 : 1.0;
    std::vector<double> values(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      const double payload_kg = payload == columns.end() ? 0.0 : payload->second[row];
      values[row] = sign * limits_for_payload(robot, payload_kg).*limit.field;
    }
    if (std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
      limits["limit_" + std::string(limit.key)] = values;
  }
  return limits;
}

}  // namespace joulepath::report
