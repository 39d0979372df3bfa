#include "app/report/columns.hpp"

#include <algorithm>
#include <set>

#include "model/log_columns.hpp"

namespace joulepath::report {

Columns columns_of(const Trajectory& trajectory) {
  Columns columns;
  for (const LogColumn& column : log_columns())
    if (const std::vector<double>& values = column.of(trajectory); !values.empty())
      columns[column.name] = values;
  return columns;
}

Columns thinned(const Columns& columns, std::size_t most_rows) {
  const auto time = columns.find("time_s");
  const std::size_t rows = time == columns.end() ? 0 : time->second.size();
  if (rows <= most_rows || most_rows < 8) return columns;
  std::vector<const std::vector<double>*> watched;
  for (const char* name :
       {"linear_speed_m_s", "linear_acceleration_m_s2", "battery_power_W", "measured_motor_power_W"})
    if (const auto found = columns.find(name); found != columns.end()) watched.push_back(&found->second);
  const std::size_t kept_per_bucket = 1 + 2 * watched.size();
  const std::size_t bucket = (rows * kept_per_bucket + most_rows - 1) / most_rows;
  std::set<std::size_t> kept{rows - 1};
  for (std::size_t from = 0; from < rows; from += bucket) {
    const auto to = static_cast<std::ptrdiff_t>(std::min(rows, from + bucket));
    kept.insert(from);
    for (const auto* values : watched) {
      const auto begin = values->begin();
      const auto [low, high] = std::minmax_element(begin + static_cast<std::ptrdiff_t>(from), begin + to);
      kept.insert(static_cast<std::size_t>(low - begin));
      kept.insert(static_cast<std::size_t>(high - begin));
    }
  }
  Columns thin;
  for (const auto& [name, values] : columns) {
    auto& out = thin[name];
    for (const std::size_t row : kept) out.push_back(values[row]);
  }
  return thin;
}

}  // namespace joulepath::report
