#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/jobs/run_jobs.hpp"
#include "extensions/studies/study_file.hpp"

namespace joulepath {

/// A design over all its missions.
struct DesignTotal {
  std::size_t design{};
  std::vector<std::string> values{};     ///< one per parameter
  bool planned{};                        ///< every mission has a plan
  double excess{};                       ///< the largest relative violation of a constraint, on any mission
  std::vector<double> objectives{};      ///< in the study's order, each to be minimized
  std::map<std::string, double> sums{};  ///< results over the missions; battery_end_fraction: the least

  [[nodiscard]] bool is_within() const { return planned && excess <= 0.0; }
};

/// Sums the result lines of each design; lines are ordered by design.
[[nodiscard]] std::vector<DesignTotal> design_totals(const Study& study,
                                                     const std::vector<std::string>& lines);

/// The reason why a result line's design does not count: no plan, or a violated constraint with its value;
/// empty: it counts.
[[nodiscard]] std::string reason_of(const Study& study, const nlohmann::ordered_json& line);

/// sweep.csv: a row per design and mission.
[[nodiscard]] std::string sweep_csv(const Study& study, const std::vector<std::string>& lines);

/// sweep.json (joulepath/sweep/1): constant quantities, main effects and interactions of each result, Pareto
/// front, best design, and the number of failed designs per reason. `totals`: of the lines. `optimized`:
/// result lines of the design found by --optimize; empty: none.
[[nodiscard]] nlohmann::ordered_json sweep_json(const Study& study, const std::vector<std::string>& lines,
                                                const std::vector<DesignTotal>& totals,
                                                const std::vector<std::string>& optimized);

/// Notes for the reader on parameters that the study does not change.
[[nodiscard]] std::vector<std::string> held_constant(const Study& study);

}  // namespace joulepath
