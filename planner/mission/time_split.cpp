#include "planner/mission/time_split.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "model/limits.hpp"

namespace joulepath {
namespace {

constexpr double kHighestPrice_W = 1e7;
constexpr double kClearlyLate = 1e-3;  ///< relative: more than the differences between solvers of profiles

/// Arrival at the end of `last` when all legs from `first` pay one price.
double arrival_s(const TimeSplitRequest& request, std::size_t first, std::size_t last, double departure_s,
                 double price_W) {
  double time_s = departure_s;
  for (std::size_t leg = first; leg <= last; ++leg) {
    time_s = std::max(time_s + request.duration_s(leg, price_W), request.earliest_arrival_s[leg]);
    if (leg < last) time_s += request.dwell_s[leg];
  }
  return time_s;
}

/// Smallest price at which the legs first..last arrive in time; empty if there is none.
std::optional<double> price_of(const TimeSplitRequest& request, std::size_t first, std::size_t last,
                               double departure_s) {
  const double latest_s = request.latest_arrival_s[last];
  // The search runs over the logarithm of the distance to the lowest price.
  const auto price_at = [&](double x) { return request.lowest_price_W + std::expm1(x); };
  const auto late_s = [&](double x) {
    return arrival_s(request, first, last, departure_s, price_at(x)) - latest_s;
  };
  double low = 0.0;
  double late_low_s = late_s(low);
  if (late_low_s <= 0) return request.lowest_price_W;
  // Far above the minimum time: the lowest price is enough.
  if (arrival_s(request, first, last, departure_s, kNoLimit) > latest_s * (1 + kClearlyLate))
    return std::nullopt;
  const double highest = std::log1p(kHighestPrice_W);
  double high = 0.5;
  double late_high_s = late_s(high);
  while (late_high_s > 0 && high < highest) {
    low = high;
    late_low_s = late_high_s;
    high = std::min(2 * high, highest);
    late_high_s = late_s(high);
  }
  if (late_high_s > 0)
    return arrival_s(request, first, last, departure_s, kNoLimit) <= latest_s * (1 + 1e-9) + 1e-9
               ? std::optional(kNoLimit)
               : std::nullopt;
  std::uintmax_t iterations = 60;
  const auto close = [](double a, double b) { return std::abs(a - b) < 1e-9 * (1 + std::abs(a)); };
  const auto bracket =
      boost::math::tools::toms748_solve(late_s, low, high, late_low_s, late_high_s, close, iterations);
  return price_at(bracket.second);
}

}  // namespace

TimeSplit split_time(const TimeSplitRequest& request) {
  TimeSplit split{.price_W = std::vector<double>(request.legs, request.lowest_price_W),
                  .duration_s = std::vector<double>(request.legs, 0.0),
                  .arrival_s = std::vector<double>(request.legs, 0.0)};
  double departure_s = 0.0;
  for (std::size_t first = 0; first < request.legs;) {
    std::size_t binding = request.legs - 1;
    double highest_W = request.lowest_price_W;
    for (std::size_t last = first; last < request.legs && !split.late; ++last) {
      if (!std::isfinite(request.latest_arrival_s[last])) continue;
      const std::optional<double> price_W = price_of(request, first, last, departure_s);
      if (!price_W) {
        split.late = {
            last, arrival_s(request, first, last, departure_s, kNoLimit) - request.latest_arrival_s[last]};
        highest_W = kNoLimit;
        binding = last;
      } else if (*price_W > highest_W) {
        highest_W = *price_W;
        binding = last;
      }
    }
    for (std::size_t leg = first; leg <= binding; ++leg) {
      split.price_W[leg] = highest_W;
      split.duration_s[leg] = request.duration_s(leg, highest_W);
      split.arrival_s[leg] = std::max(departure_s + split.duration_s[leg], request.earliest_arrival_s[leg]);
      departure_s = split.arrival_s[leg] + request.dwell_s[leg];
    }
    first = binding + 1;
  }
  return split;
}

}  // namespace joulepath
