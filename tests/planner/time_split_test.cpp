#include "planner/mission/time_split.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace joulepath {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Legs with E(T) = c/T + p T and a shortest time: dE/dT = -price gives T = sqrt(c/(p + price)).
struct Leg {
  double c{};
  double shortest_s{};
};

TimeSplitRequest request_of(const std::vector<Leg>& legs, std::vector<double> latest_s) {
  return {.legs = legs.size(),
          .duration_s =
              [legs](std::size_t k, double price_W) {
                return std::isinf(price_W)
                           ? legs[k].shortest_s
                           : std::max(legs[k].shortest_s, std::sqrt(legs[k].c / (2.0 + price_W)));
              },
          .least_s = [legs](std::size_t k) { return legs[k].shortest_s; },
          .latest_arrival_s = std::move(latest_s),
          .earliest_arrival_s = std::vector<double>(legs.size(), 0.0),
          .dwell_s = std::vector<double>(legs.size(), 0.0),
          .lowest_price_W = 0.0,
          .waiting_price_W = -1.999};
}

/// Each price costs a solve of every profile: a deadline before the proven least time is refused without any.
TEST(TimeSplit, TheLeastTimeDecidesBeforeAnyPriceIsSearched) {
  TimeSplitRequest request = request_of({{1000, 5}}, {5 * (1 - 5e-4)});
  int searched = 0;
  const auto duration_s = request.duration_s;
  request.duration_s = [&](std::size_t leg, double price_W) {
    searched += price_W > 0 && std::isfinite(price_W);
    return duration_s(leg, price_W);
  };
  ASSERT_TRUE(split_time(request).late);
  EXPECT_EQ(searched, 0);
  request.least_s = [](std::size_t) { return 4.9; };  // not proven: prices decide
  ASSERT_TRUE(split_time(request).late);
  EXPECT_LE(searched, 10);
  request.latest_arrival_s = {6.0};
  EXPECT_FALSE(split_time(request).late);
}

/// A drive at a high price may be earlier than the fastest one found: T = 5 + c / price against 5.0005.
/// Profiles of very high prices converge slowly, so none is solved that could not help.
TEST(TimeSplit, APriceBelowTheFastestDriveFoundIsSearchedOnlyAsHighAsItHelps) {
  for (const double c : {0.1, 1.0, 10.0})
    for (const double due_s : {4.9999, 5.00001, 5.0001, 5.0004, 5.001, 5.01}) {
      double highest_W = 0;
      int solves = 0;
      TimeSplitRequest request = request_of({{1000, 5}}, {due_s});
      request.duration_s = [&](std::size_t, double price_W) {
        if (std::isinf(price_W)) return 5.0005;
        highest_W = std::max(highest_W, price_W), ++solves;
        return 5.0 + c / (1 + price_W);
      };
      request.least_s = [](std::size_t) { return 4.99; };
      const TimeSplit split = split_time(request);
      EXPECT_EQ(split.late.has_value(), due_s < 5.0) << c << ", " << due_s;
      EXPECT_TRUE(split.late || std::abs(split.arrival_s[0] - due_s) < 1e-6) << c << ", " << due_s;
      EXPECT_LT(highest_W, 60 * std::max(c / std::abs(due_s - 5), 100.0)) << c << ", " << due_s;
      EXPECT_LE(solves, 24) << c << ", " << due_s;
    }
}

/// Times of profiles scatter: a search of the price ends, within 24 trials of its bracket and the bracket's
/// own.
TEST(TimeSplit, ASearchOfThePriceEndsWhereTimesScatter) {
  constexpr int kBracket = 6;
  for (const double share : {1.0005, 1.001, 1.01, 1.1}) {
    TimeSplitRequest request = request_of({{1000, 5}}, {5 * share});
    int solves = 0;
    const auto duration_s = request.duration_s;
    request.duration_s = [&](std::size_t leg, double price_W) {
      ++solves;
      const double scatter = std::isinf(price_W) ? 0.0 : 1e-8 * std::sin(1e9 * price_W);
      return duration_s(leg, price_W) * (1 + scatter);
    };
    const TimeSplit split = split_time(request);
    ASSERT_FALSE(split.late);
    EXPECT_LE(split.arrival_s[0], 5 * share * (1 + 1e-9));
    EXPECT_NEAR(split.arrival_s[0], 5 * share, 1e-6);
    EXPECT_LE(solves, 24 + kBracket) << share;
  }
}

