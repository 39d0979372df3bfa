#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-overflow"  // GCC 12 is wrong about copies of a std::variant
#endif

#include "planner/nlp/reach.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/nlp/forward_backward.hpp"
#include "planner/nlp/grid.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath::nlp {
namespace {

using joulepath::testing::RandomProfiles;

/// How far a value is beyond its bounds, relative to them.
double excess(const Bounds& bounds, double value) {
  return std::max({0.0, value / bounds.high - 1, value / bounds.low - 1});
}

/// The largest excess of every row that a segment can have, left out or not.
template <std::size_t... I>
double worst_excess(const Problem& problem, const Interval<double>& interval, std::index_sequence<I...>) {
  double worst = 0;
  const auto look = [&](const auto& term) {
    for (std::size_t row = 0; row < std::decay_t<decltype(term)>::rows; ++row) {
      const Bounds bounds = term.bounds(interval.segment, row);
      worst = std::max(worst, excess(bounds, term(interval, row)));
    }
  };
  (look(std::get<I>(problem.terms)), ...);
  return worst;
}

template <class... Terms>
constexpr std::size_t count_rows(const std::tuple<Terms...>*) {
  return (Terms::rows + ...);
}

bool kept_rows_hold(const Problem& problem, std::size_t k, const Interval<double>& interval) {
  for (std::size_t i = problem.first_row[k]; i < problem.first_row[k + 1]; ++i)
    if (excess(problem.rows[i].bounds, evaluate_row(problem, problem.rows[i], interval)) > 0) return false;
  return true;
}

/// The square at the segment's end nearest to `aim` for which the kept rows hold, from one where they do.
double edge(const Problem& problem, std::size_t k, double b0, double inside, double aim) {
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inside + aim);
    (kept_rows_hold(problem, k, plain_interval(problem.segments[k], b0, middle)) ? inside : aim) = middle;
  }
  return inside;
}

ProfileRequest random_request(RandomProfiles& random, int index) {
  ProfileRequest request = random.next(joulepath::testing::kPathClasses[index % 4]);
  for (Side side : kSides) request.plant.robot.motor[side].max_current_A *= random.uniform(0.02, 0.6);
  request.limits.wheel_acceleration_rad_s2 = random.uniform(2, 20);
  request.limits.yaw_acceleration_rad_s2 *= random.uniform(0.3, 3);
  request.time = {TimeMode::minimum_time};
  return request;
}

/// 80 random problems with motors small enough that their limits count: where a segment's kept rows just
/// hold, rows that were left out hold too.
TEST(Rows, HoldWhereTheyAreLeftOut) {
  RandomProfiles random(7);
  constexpr auto kTerms = std::make_index_sequence<std::tuple_size_v<Rows>>();
  std::size_t tried = 0, left_out = 0;
  for (int i = 0; i < 80; ++i) {
    const ProfileRequest request = random_request(random, i);
    const PathMotion motion = path_motion(request);
    const Problem problem = transcribe(request, motion, make_grid(motion, request, 60), {}, nullptr);
    const RateEnvelope envelope = rate_envelope(problem);
    if (envelope.blocked) continue;
    for (std::size_t k = 1; k + 2 < problem.node_count(); ++k)
      for (int sample = 0; sample < 10; ++sample) {
        const double share = random.uniform(0, 1), most = envelope.fastest[k + 1];
        const double b0 = share * envelope.fastest[k];
        const Segment& segment = problem.segments[k];
        if (!kept_rows_hold(problem, k, plain_interval(segment, b0, share * most))) continue;
        for (double aim : {0.0, most}) {
          const double b1 = edge(problem, k, b0, share * most, aim);
          EXPECT_LE(worst_excess(problem, plain_interval(segment, b0, b1), kTerms), 1e-6)
              << "problem " << i << ", segment " << k;
          ++tried;
        }
        left_out +=
            problem.first_row[k + 1] - problem.first_row[k] < count_rows(static_cast<const Rows*>(nullptr));
      }
  }
  EXPECT_GT(tried, 20000u);
  EXPECT_GT(left_out, 10000u);
}

}  // namespace
}  // namespace joulepath::nlp
