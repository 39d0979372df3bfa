#pragma once

#include <optional>

#include "benchmarks/problems/generator.hpp"

namespace joulepath::problems {

/// A problem of a campaign, with what the public set has not: any goal of time, a jerk limit, ends at speed,
/// an effect of the floor or the machine.
struct CampaignProblem {
  Problem problem;
  std::string effect{};  ///< empty: none
  bool moving_ends{};
};

/// Problem `index` of a campaign: a function of its arguments alone. One in eight has a jerk limit, one in
/// ten an effect, one in eight begins and ends at speed. Time is free, at most, exactly given, at a price, or
/// the least. Absent where there is no fastest drive.
[[nodiscard]] std::optional<CampaignProblem> campaign_problem(const std::vector<Robot>& robots, unsigned seed,
                                                              unsigned index);

}  // namespace joulepath::problems
