#include "planner/confidence/margins.hpp"

#include <algorithm>
#include <cmath>

#include "planner/accounts/winding_account.hpp"

namespace joulepath {
namespace {

constexpr double kRounding = 1e-6;  ///< relative, of a plan's own limits
constexpr int kBisections = 30;

/// The smallest value that a share of the sorted ones does not exceed.
double quantile(const std::vector<double>& sorted, double share) {
  const auto count = static_cast<double>(sorted.size());
  const double place = std::ceil(share * count) - 1;
  return sorted[static_cast<std::size_t>(std::clamp(place, 0.0, count - 1))];
}

/// Demands relative to the nominal ones, sorted for their quantiles.
class RelativeDemands {
 public:
  RelativeDemands(const std::vector<PlanDemand>& drawn, const PlanDemand& nominal, double reserve_fraction)
      : drawn_(drawn), nominal_(nominal), reserve_(reserve_fraction) {
    for (std::size_t i = 0; i < kUsedLimits; ++i) {
      for (const PlanDemand& demand : drawn) growth_[i].push_back(growth(demand, i));
      std::sort(growth_[i].begin(), growth_[i].end());
    }
    for (const PlanDemand& demand : drawn) drop_.push_back(nominal.least_fraction - demand.least_fraction);
    std::sort(drop_.begin(), drop_.end());
  }

  Margins at(double quantile_share) const {
    Margins margins;
    for (std::size_t i = 0; i < kUsedLimits; ++i)
      margins.share[i] = std::min(1.0, 1 / quantile(growth_[i], quantile_share));
    margins.reserve = std::max(0.0, quantile(drop_, quantile_share));
    return margins;
  }

  /// Share of the draws that a plan with these margins keeps.
  double kept(const Margins& margins) const {
    std::size_t count = 0;
    for (const PlanDemand& demand : drawn_) count += is_kept(demand, margins) ? 1 : 0;
    return static_cast<double>(count) / static_cast<double>(drawn_.size());
  }

 private:
  double growth(const PlanDemand& demand, std::size_t i) const {
    return nominal_.use[i] > 0 ? demand.use[i] / nominal_.use[i] : demand.use[i];
  }

  bool is_kept(const PlanDemand& demand, const Margins& margins) const {
    for (std::size_t i = 0; i < kUsedLimits; ++i) {
      const double use = nominal_.use[i] > 0 ? std::min(nominal_.use[i], margins.share[i]) : 1.0;
      if (growth(demand, i) * use > 1 + kRounding) return false;
    }
    const double left = std::max(nominal_.least_fraction, reserve_ + margins.reserve);
    return left - (nominal_.least_fraction - demand.least_fraction) >= reserve_ - kRounding;
  }

  const std::vector<PlanDemand>& drawn_;
  const PlanDemand& nominal_;
  double reserve_;
  std::array<std::vector<double>, kUsedLimits> growth_{};
  std::vector<double> drop_{};
};

/// Probability that at least `kept` of n draws are kept, each with probability p: from the last term down,
/// by their ratios, in logarithms.
double upper_tail(std::size_t kept, std::size_t n, double p) {
  const double odds = std::log1p(-p) - std::log(p);
  double sum = 0, term = static_cast<double>(n) * std::log(p);
  for (std::size_t k = n; k + 1 > kept; --k) {
    sum += std::exp(term);
    if (k == 0) break;
    term += std::log(static_cast<double>(k) / static_cast<double>(n - k + 1)) + odds;
  }
  return sum;
}

}  // namespace

LimitShares Margins::limit_shares() const {
  LimitShares shares;
  for (std::size_t i = 0; i < kUsedLimits; ++i)
    if (share[i] < 1) shares.emplace(used_limit_name(i), share[i]);
  return shares;
}

Robot with_margins(Robot robot, const LimitShares& shares, double reserve) {
  robot.battery.reserve_fraction += reserve;
  robot.battery.reserve_margin = reserve;
  const auto share = shares.find(kWindingTemperature);
  for (const Side side : kSides) {
    std::optional<WindingThermal>& thermal = robot.motor[side].thermal;
    if (!thermal || share == shares.end()) continue;
    thermal->margin_K = (1 - share->second) * (thermal->max_winding_C - thermal->ambient_C);
    thermal->max_winding_C -= thermal->margin_K;
  }
  return robot;
}

bool keeps_limit(const PlanDemand& demand, std::size_t i) { return demand.use[i] <= 1 + kRounding; }

bool keeps_forces(const PlanDemand& demand) {
  for (std::size_t i = 0; i < kForceLimits; ++i)
    if (!keeps_limit(demand, i)) return false;
  return true;
}

bool keeps_limits(const PlanDemand& demand) {
  return keeps_forces(demand) && keeps_limit(demand, kWindingLimit);
}

bool keeps_reserve(const PlanDemand& demand, double reserve_fraction) {
  return demand.least_fraction >= reserve_fraction - kRounding;
}

Margins margins_for(const std::vector<PlanDemand>& drawn, const PlanDemand& nominal, double reserve_fraction,
                    double share) {
  const RelativeDemands demands(drawn, nominal, reserve_fraction);
  double low = 0, high = 1;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (demands.kept(demands.at(middle)) >= share ? high : low) = middle;
  }
  return demands.at(high);
}

bool is_shown(std::size_t kept, std::size_t n, double p, double error) {
  return kept > 0 && upper_tail(kept, n, p) <= error;
}

double kept_at_least(std::size_t kept, std::size_t n, double error) {
  double low = 0, high = 1;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (is_shown(kept, n, middle, error) ? low : high) = middle;
  }
  return low;
}

}  // namespace joulepath
