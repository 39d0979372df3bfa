#include "planner/baselines/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "model/progress.hpp"
#include "planner/baselines/baseline.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/profile/profile_solver.hpp"

namespace joulepath {
namespace {

constexpr double kSameTime_s = 1e-9;

void add(ComparedProfile& sum, BaselineResult result, const TimedStretch& planned) {
  add_result(sum.total, result, planned);
  if (result.profile) sum.profiles.push_back(std::move(*result.profile));
}

}  // namespace

std::optional<EnergyByCause> least_energy(const ProfileRequest& stretch, double duration_s) {
  ProfileRequest request = stretch;
  request.time = {.mode = TimeMode::fixed_time, .duration_s = duration_s};
  request.solver = SolverChoice::fast;
  const ProfileResult result = solve_profile(request);
  if (!result.profile) return std::nullopt;
  return energy_by_cause(path_motion(request), *result.profile);
}

TimedStretch timed(const StretchPlan& stretch) {
  return {&stretch.request, stretch.profile.duration_s(), stretch.energy};
}

void add_result(BaselineTotal& total, const BaselineResult& result, const TimedStretch& planned) {
  total.name = result.name;
  total.settings.push_back(result.parameters);
  if (!result.feasible) {
    total.feasible = false;
    if (total.reason.empty()) total.reason = result.reason;
    return;
  }
  total.energy_J += result.energy_J;
  total.motion_energy_J += result.motion_energy_J;
  total.duration_s += result.duration_s;
  total.later_s += std::max(0.0, result.duration_s - planned.duration_s);
  const bool late = result.duration_s > planned.duration_s + kSameTime_s;
  const auto optimum =
      planned.energy && !late ? planned.energy : least_energy(*planned.request, result.duration_s);
  total.optimum_J += optimum ? optimum->total_J() : std::nan("");
  total.optimum_motion_J += optimum ? optimum->motion_J() : std::nan("");
}

void add_rest(BaselineTotal& total, double duration_s, double energy_J, double motion_energy_J) {
  total.duration_s += duration_s;
  total.energy_J += energy_J, total.optimum_J += energy_J;
  total.motion_energy_J += motion_energy_J, total.optimum_motion_J += motion_energy_J;
}

std::vector<ComparedProfile> compare_baselines(const std::vector<TimedStretch>& stretches) {
  std::vector<ComparedProfile> compared(stretches.empty() ? 0 : baselines().size());
  for (const TimedStretch& stretch : stretches)
    for (std::size_t i = 0; i < compared.size(); ++i) {
      add(compared[i], soonest(baselines()[i], *stretch.request, stretch.duration_s), stretch);
      finish_steps();
    }
  return compared;
}

std::vector<ComparedProfile> compare_baselines(const Plan& plan) {
  std::vector<TimedStretch> stretches;
  EnergyByCause driven;
  double driving_s = 0;
  for (const LegPlan& leg : plan.legs)
    for (const StretchPlan& stretch : leg.stretches) {
      stretches.push_back(timed(stretch));
      driven += stretch.energy;
      driving_s += stretch.profile.duration_s();
    }
  expect_steps(stretches.size() * baselines().size());
  std::vector<ComparedProfile> compared = compare_baselines(stretches);
  for (ComparedProfile& profile : compared)
    add_rest(profile.total, plan.duration_s - driving_s, plan.energy.total_J() - driven.total_J(),
             plan.energy.motion_J() - driven.motion_J());
  return compared;
}

}  // namespace joulepath
