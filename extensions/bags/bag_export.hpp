#pragma once

#include "scenarios/export/exports.hpp"

namespace joulepath {

[[nodiscard]] Export export_bag(const ExportInput& input);  ///< MCAP: Path, Odometry, power

/// A run log as a bag (MCAP): Path, Odometry, and every column of the log as JSON. Its clock is that of the
/// log, so that the bag of a plan and that of its run lie on each other; one that begins below 0 begins at 0.
/// Throws ConfigError for times that no stamp holds.
[[nodiscard]] std::string log_bag(const Trajectory& log, const Geometry& geometry);

}  // namespace joulepath
