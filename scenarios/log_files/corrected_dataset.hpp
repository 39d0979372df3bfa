#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// `dataset_corrected.yaml`: the dataset's file with each reading corrected for the instrument effects that
/// the diagnosis found (`columns:` composed with the file's own mapping). File names are relative to
/// `directory`, the target folder. Throws ConfigError if the file can no longer be read.
[[nodiscard]] std::string corrected_dataset_text(const Dataset& dataset,
                                                 const std::vector<EffectSetting>& instruments,
                                                 const std::string& directory);

}  // namespace joulepath
