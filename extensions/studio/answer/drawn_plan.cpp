#include "extensions/studio/answer/drawn_plan.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "model/limit_table.hpp"
#include "planner/accounts/plan_bands.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/legs/leg_motion.hpp"
#include "planner/motion/limit_check.hpp"
#include "planner/values/leg_state.hpp"

namespace joulepath::studio {
namespace {

using nlohmann::json;
constexpr double kBinds = 0.995;  ///< share of a limit from which it counts as binding; an optimum at the
                                  ///< limit uses this much between nodes
constexpr double kJust_s = 1e-6;  ///< beside a step of what is drawn
constexpr std::size_t kLeastSamples = 6;  ///< per stretch

struct TightestLimit {
  int index{-1};
  double use{};
};

int index_of(std::string_view name) {
  for (std::size_t k = 0; k < kLimits.size(); ++k)
    if (kLimits[k].name == name) return static_cast<int>(k);
  return -1;
}

/// The limit with the highest use on a stretch at an instant. None at rest.
TightestLimit tightest(const StretchPlan& stretch, const PathMotion& motion, double elapsed_s) {
  const Profile& profile = stretch.profile;
  if (profile.time_s.empty() || elapsed_s > profile.time_s.back()) return {};
  const ProfileState state = profile.at_time(elapsed_s);
  const auto after = std::upper_bound(profile.time_s.begin(), profile.time_s.end(), elapsed_s);
  const auto segment = std::clamp<std::ptrdiff_t>(after - profile.time_s.begin() - 1, 0,
                                                  static_cast<std::ptrdiff_t>(profile.jerk.size()) - 1);
  TightestLimit most;
  for_each_limit_use(motion, stretch.request.limits, stretch.request.speed_caps, state,
                     profile.jerk[static_cast<std::size_t>(segment)], [&](std::string_view name, double use) {
                       if (use <= most.use) return;
                       most.use = use;
                       most.index = index_of(name);
                     });
  if (most.use < kBinds) most.index = -1;
  return most;
}

TightestLimit tightest(const LegPlan& leg, const LegMotion& motion, double elapsed_s) {
  for (std::size_t k = 0; k < leg.stretches.size(); ++k) {
    const double duration_s = leg.stretches[k].profile.duration_s();
    if (elapsed_s < duration_s) return tightest(leg.stretches[k], motion.stretch(k), elapsed_s);
    elapsed_s -= duration_s;
  }
  return {};
}

/// A rest from one instant to another: nothing binds there, and the next motion begins with a step.
void add_rest(std::vector<double>& times_s, double from_s, double to_s) {
  for (double time_s : {from_s, from_s + kJust_s, to_s - kJust_s, to_s}) times_s.push_back(time_s);
}

void add_evenly(std::vector<double>& times_s, double from_s, double to_s, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k)
    times_s.push_back(from_s + (to_s - from_s) * static_cast<double>(k) / static_cast<double>(count));
}

}  // namespace

std::vector<double> drawn_times_s(const Plan& plan, std::size_t count) {
  std::vector<double> times_s;
  const double step_s = plan.duration_s / static_cast<double>(std::max<std::size_t>(count, 1));
  const auto samples = [&](double duration_s) {
    return std::max(kLeastSamples, static_cast<std::size_t>(duration_s / step_s));
  };
  for (const LegPlan& leg : plan.legs) {
    double time_s = leg.start_s;
    for (const StretchPlan& stretch : leg.stretches) {
      const double duration_s = stretch.profile.duration_s();
      if (duration_s <= 0) continue;
      add_evenly(times_s, time_s, time_s + duration_s, samples(duration_s));
      time_s += duration_s;
      if (stretch.profile.wait_s > 0) add_rest(times_s, time_s - stretch.profile.wait_s, time_s);
    }
    if (leg.prescribed)
      add_evenly(times_s, leg.start_s, leg.start_s + leg.duration_s, samples(leg.duration_s));
    const double end_s = leg.start_s + leg.duration_s;
    times_s.push_back(end_s);
    if (leg.dwell_s <= 0) continue;
    add_rest(times_s, end_s, end_s + leg.dwell_s);
  }
  std::sort(times_s.begin(), times_s.end());
  const auto same = [](double a_s, double b_s) { return b_s - a_s < 1e-9; };
  times_s.erase(std::unique(times_s.begin(), times_s.end(), same), times_s.end());
  return times_s;
}

json drawn_motion(const Plan& plan, const Plant& plant, const std::vector<double>& times_s) {
  const Trajectory t = plan_trajectory_at(plan, plant, times_s);
  json limit = json::array(), use = json::array();
  std::vector<Plant> plants;
  std::vector<LegMotion> motions;
  for (const LegPlan& leg : plan.legs) plants.push_back(plant_in(plant, leg.state));
  for (std::size_t k = 0; k < plants.size(); ++k) motions.emplace_back(plan.legs[k], plants[k]);
  for (std::size_t row = 0; row < t.size(); ++row) {
    const auto leg = static_cast<std::size_t>(t.leg[row]);
    const TightestLimit tight =
        tightest(plan.legs[leg], motions[leg], t.time_s[row] - plan.legs[leg].start_s);
    limit.push_back(tight.index);
    use.push_back(std::isfinite(tight.use) ? json(tight.use) : json(nullptr));
  }
  return {{"time_s", t.time_s},
          {"position_x_m", t.position_x_m},
          {"position_y_m", t.position_y_m},
          {"heading_rad", t.heading_rad},
          {"arc_length_m", t.arc_length_m},
          {"linear_speed_m_s", t.linear_speed_m_s},
          {"angular_speed_rad_s", t.angular_speed_rad_s},
          {"linear_acceleration_m_s2", t.linear_acceleration_m_s2},
          {"battery_power_W", t.battery_power_W},
          {"wheel_torque_left_Nm", t.wheel_torque_Nm.left},
          {"wheel_torque_right_Nm", t.wheel_torque_Nm.right},
          {"energy_J", t.energy_J},
          {"payload_kg", t.payload_kg},
          {"leg", t.leg},
          {"limit", std::move(limit)},
          {"limit_use", std::move(use)}};
}

json drawn_bands(const Plan& plan, const Plant& plant, const std::vector<double>& times_s) {
  const PlanBands bands = plan_bands(plan, plant, times_s);
  json drawn = json::object();
  const auto add = [&](const char* column, const std::optional<PlanBand>& band) {
    if (!band) return;
    auto [low, high] = ends_95(*band);
    drawn[column] = {{"time_s", band->time_s}, {"low", std::move(low)}, {"high", std::move(high)}};
  };
  add("battery_power_W", bands.battery_power_W);
  add("energy_J", bands.energy_J);
  return drawn;
}

json limit_names() {
  json names = json::array();
  for (const Limit& limit : kLimits) names.push_back(limit.name);
  return names;
}

Path path_of(const LegPlan& leg) {
  Path path;
  for (const StretchPlan& stretch : leg.stretches) path.pieces.push_back(stretch.request.piece);
  return path;
}

}  // namespace joulepath::studio
