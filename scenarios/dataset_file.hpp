#pragma once

#include <optional>
#include <string>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema dataset_schema();

/// Reads a dataset: the robot that it names (or `robot_file`, which wins where it is not empty) and every
/// run. Throws ConfigError.
[[nodiscard]] Dataset read_dataset(const std::string& file, const ReadOptions& options = {},
                                   const std::string& robot_file = {});

/// A dataset of one log, for commands that take a bare CSV file.
[[nodiscard]] Dataset dataset_of_log(const std::string& log_file, const std::string& robot_file);

}  // namespace joulepath
