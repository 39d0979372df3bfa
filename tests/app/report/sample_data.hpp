#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/report/report.hpp"

/// Invented inputs for reports: an L-shaped way with a stop and a turn in place, driven with trapezoids.
namespace joulepath::report::sample {

[[nodiscard]] Columns trajectory(double sample_period_s = 0.02);
[[nodiscard]] nlohmann::json plan();
[[nodiscard]] PlanBands bands();
[[nodiscard]] nlohmann::json infeasible_plan();
[[nodiscard]] std::vector<MapPlace> stations();  ///< one of them off the map
[[nodiscard]] OccupancyGrid hall();
[[nodiscard]] nlohmann::json diagnosis();
[[nodiscard]] std::vector<RunComparison> runs();
[[nodiscard]] nlohmann::json compare();
[[nodiscard]] nlohmann::json loss();
[[nodiscard]] std::vector<NamedColumns> profiles();
[[nodiscard]] std::vector<NamedColumns> loss_motions();
[[nodiscard]] nlohmann::json front();
[[nodiscard]] nlohmann::json batch();

}  // namespace joulepath::report::sample
