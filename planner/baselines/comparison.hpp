#pragma once

#include <vector>

#include "planner/plan.hpp"

namespace joulepath {

/// One profile family over all stretches of a plan, at the plan's own times; dwell and prescribed motions
/// are the same for all and count in full.
struct ComparedProfile {
  BaselineTotal total{};
  std::vector<Profile> profiles{};  ///< per stretch, empty where one does not exist
};

/// Every baseline against a valid plan.
[[nodiscard]] std::vector<ComparedProfile> compare_baselines(const Plan& plan);

}  // namespace joulepath
