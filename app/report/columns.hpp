#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "model/robot.hpp"
#include "model/trajectory.hpp"

namespace joulepath::report {

/// Channels by the column names of a run log; all have the length of `time_s`.
using Columns = std::map<std::string, std::vector<double>>;

/// The channels that a trajectory has, under the names of trajectory.csv.
[[nodiscard]] Columns columns_of(const Trajectory& trajectory);

/// At most about `most_rows` rows, which limits the report's size. Each bucket of rows keeps its first row
/// and those with the extremes of speed, acceleration and power, so peaks keep their place and value.
[[nodiscard]] Columns thinned(const Columns& columns, std::size_t most_rows);

/// Columns limit_speed_m_s, limit_acceleration_m_s2 and limit_deceleration_m_s2 (negative) for the
/// payload of each row: the limits that the robot file gives, `by_payload` interpolated as for planning.
[[nodiscard]] Columns limit_columns(const Robot& robot, const Columns& columns);

}  // namespace joulepath::report
