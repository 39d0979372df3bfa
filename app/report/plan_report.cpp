#include "app/report/plan_report.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/report/report.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/motion/motion_energy.hpp"

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

/// What the plan saves against every baseline that keeps its times.
std::vector<Saving> savings_of(const Plan& plan) {
  std::vector<Saving> list;
  for (std::size_t index = 0; index < plan.baselines.size(); ++index) {
    const auto other = driven_by(plan, index);
    if (!other) continue;
    Saving saving{plan.baselines[index].name, 0.0, {}};
    const auto add = [&](const StretchPlan& stretch, const Profile& profile, double sign) {
      const EnergyByCause energy = energy_by_cause(path_motion(stretch.request), profile);
      saving.saved_J += sign * energy.total_J();
      for (const auto& [name, joules] : named_causes_J(energy)) saving.by_cause_J[name] += sign * joules;
    };
    for (std::size_t leg = 0; leg < plan.legs.size(); ++leg)
      for (std::size_t k = 0; k < plan.legs[leg].stretches.size(); ++k) {
        add(other->legs[leg].stretches[k], other->legs[leg].stretches[k].profile, 1.0);
        add(plan.legs[leg].stretches[k], plan.legs[leg].stretches[k].profile, -1.0);
      }
    list.push_back(std::move(saving));
  }
  return list;
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
    extras.savings = savings_of(plan);
    extras.overlays = baseline_motions(plan, make_plant(world.robot));
  }
  return plan_report_html(nlohmann::json::parse(plan_json), columns, extras);
}

}  // namespace joulepath::report
