#pragma once

#include <map>
#include <set>
#include <string>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/log_files/log_columns.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// Changes to a dataset's file that is written again.
struct DatasetEdit {
  std::string comment{};  ///< after the schema line
  ColumnSources columns{};
  std::map<std::size_t, ColumnSources> run_columns{};  ///< by the index of the file's entry under `runs:`
  std::set<std::size_t> left_out{};                    ///< entries
};

/// The file of a dataset; of a log alone, a dataset that names it. Throws ConfigError.
[[nodiscard]] Document document_of(const Dataset& dataset);

/// A `columns:` map in YAML's flow style, with exact numbers.
[[nodiscard]] std::string columns_text(const ColumnSources& sources);

/// The dataset's file after an edit, with file names relative to `directory`, the target folder. Throws
/// ConfigError where the file can no longer be read.
[[nodiscard]] std::string dataset_text(const Dataset& dataset, const DatasetEdit& edit,
                                       const std::string& directory);

}  // namespace joulepath
