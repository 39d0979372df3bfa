#include "planner/mission/time_split.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "model/limits.hpp"

namespace joulepath {
namespace {

constexpr double kHighestPrice_W = 1e7;
constexpr std::uintmax_t kPriceTrials = 24;  ///< of a search within its bracket
constexpr double kClearlyLate = 1e-3;  ///< relative: more than the differences between solvers of profiles
/// Relative: an arrival this little before its bound is at it. Times of profiles with a jerk limit scatter
/// more than the price that the search could still find.
constexpr double kSameArrival = 4e-8;

/// Arrival at the end of `last`, before any wait there, with these durations of the legs from `first` on.
template <class DurationOf>
double arrival_with_s(const TimeSplitRequest& request, std::size_t first, std::size_t last,
                      double departure_s, DurationOf&& duration_s) {
  double time_s = departure_s;
  for (std::size_t leg = first; leg <= last; ++leg) {
    time_s += duration_s(leg);
    if (leg < last) time_s = std::max(time_s, request.earliest_arrival_s[leg]) + request.dwell_s[leg];
  }
  return time_s;
}

/// The same when all these legs pay one price.
double arrival_s(const TimeSplitRequest& request, std::size_t first, std::size_t last, double departure_s,
                 double price_W) {
  return arrival_with_s(request, first, last, departure_s,
                        [&](std::size_t leg) { return request.duration_s(leg, price_W); });
}

bool meets(double time_s, double due_s) { return time_s <= due_s * (1 + 1e-9) + 1e-9; }

/// Smallest price, at least `lowest_W`, at which the legs first..last arrive by `due_s`; empty if there is
/// none.
std::optional<double> price_of(const TimeSplitRequest& request, std::size_t first, std::size_t last,
                               double departure_s, double due_s, double lowest_W) {
  // The search runs over the logarithm of the distance to the lowest price.
  const auto price_at = [&](double x) { return lowest_W + std::expm1(x); };
  const auto late_s = [&](double x) {
    return arrival_s(request, first, last, departure_s, price_at(x)) - due_s;
  };
  double low = 0.0;
  double late_low_s = late_s(low);
  if (late_low_s <= 0) return lowest_W;
  const double fastest_s = arrival_s(request, first, last, departure_s, kNoLimit);
  const double highest = std::log1p(kHighestPrice_W);
  if (!meets(fastest_s, due_s)) {
    // The least time decides before any price is searched. A drive at a high price may be earlier than the
    // fastest one found, but not before the time that is proven.
    const double proven_s = arrival_with_s(request, first, last, departure_s, request.least_s);
    if (fastest_s > due_s * (1 + kClearlyLate) || !meets(proven_s, due_s) || late_s(highest) > 0)
      return std::nullopt;
  }
  double high = 0.5;
  double late_high_s = late_s(high);
  while (late_high_s > 0 && high < highest) {
    low = high;
    late_low_s = late_high_s;
    high = std::min(2 * high, highest);
    late_high_s = late_s(high);
  }
  if (late_high_s > 0) return kNoLimit;  // only the fastest drive arrives in time
  // The search aims at the middle of the times that count as the bound, so that either side of it will do.
  const double spare_s = 0.5 * kSameArrival * due_s;
  std::uintmax_t iterations = kPriceTrials;
  std::optional<double> at_due;
  const auto off_s = [&](double x) {
    const double off = late_s(x) + spare_s;
    if (std::abs(off) <= spare_s) at_due = x;
    return off;
  };
  if (late_high_s + spare_s >= 0) return price_at(high);
  const auto close = [&](double a, double b) { return at_due || std::abs(a - b) < 1e-9 * (1 + std::abs(a)); };
  const auto bracket = boost::math::tools::toms748_solve(off_s, low, high, late_low_s + spare_s,
                                                         late_high_s + spare_s, close, iterations);
  return price_at(at_due.value_or(bracket.second));
}

/// Legs from the first that is not settled yet to `last`, with one price.
struct Block {
  double price_W{};
  std::size_t last{};
};

/// A deadline demands at least a price of all legs before it, the opening of a window at most one. The scan
/// ends where a demand contradicts an earlier one: that one binds, and its price holds up to its stop.
Block next_block(const TimeSplitRequest& request, std::size_t first, double departure_s, TimeSplit& split) {
  const std::size_t end = request.legs - 1;
  Block least{-kNoLimit, end}, most{kNoLimit, end};
  const bool windows = std::any_of(request.earliest_arrival_s.begin() + static_cast<std::ptrdiff_t>(first),
                                   request.earliest_arrival_s.end(), [](double s) { return s > 0; });
  const double floor_W = windows ? request.waiting_price_W : request.lowest_price_W;
  for (std::size_t last = first; last <= end; ++last) {
    if (std::isfinite(request.latest_arrival_s[last])) {
      const std::optional<double> price_W =
          price_of(request, first, last, departure_s, request.latest_arrival_s[last], floor_W);
      if (!price_W) {
        split.late = {
            last, arrival_s(request, first, last, departure_s, kNoLimit) - request.latest_arrival_s[last]};
        return {kNoLimit, last};
      }
      if (*price_W > most.price_W) return most;
      if (*price_W > std::max(least.price_W, floor_W)) least = {*price_W, last};
    }
    if (request.earliest_arrival_s[last] > 0) {
      const std::optional<double> price_W =
          price_of(request, first, last, departure_s, request.earliest_arrival_s[last], floor_W);
      if (price_W && *price_W < least.price_W) return least;
      if (price_W && *price_W < most.price_W) most = {*price_W, last};
    }
  }
  if (least.price_W > request.lowest_price_W) return least;
  if (most.price_W < request.lowest_price_W) return most;
  return {request.lowest_price_W, end};
}

}  // namespace

TimeSplit split_time(const TimeSplitRequest& request) {
  TimeSplit split{.price_W = std::vector<double>(request.legs, request.lowest_price_W),
                  .duration_s = std::vector<double>(request.legs, 0.0),
                  .arrival_s = std::vector<double>(request.legs, 0.0)};
  double departure_s = 0.0;
  for (std::size_t first = 0; first < request.legs;) {
    const Block block = next_block(request, first, departure_s, split);
    for (std::size_t leg = first; leg <= block.last; ++leg) {
      split.price_W[leg] = block.price_W;
      split.duration_s[leg] = request.duration_s(leg, block.price_W);
      split.arrival_s[leg] = std::max(departure_s + split.duration_s[leg], request.earliest_arrival_s[leg]);
      departure_s = split.arrival_s[leg] + request.dwell_s[leg];
    }
    first = block.last + 1;
  }
  return split;
}

}  // namespace joulepath
