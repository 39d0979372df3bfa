#include "app/report/plan_report.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/report/report.hpp"
#include "planner/accounts/plan_trajectory.hpp"

namespace joulepath::report {
namespace {

/// The plan with every stretch driven by its baseline number `index`; absent where one of them does not keep
/// the plan's time, or where baselines were not requested.
std::optional<Plan> driven_by(const Plan& plan, std::size_t index) {
  constexpr double kSameTime = 1e-9;
  Plan other = plan;
  for (LegPlan& leg : other.legs)
    for (StretchPlan& stretch : leg.stretches) {
      if (index >= stretch.baselines.size()) return std::nullopt;
      const BaselineResult& baseline = stretch.baselines[index];
      if (!baseline.feasible || !baseline.profile ||
          baseline.duration_s > stretch.profile.duration_s() * (1 + kSameTime))
        return std::nullopt;
      stretch.profile = *baseline.profile;
    }
  return other;
}

std::vector<NamedColumns> baseline_motions(const Plan& plan, const Plant& plant) {
  constexpr double kRate_Hz = 20.0;
  std::vector<NamedColumns> motions;
  for (std::size_t index = 0; index < plan.baselines.size(); ++index)
    if (const auto other = driven_by(plan, index))
      motions.push_back({plan.baselines[index].name, columns_of(plan_trajectory(*other, plant, kRate_Hz))});
  return motions;
}

std::string file_name(const std::string& file) { return std::filesystem::path(file).filename().string(); }

}  // namespace

std::string plan_report(const Plan& plan, const std::string& plan_json, const Trajectory& trajectory,
                        const MissionRequest& mission, const MissionWorld& world) {
  PlanExtras extras;
  extras.title = mission.name;
  extras.subtitle = world.robot.name + (mission.map_file.empty() ? "" : " · " + file_name(mission.map_file));
  if (world.map) extras.map = map_picture(*world.map, world.keepout ? &*world.keepout : nullptr);
  extras.limits = world.robot.limits;
  Columns columns = columns_of(trajectory);
  if (!columns.empty()) {
    columns.merge(limit_columns(world.robot, columns));
    extras.overlays = baseline_motions(plan, make_plant(world.robot));
  }
  return plan_report_html(nlohmann::json::parse(plan_json), columns, extras);
}

}  // namespace joulepath::report
