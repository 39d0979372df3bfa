#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "diagnosis/where/gap_after.hpp"

namespace joulepath {

/// What a first diagnosis forecast for the simulator once its causes are added.
struct Forecast {
  std::vector<std::string> causes{};    ///< by name
  std::vector<std::string> held_out{};  ///< runs that judge
  std::string method{};                 ///< of the validation
  double noise_floor_percent{}, battery_floor_percent{};
  double shrink_fraction{};
  Range95 shrink_interval_95{};
};

/// The `gap` of a diagnosis.
[[nodiscard]] nlohmann::ordered_json gap_json(const GapReport& gap);

/// How far a changed simulator's gap shrank on the runs that judge, beside the forecast.
[[nodiscard]] std::string after_sentence(const GapAfter& after, const Forecast& forecast);

/// The text of `after.json`.
[[nodiscard]] std::string gap_after_json(const GapAfter& after, const Forecast& forecast);

}  // namespace joulepath
