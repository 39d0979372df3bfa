#include "planner/baselines/comparison.hpp"

#include <algorithm>

#include "planner/baselines/baseline.hpp"

namespace joulepath {
namespace {

void add(ComparedProfile& sum, BaselineResult result, double planned_s) {
  add_result(sum.total, result, planned_s);
  if (result.profile) sum.profiles.push_back(std::move(*result.profile));
}

}  // namespace

void add_result(BaselineTotal& total, const BaselineResult& result, double planned_s) {
  total.name = result.name;
  if (!result.feasible) {
    total.feasible = false;
    if (total.reason.empty()) total.reason = result.reason;
  }
  total.energy_J += result.energy_J;
  total.motion_energy_J += result.motion_energy_J;
  total.duration_s += result.duration_s;
  total.later_s += std::max(0.0, result.duration_s - planned_s);
  total.settings.push_back(result.parameters);
}

std::vector<ComparedProfile> compare_baselines(const std::vector<TimedStretch>& stretches) {
  std::vector<ComparedProfile> compared(stretches.empty() ? 0 : baselines().size());
  for (const auto& [request, duration_s] : stretches)
    for (std::size_t i = 0; i < compared.size(); ++i)
      add(compared[i], soonest(baselines()[i], *request, duration_s), duration_s);
  return compared;
}

std::vector<ComparedProfile> compare_baselines(const Plan& plan) {
  std::vector<TimedStretch> stretches;
  EnergyByCause driven;
  double driving_s = 0;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches) {
      stretches.push_back({&stretch.request, stretch.profile.duration_s()});
      driven += stretch.energy;
      driving_s += stretch.profile.duration_s();
    }
  std::vector<ComparedProfile> compared = compare_baselines(stretches);
  for (ComparedProfile& profile : compared) {
    profile.total.energy_J += plan.energy.total_J() - driven.total_J();
    profile.total.motion_energy_J += plan.energy.motion_J() - driven.motion_J();
    profile.total.duration_s += plan.duration_s - driving_s;
  }
  return compared;
}

}  // namespace joulepath
