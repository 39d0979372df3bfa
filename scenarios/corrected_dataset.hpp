#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// `dataset_corrected.yaml`: the dataset's file again, each reading mapped back through the instrument
/// effects that the diagnosis found (`columns:` composed with what the file already maps), names of files as
/// seen from `directory`, the one that it will be written to. Throws ConfigError where the file can no longer
/// be read.
[[nodiscard]] std::string corrected_dataset_text(const Dataset& dataset,
                                                 const std::vector<EffectSetting>& instruments,
                                                 const std::string& directory);

}  // namespace joulepath