/// A drive that jumps at one price: the arrival is never at its bound. The search ends all the same, in time,
/// near the least price that is.
TEST(TimeSplit, ASearchEndsNearTheLeastPriceWhereTimesJump) {
  constexpr int kBracket = 8;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const double jump_W = std::pow(10, 4 * share(random) - 1), late_s = 5.5 + 3 * share(random),
                 early_s = 4.0 + 0.9 * share(random), slope = share(random);
    int solves = 0;
    TimeSplitRequest request = request_of({{1000, 3}}, {5.0});
    request.duration_s = [&](std::size_t, double price_W) {
      ++solves;
      return price_W < jump_W ? late_s + slope / (1 + price_W) : early_s + 0.1 * slope / (1 + price_W);
    };
    const TimeSplit split = split_time(request);
    ASSERT_FALSE(split.late);
    EXPECT_LE(split.arrival_s[0], 5.0);
    EXPECT_LE(split.price_W[0] - jump_W, 2.2e-3 * (1 + jump_W)) << jump_W;
    EXPECT_LE(solves, 24 + kBracket) << jump_W;
  }
}

TEST(TimeSplit, WithoutDeadlinesThePriceOfTimeIsTheLowest) {
  const TimeSplit split = split_time(request_of({{100, 1}, {50, 1}}, {kNone, kNone}));
  EXPECT_EQ(split.price_W, (std::vector<double>{0.0, 0.0}));
  EXPECT_NEAR(split.arrival_s[1], std::sqrt(50.0) + 5.0, 1e-12);
}

TEST(TimeSplit, OneDeadlineIsMetExactlyAtOnePrice) {
  const TimeSplit split = split_time(request_of({{100, 1}, {50, 1}, {400, 1}}, {kNone, kNone, 20.0}));
  EXPECT_NEAR(split.arrival_s[2], 20.0, 1e-6);
  EXPECT_LE(split.arrival_s[2], 20.0 + 1e-12);
  EXPECT_EQ(split.price_W[0], split.price_W[2]);
  // closed form: sum sqrt(c) / sqrt(2 + price) = 20
  const double roots = 10 + std::sqrt(50.0) + 20;
  EXPECT_NEAR(split.price_W[0], std::pow(roots / 20, 2) - 2, 1e-6);
}

TEST(TimeSplit, PriceFallsBehindAnEarlyDeadlineThatBinds) {
  const TimeSplit split = split_time(request_of({{100, 1}, {50, 1}}, {4.0, 30.0}));
  EXPECT_NEAR(split.arrival_s[0], 4.0, 1e-6);
  EXPECT_GT(split.price_W[0], 1.0);
  EXPECT_EQ(split.price_W[1], 0.0);
}

TEST(TimeSplit, LooseEarlyDeadlineDoesNotBind) {
  const TimeSplit split = split_time(request_of({{100, 1}, {50, 1}}, {9.0, 10.0}));
  EXPECT_NEAR(split.price_W[0], split.price_W[1], 1e-4 * split.price_W[0]);
  EXPECT_NEAR(split.arrival_s[1], 10.0, 1e-6);
}

TEST(TimeSplit, SaysWhichDeadlineCannotBeMetAndByHowMuch) {
  const TimeSplit split = split_time(request_of({{100, 3}, {50, 2}}, {kNone, 4.0}));
  ASSERT_TRUE(split.late.has_value());
  EXPECT_EQ(split.late->leg, 1u);
  EXPECT_NEAR(split.late->amount_s, 1.0, 1e-9);
}

