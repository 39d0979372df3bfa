#pragma once

#include <vector>

#include "planner/confidence/plan_demands.hpp"
#include "planner/legs/stretch.hpp"

namespace joulepath {

/// What a plan leaves of its limits and of its battery, so that drawn plants keep them.
struct Margins {
  std::array<double, kUsedLimits> share;  ///< of each of its limits that the plan may use, at most 1
  double reserve{};                       ///< state of charge above the battery's reserve
  Margins() { share.fill(1.0); }

  [[nodiscard]] LimitShares limit_shares() const;
};

/// The robot whose own limits leave margins: of the windings' rise, as a share, and of the reserve.
[[nodiscard]] Robot with_margins(Robot robot, const LimitShares& shares, double reserve);

/// Whether a demand keeps its limits, those of forces alone, and the reserve.
[[nodiscard]] bool keeps_limit(const PlanDemand& demand, std::size_t i);
[[nodiscard]] bool keeps_forces(const PlanDemand& demand);
[[nodiscard]] bool keeps_limits(const PlanDemand& demand);
[[nodiscard]] bool keeps_reserve(const PlanDemand& demand, double reserve_fraction);

/// The margins with which so many of the drawn demands are kept together: each promise has a margin of the
/// same quantile of its own demand, relative to the nominal one, and the quantile is the least with which
/// the joint share is reached, on these draws. A limit that the plan does not use up is taken at its present
/// use. `drawn`: of a plan whose nominal demand is `nominal`.
[[nodiscard]] Margins margins_for(const std::vector<PlanDemand>& drawn, const PlanDemand& nominal,
                                  double reserve_fraction, double share);

/// Whether so many of n draws are kept that the probability to be kept is above p, wrongly with at most
/// `error`: the one-sided Clopper-Pearson bound, by the tail of the binomial distribution.
[[nodiscard]] bool is_shown(std::size_t kept, std::size_t n, double p, double error = 0.05);

/// The one-sided Clopper-Pearson lower bound.
[[nodiscard]] double kept_at_least(std::size_t kept, std::size_t n, double error = 0.05);

}  // namespace joulepath
