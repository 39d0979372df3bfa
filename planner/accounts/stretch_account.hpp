#pragma once

#include <array>

#include "planner/cache/answer_cache.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// A plant and what becomes of it when the robot differs from its file by one uncertain constant.
struct UncertainPlant {
  Plant plant{};
  std::vector<std::array<Plant, 2>> shifted{};  ///< per entry of `uncertainty:`, one sigma more and one less
};
[[nodiscard]] UncertainPlant uncertain(Plant plant);

/// Fills in what a planned stretch takes: by independent replay, by cause, in the battery, and by how much an
/// uncertain constant changes it. `request` and `profile` are given.
void account_for(StretchPlan& stretch, const UncertainPlant& plant, const SharedAnswers& answers);

}  // namespace joulepath
