#include "planner/baselines/comparison.hpp"

namespace joulepath {
namespace {

void add(ComparedProfile& sum, BaselineResult result) {
  BaselineTotal& total = sum.total;
  total.name = result.name;
  if (!result.feasible && total.feasible) {
    total.feasible = false;
    total.reason = result.reason;
  }
  total.energy_J += result.energy_J;
  total.motion_energy_J += result.motion_energy_J;
  total.duration_s += result.duration_s;
  total.settings.push_back(std::move(result.parameters));
  if (result.profile) sum.profiles.push_back(std::move(*result.profile));
}

}  // namespace

std::vector<ComparedProfile> compare_baselines(const Plan& plan) {
  std::vector<ComparedProfile> compared;
  EnergyByCause driven;
  double driving_s = 0;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches) {
      driven += stretch.energy;
      driving_s += stretch.profile.duration_s();
      std::vector<BaselineResult> results = all_baselines(stretch.request, stretch.profile.duration_s());
      compared.resize(results.size());
      for (std::size_t i = 0; i < results.size(); ++i) add(compared[i], std::move(results[i]));
    }
  for (ComparedProfile& profile : compared) {
    profile.total.energy_J += plan.energy.total_J() - driven.total_J();
    profile.total.motion_energy_J += plan.energy.motion_J() - driven.motion_J();
    profile.total.duration_s += plan.duration_s - driving_s;
  }
  return compared;
}

}  // namespace joulepath
