#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// diagnosis.json of a diagnosis against a simulator, with the logs that it compared and hashes of their
/// content (`simulator.logs`).
[[nodiscard]] std::string with_compared_logs(const std::string& diagnosis_json, const Dataset& dataset);

/// The text of after.json, and its sentence.
struct ChangedSimulator {
  std::string json{}, sentence{};
};

/// How far the gap of a changed simulator shrank, whose logs stand in `directory` under the names of the
/// first ones. `first`: diagnosis.json of the same dataset; nothing is fitted again. Throws ConfigError where
/// that was no diagnosis against a simulator, or where runs, logs or first predictions are not those that it
/// saw.
[[nodiscard]] ChangedSimulator changed_simulator(const Dataset& dataset, const std::string& first,
                                                 const std::string& directory,
                                                 const ReadOptions& options = {});

}  // namespace joulepath
