#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/report/columns.hpp"
#include "app/report/map_picture.hpp"

namespace joulepath::report {

struct NamedColumns {
  std::string name{};
  Columns columns{};
};

/// Further content of a plan report besides plan.json and the trajectory; each part may be absent.
struct PlanExtras {
  std::string title{};     ///< the mission's name
  std::string subtitle{};  ///< robot, map
  std::optional<MapPicture> map{};
  std::optional<Limits> limits{};        ///< drawn if the trajectory has no limit_... columns
  std::vector<NamedColumns> overlays{};  ///< baselines' motions, by their names in plan.json
};

/// One run of a diagnosis: motor power of both wheels together, W. `corrected_power_W` may be empty.
struct RunComparison {
  std::string name{};
  std::string use{};  ///< diagnosis | validation
  std::vector<double> time_s{};
  std::vector<double> measured_power_W{};
  std::vector<double> predicted_power_W{};
  std::vector<double> corrected_power_W{};
};

struct DiagnosisExtras {
  std::string title{};
  std::optional<MapPicture> map{};
  std::vector<RunComparison> runs{};
};

/// Each function returns one self-contained HTML file: data as JSON, style, scripts and the plotting library
/// inside. The same input gives the same bytes. An infeasible plan has no trajectory: pass {}.
[[nodiscard]] std::string plan_report_html(const nlohmann::json& plan, const Columns& trajectory,
                                           const PlanExtras& extras = {});
[[nodiscard]] std::string diagnosis_report_html(const nlohmann::json& diagnosis,
                                                const DiagnosisExtras& extras = {});

/// `compare`: {"profiles": [{name, feasible, reason, energy_J, motion_energy_J, duration_s, parameters}]},
/// the plan first; `profiles`: their motions.
[[nodiscard]] std::string compare_report_html(const nlohmann::json& compare,
                                              const std::vector<NamedColumns>& profiles,
                                              const std::string& title = {});

/// `front`: {"points": [{duration_s, energy_J, motion_energy_J, price_of_time_W, status}],
/// "baselines": [{name, feasible, duration_s, energy_J, motion_energy_J, later_s, optimum_J}]}.
[[nodiscard]] std::string front_report_html(const nlohmann::json& front,
                                            const std::vector<NamedColumns>& profiles,
                                            const std::string& title = {});

/// `batch`: {"missions": [{name, status, energy_J, duration_s, distance_m, saving_percent,
/// optimality_gap_percent, message}]}.
[[nodiscard]] std::string batch_report_html(const nlohmann::json& batch, const std::string& title = {});

/// The page of a sweep: sweep.json with `cloud`, a dot [duration_s, energy_J, within_constraints] per design.
[[nodiscard]] std::string sweep_report_html(const nlohmann::json& sweep, const std::string& title = {});

}  // namespace joulepath::report
