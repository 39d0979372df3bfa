#pragma once

#include <string>
#include <vector>

#include "model/trajectory.hpp"

namespace joulepath {

/// The file trajectory.csv in a plan's directory. Throws ConfigError for fewer than two rows, or where one of
/// the columns `needed` is absent.
[[nodiscard]] Trajectory read_planned_trajectory(const std::string& directory,
                                                 const std::vector<std::string>& needed);

}  // namespace joulepath
