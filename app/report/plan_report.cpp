#include "app/report/plan_report.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

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

/// At most about 1500 of the times, for bands.
std::vector<double> evenly(const std::vector<double>& times_s) {
  std::vector<double> chosen;
  const std::size_t stride = 1 + times_s.size() / 1500;
  for (std::size_t k = 0; k < times_s.size(); k += stride) chosen.push_back(times_s[k]);
  if (chosen.back() < times_s.back()) chosen.push_back(times_s.back());
  return chosen;
}

std::string file_name(const std::string& file) { return std::filesystem::path(file).filename().string(); }

template <class Extras>
Extras named_extras(const MissionRequest& mission, const MissionWorld& world) {
  Extras extras;
  extras.title = mission.name;
  extras.subtitle = world.robot.name + (mission.map_file.empty() ? "" : " · " + file_name(mission.map_file));
  if (world.map) extras.map = map_picture(*world.map, world.keepout ? &*world.keepout : nullptr);
  return extras;
}

/// The start and the stations that a mission goes to.
std::vector<MapPlace> stations_of(const MissionRequest& mission) {
  std::vector<MapPlace> places{{"start", mission.start.pose.x_m, mission.start.pose.y_m}};
  const auto goes_to = [&](const std::string& name) {
    return std::ranges::count(mission.legs, name, &LegRequest::to) +
               std::ranges::count(mission.visit, name, &VisitRequest::station) >
           0;
  };
  for (const auto& [name, station] : mission.stations)
    if (goes_to(name)) places.push_back({name, station.x_m, station.y_m});
  return places;
}

}  // namespace

MissionExtras mission_extras(const Plan& plan, const MissionRequest& mission, const MissionWorld& world) {
  auto extras = named_extras<MissionExtras>(mission, world);
  Columns columns = columns_of(plan_trajectory(plan, make_plant(world.robot)));
  for (const char* name : {"time_s", "position_x_m", "position_y_m", "heading_rad", "linear_speed_m_s",
                           "angular_speed_rad_s", "leg"})
    if (auto column = columns.extract(name)) extras.way.insert(std::move(column));
  for (const LegPlan& leg : plan.legs) extras.goals.push_back(leg.to);
  return extras;
}

std::string plan_report(const Plan& plan, const std::string& plan_json, const Trajectory& trajectory,
                        const MissionRequest& mission, const MissionWorld& world,
                        const Operation& operation) {
  auto extras = named_extras<PlanExtras>(mission, world);
  extras.operation = operation;
  extras.limits = world.robot.limits;
  if (trajectory.size() == 0) extras.stations = stations_of(mission);
  Columns columns = columns_of(trajectory);
  if (!columns.empty()) {
    columns.merge(limit_columns(world.robot, columns));
    extras.bands = plan_bands(plan, make_plant(world.robot), evenly(trajectory.time_s));
    extras.savings = savings_of(plan);
    extras.overlays = baseline_motions(plan, make_plant(world.robot));
  }
  return plan_report_html(nlohmann::json::parse(plan_json), columns, extras);
}

}  // namespace joulepath::report
