#pragma once

#include <optional>

#include "benchmarks/problems/generator.hpp"

namespace joulepath::problems {

/// A problem of a campaign, with features that the public set lacks: any time goal, a jerk limit, ends at
/// speed, an effect of the floor or the machine.
struct CampaignProblem {
  Problem problem;
  std::string effect{};  ///< empty: none
  bool moving_ends{};
};

/// Problem `index` of a campaign; it depends on the arguments only. One in eight has a jerk limit, one in ten
/// an effect, one in eight begins and ends at speed. The time is free, bounded, fixed, priced, or the least.
/// Absent where there is no fastest drive.
[[nodiscard]] std::optional<CampaignProblem> campaign_problem(const std::vector<Robot>& robots, unsigned seed,
                                                              unsigned index);

}  // namespace joulepath::problems
