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

/// Adds the result of one stretch to a total.
void add_result(BaselineTotal& total, const BaselineResult& result, double planned_s);

/// A stretch and its driving time.
struct TimedStretch {
  const ProfileRequest* request{};
  double duration_s{};
};

/// Every baseline over some stretches, each stretch in its own time; later if none keeps that time.
[[nodiscard]] std::vector<ComparedProfile> compare_baselines(const std::vector<TimedStretch>& stretches);

/// Every baseline against a valid plan.
[[nodiscard]] std::vector<ComparedProfile> compare_baselines(const Plan& plan);

}  // namespace joulepath
