#include "benchmarks/problems/campaign.hpp"

#include <cmath>

#include "planner/profile/profile_solver.hpp"

namespace joulepath::problems {
namespace {

constexpr unsigned kPrime = 1000003;
constexpr TimeMode kModes[] = {TimeMode::free_time,   TimeMode::free_time,  TimeMode::time_budget,
                               TimeMode::time_budget, TimeMode::fixed_time, TimeMode::time_price,
                               TimeMode::minimum_time};

const std::vector<EffectSetting>& effects() {
  static const std::vector<EffectSetting> all{
      {.name = "gear_efficiency", .parameters = {{"loss_fraction", 0.1}}},
      {.name = "driver_voltage_drop", .parameters = {{"voltage_V", 0.8}}},
      {.name = "stribeck_friction", .parameters = {{"torque_Nm", 0.3}, {"speed_rad_s", 2.0}}},
      {.name = "winding_heating", .parameters = {{"final_fraction", 0.3}, {"time_constant_s", 60}}}};
  return all;
}

/// Adds a time goal; false where there is no fastest drive.
bool set_time(ProfileRequest& request, Generator& random) {
  const double factor = random.uniform(1.02, 2), price_W = random.uniform(0.1, 20);
  const TimeMode mode = kModes[random.choice(std::size(kModes))];
  ProfileRequest draft = request;
  draft.limits.jerk_m_s3 = kNoLimit;
  const ProfileResult fastest = solve_profile(draft);
  if (!fastest.profile) return false;
  const double slower = std::isfinite(request.limits.jerk_m_s3) ? 1.3 : 1.0;
  request.time = {mode};
  if (mode == TimeMode::time_budget || mode == TimeMode::fixed_time)
    request.time.duration_s = factor * slower * fastest.profile->duration_s();
  if (mode == TimeMode::time_price) request.time.price_W = price_W;
  return true;
}

}  // namespace

std::optional<CampaignProblem> campaign_problem(const std::vector<Robot>& robots, unsigned seed,
                                                unsigned index) {
  Generator random(seed * kPrime + index, robots);
  CampaignProblem one{.problem = random.next(index, Part::paths)};
  ProfileRequest& request = one.problem.request;
  const bool jerk = random.choice(8) == 0, effect = random.choice(10) == 0, ends = random.choice(8) == 0;
  const double jerk_m_s3 = random.uniform(0.3, 2), from = random.uniform(0, 0.4), to = random.uniform(0, 0.4);
  if (jerk) request.limits.jerk_m_s3 = jerk_m_s3;
  if (effect) {
    const EffectSetting& setting = effects()[random.choice(effects().size())];
    one.effect = setting.name;
    request.plant = make_plant(request.plant.robot, {setting});
  }
  one.moving_ends = ends && !jerk && index % 4 < 2;
  if (one.moving_ends) {
    request.start_rate = from * request.limits.speed_m_s;
    request.end_rate = to * request.limits.speed_m_s;
  }
  if (!set_time(request, random)) return std::nullopt;
  return one;
}

}  // namespace joulepath::problems
