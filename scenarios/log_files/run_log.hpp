#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"
#include "model/robot.hpp"
#include "scenarios/log_files/log_columns.hpp"
#include "scenarios/log_files/log_file.hpp"
#include "scenarios/text/csv_table.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// One run from its files: the present channels and their artifacts.
struct RunLog {
  Trajectory trajectory{};
  std::vector<LogArtifact> artifacts{};
  bool current_sign_from_motion{};
  bool wheels_from_body_speeds{};
  double clock_origin_s{};  ///< taken away from the times of an epoch clock
};

/// Reads one run from one or several files. Several files are resampled by linear interpolation at the times
/// of the first, or of the one with the motion where the first misses a part of it. The log lasts as long as
/// the motion is known; other channels are NaN outside of their file's own time. Missing speeds are derived
/// (wheels from body and back with `geometry`; body from pose). Throws ConfigError: no time, time that does
/// not increase (with the line), no motion at all, malformed cells. Usable but unusual data become artifacts.
[[nodiscard]] RunLog read_run_log(const std::vector<LogFileName>& files, const ColumnSources& sources,
                                  const Geometry& geometry, const std::string& run_name);

/// A log with the format's own column names, without the channels that a part of it lacks.
[[nodiscard]] RunLog read_run_log(const std::string& file, const Geometry& geometry);

/// The trajectory as CSV in the run log format: all present channels, then the extra ones, shortest exact
/// numbers.
[[nodiscard]] std::string run_log_text(const Trajectory& trajectory, const CsvColumns& extra = {});

}  // namespace joulepath
