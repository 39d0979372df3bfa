#include "planner/mission/time_split.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

#include "model/limits.hpp"

namespace joulepath {
namespace {

constexpr double kHighestPrice_W = 1e7;
/// The search for a price that arrives in time climbs in logarithms: twice as far each step, evenly from the
/// first one on.
constexpr double kEvenClimbs = 8.0, kWidestClimb = 2.0;
constexpr double kNearFastest = 4.0;  ///< of the same logarithm
/// Share of a climb's gain in time: at such prices the delay over the fastest drive falls as 1 / price or
/// faster.
constexpr double kGainLeft = 0.5;
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

/// Logarithms of prices, and by how much (s) they arrive late: `high` in time where there is such a price.
struct PriceBracket {
  double low{}, late_low_s{};
  double high{}, late_high_s{};
};

/// Climbs from 0 to a price that arrives in time. A climb ends, too, where the delay is below that of the
/// fastest drive and the last step gained too little for another one to be in time.
template <class LateOf>
PriceBracket climb(const LateOf& late_s, double late_at_0_s, double late_fastest_s) {
  const double highest = std::log1p(kHighestPrice_W);
  PriceBracket at{.low = 0.0, .late_low_s = late_at_0_s, .high = 0.5, .late_high_s = late_s(0.5)};
  while (at.late_high_s > 0 && at.high < highest) {
    const double gain_s = at.late_low_s - at.late_high_s;
    if (at.late_high_s < late_fastest_s && kGainLeft * gain_s < at.late_high_s) break;
    at.low = at.high, at.late_low_s = at.late_high_s;
    at.high = std::min({2 * at.high, std::max(kEvenClimbs, at.high + kWidestClimb), highest});
    at.late_high_s = late_s(at.high);
  }
  return at;
}

/// The logarithm of the price in a bracket that arrives at the bound, `spare_s` before it.
template <class LateOf>
double price_within(const PriceBracket& at, const LateOf& late_s, double spare_s) {
  std::optional<double> at_due;
  const auto off_s = [&](double x) {
    const double off = late_s(x) + spare_s;
    if (std::abs(off) <= spare_s) at_due = x;
    return off;
  };
  // Near the fastest drive the delay is almost a polynomial in 1 / price.
  const bool near_fastest = at.low >= kNearFastest;
  const auto to_search = [&](double x) { return near_fastest ? -std::exp(-x) : x; };
  const auto from_search = [&](double u) { return near_fastest ? -std::log(-u) : u; };
  const auto close = [&](double a, double b) {
    return at_due || std::abs(from_search(a) - from_search(b)) < 1e-9 * (1 + std::abs(from_search(a)));
  };
  std::uintmax_t iterations = kPriceTrials;
  const auto bracket = boost::math::tools::toms748_solve(
      [&](double u) { return off_s(from_search(u)); }, to_search(at.low), to_search(at.high),
      at.late_low_s + spare_s, at.late_high_s + spare_s, close, iterations);
  return at_due.value_or(from_search(bracket.second));
}

/// Smallest price, at least `lowest_W`, at which the legs first..last arrive by `due_s`; empty if there is
/// none.
std::optional<double> price_of(const TimeSplitRequest& request, std::size_t first, std::size_t last,
                               double departure_s, double due_s, double lowest_W) {
  // The search runs over the logarithm of the distance to the lowest price.
  const auto price_at = [&](double x) { return lowest_W + std::expm1(x); };
  const auto late_s = [&](double x) {
    return arrival_s(request, first, last, departure_s, price_at(x)) - due_s;
  };
  const double late_low_s = late_s(0.0);
  if (late_low_s <= 0) return lowest_W;
  const double fastest_s = arrival_s(request, first, last, departure_s, kNoLimit);
  if (!meets(fastest_s, due_s)) {
    // The least time decides before any price is searched. A drive at a high price may be earlier than the
    // fastest one found, but not before the time that is proven.
    const double proven_s = arrival_with_s(request, first, last, departure_s, request.least_s);
    if (fastest_s > due_s * (1 + kClearlyLate) || !meets(proven_s, due_s)) return std::nullopt;
  }
  const PriceBracket found = climb(late_s, late_low_s, fastest_s - due_s);
  if (found.late_high_s > 0) {  // at most the fastest drive arrives in time
    if (meets(fastest_s, due_s)) return kNoLimit;
    return std::nullopt;
  }
  // The search aims at the middle of the times that count as the bound, so that either side of it will do.
  const double spare_s = 0.5 * kSameArrival * due_s;
  if (found.late_high_s + spare_s >= 0) return price_at(found.high);
  return price_at(price_within(found, late_s, spare_s));
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
