#include "planner/bound/rate_table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace joulepath {
namespace {

constexpr int kPricesEachWay = 8;
constexpr double kRateTolerance = 0.02;    ///< J/m
constexpr double kRateTolerance_J = 2e-3;  ///< of a short piece
constexpr double kTypicalPrice = 0.5;      ///< of the price at which turning in place pays
constexpr double kWidest = 0.97;           ///< of that price
constexpr double kNarrower = 0.85;
constexpr double kNarrowest = 0.2;
constexpr double kPriceRounding = 1e-9;

/// The same on a narrower range of prices.
HeadingRates narrowed(const HeadingRates& rates, double most_J) {
  if (most_J >= rates.most_J) return rates;
  const Eigen::ArrayXd prices = Eigen::ArrayXd::LinSpaced(rates.at.size(), -most_J, most_J);
  return {most_J, prices.unaryExpr([&](double price) { return rates(price); })};
}

/// Rates of motions at prices of a radian of heading. Where a price has no certified bound the prices of that
/// credit move together.
class RateSamples {
 public:
  RateSamples(const PowerForm& form, double time_W) : form_(form), time_W_(time_W) {}

  HeadingRates at(MotionPrice price, const TurnCredit& credit, double tolerance) {
    price.credit = credit, price.time_W = time_W_;
    const auto [found_range, is_new] = ranges_.try_emplace({credit.spin, credit.inner});
    auto& [turning_J, most_J] = found_range->second;
    if (is_new) {
      turning_J = turning_price(form_, credit, time_W_);
      most_J = std::isfinite(turning_J) ? kWidest * turning_J : 0.0;
    }
    for (;; most_J *= kNarrower) {
      const std::vector<double> rates = least_rates(form_, price, prices(most_J), tolerance);
      HeadingRates found{most_J, Eigen::Map<const Eigen::ArrayXd>(rates.data(), std::ssize(rates))};
      if (found.at.isFinite().all() || !(most_J > kNarrowest * turning_J)) return found;
    }
  }

 private:
  static std::vector<double> prices(double most_J) {
    std::vector<double> prices;
    for (int k = -kPricesEachWay; k <= kPricesEachWay; ++k) prices.push_back(most_J * k / kPricesEachWay);
    return prices;
  }

  const PowerForm& form_;
  double time_W_{};
  struct Range {
    double turning_J{}, most_J{};  ///< price at which turning in place pays; greatest one that is bounded
  };
  std::map<std::pair<double, double>, Range> ranges_{};  ///< by credit
};

}  // namespace

double HeadingRates::operator()(double per_rad_J) const {
  if (std::abs(per_rad_J) > most_J * (1 + kPriceRounding)) return -kNoLimit;
  const double place = (per_rad_J + most_J) / step_J();
  const Eigen::Index k = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place), 0, at.size() - 2);
  const double share = std::clamp(place - static_cast<double>(k), 0.0, 1.0);
  return at[k] + share * (at[k + 1] - at[k]);
}

RateTable rate_table(const PowerForm& form, double length_m, double time_W, bool start_given,
                     bool goal_given) {
  RateTable table{.line = line_price(form, length_m, time_W), .reverse = form.reverse};
  const double typical_J = kTypicalPrice * turning_price(form, {.spin = 1}, time_W);
  const std::vector<double> free{0.0}, given{-typical_J, 0.0, typical_J};
  const std::vector<TurnCredit> credits =
      falling_credits(form, table.line, time_W, start_given ? given : free, goal_given ? given : free);
  RateSamples rates(form, time_W);
  const std::size_t peak = table.line.peak;
  table.middle = rates.at({.p = table.line.p[peak]}, credits[peak], kRateTolerance);
  for (std::size_t k = 0; k < credits.size(); ++k) {
    const double ds = table.line.s_m[k + 1] - table.line.s_m[k];
    if (!(ds > 0) || k == peak) {
      table.pieces.push_back({table.middle, table.middle});
      continue;
    }
    const double tolerance = std::max(kRateTolerance, kRateTolerance_J / ds);
    const HeadingRates from = rates.at(price_on(table.line, k, false, form), credits[k], tolerance),
                       to = rates.at(price_on(table.line, k, true, form), credits[k], tolerance);
    const double most_J = std::min(from.most_J, to.most_J);
    table.pieces.push_back({narrowed(from, most_J), narrowed(to, most_J)});
  }
  const auto bounded = [](const HeadingRates& at) { return at.most_J > 0 && at.at.isFinite().all(); };
  table.bounded = bounded(table.middle) &&
                  std::all_of(table.pieces.begin(), table.pieces.end(),
                              [&](const auto& ends) { return bounded(ends[0]) && bounded(ends[1]); });
  return table;
}

}  // namespace joulepath
