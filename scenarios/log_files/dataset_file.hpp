#pragma once

#include <map>
#include <string>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/text/csv_table.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {

[[nodiscard]] Schema dataset_schema();

/// Reads a dataset: its robot (or `robot_file`, if it is not empty) and every run. Throws ConfigError.
[[nodiscard]] Dataset read_dataset(const std::string& file, const ReadOptions& options = {},
                                   const std::string& robot_file = {});

/// Values in memory that replace files that a dataset names.
struct DatasetInMemory {
  const Robot* robot{};                           ///< null: its file is read
  const std::map<std::string, CsvTable>* logs{};  ///< by the file names in the runs
};

/// The dataset of a parsed document; `robot_file` as above. Throws ConfigError.
[[nodiscard]] Dataset dataset_from(const Document& document, const ReadOptions& options,
                                   const std::string& robot_file, const DatasetInMemory& memory = {});

/// Reads a dataset file, or a log alone (CSV, bag), which needs the robot's file. Throws ConfigError.
[[nodiscard]] Dataset read_dataset_or_log(const std::string& file, const ReadOptions& options,
                                          const std::string& robot_file);

/// A dataset of one log. Throws ConfigError.
[[nodiscard]] Dataset dataset_of_log(const std::string& log_file, const std::string& robot_file,
                                     const ReadOptions& options = {});

}  // namespace joulepath
