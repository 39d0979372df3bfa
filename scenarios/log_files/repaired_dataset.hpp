#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/dataset.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// Sets `repair` of every check: the line of the dataset's file that corrects the channel, in addition to the
/// existing mapping. Throws ConfigError where the file can no longer be read.
void describe_repairs(const Dataset& dataset, std::vector<DataCheck>& checks);

/// The same for a dataset that was read from `document`.
void describe_repairs(const Dataset& dataset, const Document& document, std::vector<DataCheck>& checks);

/// A check as a sentence.
[[nodiscard]] std::string data_check_text(const DataCheck& check);

/// The dataset's file with all repairs, file names relative to `directory`.
[[nodiscard]] std::string repaired_dataset_text(const Dataset& dataset, const std::vector<DataCheck>& checks,
                                                const std::string& directory);

}  // namespace joulepath
