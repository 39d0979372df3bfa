#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The text of `diagnosis.json`. Numbers have six significant digits.
[[nodiscard]] std::string diagnosis_json(const Diagnosis& diagnosis);

/// The `data_checks` of a diagnosis and of `check --json`.
[[nodiscard]] nlohmann::ordered_json data_checks_json(const std::vector<DataCheck>& checks);

/// The `isolability` of the same two.
[[nodiscard]] nlohmann::ordered_json isolability_json(const Isolability& isolability);

/// A mission of prescribed motions: the run that the diagnosis proposes.
[[nodiscard]] std::string experiment_mission_text(const NextExperiment& next, const std::string& robot_file);

}  // namespace joulepath