TEST(TimeSplit, NoRandomFeasibleSplitIsCheaper) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Leg> legs;
    std::vector<double> latest_s;
    double total_s = 0;
    for (int k = 0; k < 4; ++k) {
      legs.push_back({10 + 200 * uniform(random), 0.5});
      total_s += 0.6 + 6 * uniform(random);
      latest_s.push_back(uniform(random) < 0.6 ? total_s : kNone);
    }
    const TimeSplit split = split_time(request_of(legs, latest_s));
    ASSERT_FALSE(split.late);
    const auto energy_J = [&](const std::vector<double>& durations_s) {
      double sum_J = 0;
      for (std::size_t k = 0; k < legs.size(); ++k)
        sum_J += legs[k].c / durations_s[k] + 2.0 * durations_s[k];
      return sum_J;
    };
    const double best_J = energy_J(split.duration_s);
    for (int shake = 0; shake < 200; ++shake) {
      std::vector<double> other_s = split.duration_s;
      for (double& d : other_s) d = std::max(0.5, d * (1 + 0.1 * (uniform(random) - 0.5)));
      double arrival_s = 0;
      bool in_time = true;
      for (std::size_t k = 0; k < legs.size(); ++k) in_time &= (arrival_s += other_s[k]) <= latest_s[k];
      if (in_time) {
        EXPECT_GE(energy_J(other_s), best_J * (1 - 1e-6));
      }
    }
  }
}

/// A window that opens late leaves time: the legs before it share it, and the price rises behind it.
TEST(TimeSplit, LegsBeforeAWindowUseTheTimeUntilItOpens) {
  TimeSplitRequest request = request_of({{100, 1}, {50, 1}, {50, 1}}, {kNone, kNone, kNone});
  request.earliest_arrival_s[1] = 20.0;
  const TimeSplit split = split_time(request);
  const double roots = 10 + std::sqrt(50.0);
  EXPECT_NEAR(split.price_W[0], std::pow(roots / 20, 2) - 2, 1e-6);
  EXPECT_EQ(split.price_W[1], split.price_W[0]);
  EXPECT_NEAR(split.duration_s[0] + split.duration_s[1], 20.0, 1e-6);
  EXPECT_EQ(split.price_W[2], 0.0);
}

/// Random deadlines and windows, and feasible plans near the split: none costs less, its waits included.
TEST(TimeSplit, NoRandomPlanWithWindowsIsCheaper) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int waiting = 0, compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Leg> legs;
    std::vector<double> latest_s, earliest_s;
    double total_s = 0;
    for (int k = 0; k < 5; ++k) {
      legs.push_back({10 + 200 * uniform(random), 0.5});
      total_s += 0.6 + 15 * uniform(random);
      latest_s.push_back(uniform(random) < 0.4 ? total_s : kNone);
      earliest_s.push_back(uniform(random) < 0.5 ? (0.3 + 0.7 * uniform(random)) * total_s : 0.0);
    }
    TimeSplitRequest request = request_of(legs, latest_s);
    request.earliest_arrival_s = earliest_s;
    const TimeSplit split = split_time(request);
    ASSERT_FALSE(split.late) << trial;
    // Standby of 2 W is paid until the last arrival, waits included; nothing for a plan that is late.
    const auto cost_J = [&](const std::vector<double>& durations_s) {
      double sum_J = 0, arrival_s = 0;
      for (std::size_t k = 0; k < legs.size(); ++k) {
        arrival_s = std::max(arrival_s + durations_s[k], earliest_s[k]);
        if (arrival_s > latest_s[k] * (1 + 1e-9)) return kNone;
        sum_J += legs[k].c / durations_s[k];
      }
      return sum_J + 2.0 * arrival_s;
    };
    const double best_J = cost_J(split.duration_s);
    ASSERT_TRUE(std::isfinite(best_J)) << trial;
    for (std::size_t k = 0; k < legs.size(); ++k) waiting += split.price_W[k] < 0;
    for (int shake = 0; shake < 400; ++shake) {
      const double size = shake % 2 ? 0.5 : 0.02;
      std::vector<double> other_s = split.duration_s;
      for (double& d : other_s) d = std::max(0.5, d * (1 + size * (uniform(random) - 0.5)));
      const double other_J = cost_J(other_s);
      compared += std::isfinite(other_J);
      EXPECT_GE(other_J, best_J * (1 - 1e-7)) << trial;
    }
  }
  EXPECT_GT(waiting, 100);
  EXPECT_GT(compared, 10000);
}

}  // namespace
}  // namespace joulepath
