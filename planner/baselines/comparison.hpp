#pragma once

#include <vector>

#include "planner/values/plan.hpp"

namespace joulepath {

/// One profile family over all stretches of a plan, at the plan's own times; dwell and prescribed motions
/// are the same for all and count in full.
struct ComparedProfile {
  BaselineTotal total{};
  std::vector<Profile> profiles{};  ///< per stretch, empty where one does not exist
};

/// Least energy of a stretch in a time; nothing if no profile is found that is as fast.
[[nodiscard]] std::optional<EnergyByCause> least_energy(const ProfileRequest& stretch, double duration_s);

/// A stretch, its driving time, and its energy in that time; absent: the least energy is computed.
struct TimedStretch {
  const ProfileRequest* request{};
  double duration_s{};
  std::optional<EnergyByCause> energy{};
};
[[nodiscard]] TimedStretch timed(const StretchPlan& stretch);

/// Adds the result of one stretch to a total. The energy in its own time stands beside it.
void add_result(BaselineTotal& total, const BaselineResult& result, const TimedStretch& planned);

/// Adds what is the same for every profile of a plan: dwell, prescribed motions.
void add_rest(BaselineTotal& total, double duration_s, double energy_J, double motion_energy_J);

/// Every baseline over some stretches, each stretch in its own time; later if none keeps that time.
[[nodiscard]] std::vector<ComparedProfile> compare_baselines(const std::vector<TimedStretch>& stretches);

/// Every baseline against a valid plan.
[[nodiscard]] std::vector<ComparedProfile> compare_baselines(const Plan& plan);

}  // namespace joulepath
