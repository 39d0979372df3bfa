#include "app/report/plan_report.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/report/report.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/baselines/baseline.hpp"

namespace joulepath::report {
namespace {

using BaselineMaker = BaselineResult (*)(const ProfileRequest&, double);

/// The plan with every stretch driven by a baseline instead; absent where one of them cannot drive it.
std::optional<Plan> driven_by(const Plan& plan, BaselineMaker make) {
  Plan other = plan;
  for (LegPlan& leg : other.legs) {
    for (StretchPlan& stretch : leg.stretches) {
      BaselineResult baseline = make(stretch.request, stretch.profile.duration_s());
      if (!baseline.feasible || !baseline.profile) return std::nullopt;
      stretch.profile = std::move(*baseline.profile);
    }
  }
  return other;
}

std::vector<NamedColumns> baseline_motions(const Plan& plan, const Plant& plant) {
  constexpr double kRate_Hz = 20.0;
  std::vector<NamedColumns> motions;
  const auto add = [&](const char* name, BaselineMaker make) {
    if (const auto other = driven_by(plan, make))
      motions.push_back({name, columns_of(plan_trajectory(*other, plant, kRate_Hz))});
  };
  add("trapezoid_max_acceleration", trapezoid_max_acceleration);
  add("trapezoid_best_tuned", trapezoid_best_tuned);
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
