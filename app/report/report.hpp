#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/report/columns.hpp"
#include "app/report/map_picture.hpp"
#include "app/report/page_text.hpp"
#include "planner/accounts/plan_bands.hpp"

namespace joulepath::report {

struct NamedColumns {
  std::string name{};
  Columns columns{};
};

/// What a plan saves against a baseline and by which causes.
struct Saving {
  std::string name{};
  double saved_J{};
  std::map<std::string, double> by_cause_J{};  ///< the baseline's less the plan's
};

/// What the pages of one mission share; each part may be absent.
struct MissionExtras {
  std::string title{};     ///< the mission's name
  std::string subtitle{};  ///< robot, map
  std::optional<MapPicture> map{};
  Columns way{};                     ///< poses and speeds of the plan
  std::vector<std::string> goals{};  ///< of the legs
};

/// What the operator pays for energy: kWh and their price a year instead of missions per charge.
struct Operation {
  std::optional<double> missions_per_day{}, price_per_kWh{};
};

/// A named place on the floor.
struct MapPlace {
  std::string name{};
  double x_m{}, y_m{};
};

/// Further content of a plan report besides plan.json and the trajectory; each part may be absent.
struct PlanExtras {
  std::string title{};     ///< the mission's name
  std::string subtitle{};  ///< robot, map
  std::optional<MapPicture> map{};
  std::optional<Limits> limits{};        ///< drawn if the trajectory has no limit_... columns
  std::vector<NamedColumns> overlays{};  ///< baselines' motions, by their names in plan.json
  std::vector<Saving> savings{};
  PlanBands bands{};
  Operation operation{};
  std::vector<MapPlace> stations{};  ///< drawn where there is no trajectory
};

/// One run of a diagnosis: `time_s`, and for each signal X that the run measured `measured_X`, `predicted_X`
/// and, after a correction, `corrected_X`.
struct RunComparison {
  std::string name{};
  std::string use{};  ///< diagnosis | validation
  Columns columns{};
};

struct DiagnosisExtras {
  std::string title{};
  std::string subtitle{};  ///< robot
  std::optional<MapPicture> map{};
  std::vector<RunComparison> runs{};
};

/// [{name, use, columns}] with at most `most_numbers` numbers altogether: long runs are thinned.
[[nodiscard]] nlohmann::json runs_json(const std::vector<RunComparison>& runs,
                                       std::size_t most_numbers = 200'000);

/// Each function returns one self-contained HTML file: data as JSON, style and scripts inside; without
/// JavaScript the data stand there as tables. The title names mission or data, robot, day and version; the
/// day is that of SOURCE_DATE_EPOCH where it is set. The same input gives the same bytes on the same day. An
/// infeasible plan has no trajectory: pass {}.
[[nodiscard]] std::string plan_report_html(const nlohmann::json& plan, const Columns& trajectory,
                                           const PlanExtras& extras = {});
[[nodiscard]] std::string diagnosis_report_html(const nlohmann::json& diagnosis,
                                                const DiagnosisExtras& extras = {});

/// `compare`: {"profiles": [{name, feasible, reason, energy_J, motion_energy_J, duration_s, parameters}]},
/// the plan first; `profiles`: their motions. A controller's settings instead of classic profiles: "loss",
/// the document of `compare --controller`.
[[nodiscard]] std::string compare_report_html(const nlohmann::json& compare,
                                              const std::vector<NamedColumns>& profiles,
                                              const MissionExtras& extras = {});

/// `front`: {"points": [{duration_s, energy_J, motion_energy_J, price_of_time_W, status}],
/// "baselines": [{name, feasible, duration_s, energy_J, motion_energy_J, later_s, optimum_J}]}.
[[nodiscard]] std::string front_report_html(const nlohmann::json& front, const MissionExtras& extras = {});

/// `batch`: {"missions": [{name, status, energy_J, duration_s, distance_m, saving_percent,
/// optimality_gap_percent, message}]}.
[[nodiscard]] std::string batch_report_html(const nlohmann::json& batch, const std::string& title = {});

/// The page of an extension's result: `data` holds `kind` and `title`. The module `starts` of `own` draws it.
[[nodiscard]] std::string page_html(const std::string& kind, const nlohmann::json& data,
                                    std::span<const Module> own, const std::string& starts);

}  // namespace joulepath::report
