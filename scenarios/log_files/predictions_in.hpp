#pragma once

#include <string>

#include "diagnosis/values/dataset.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// The dataset with the predictions that stand in `directory` under the names of the files under
/// `predicted:`. Throws ConfigError where one is missing.
[[nodiscard]] Dataset with_predictions_in(Dataset dataset, const std::string& directory,
                                          const ReadOptions& options = {});

}  // namespace joulepath
