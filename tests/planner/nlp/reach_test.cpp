#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-overflow"  // GCC 12 is wrong about copies of a std::variant
#endif

// Rows that are left out of the problem hold wherever the kept ones hold.
#include "planner/nlp/transcription/reach.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath::nlp {
namespace {

using joulepath::testing::RandomProfiles;
constexpr auto kTerms = std::make_index_sequence<std::tuple_size_v<Rows>>();

/// How far a value is beyond its bounds, relative to them.
double excess(const Bounds& bounds, double value) {
  return std::max({0.0, value / bounds.high - 1, value / bounds.low - 1});
}

double number(double x) { return x; }
double number(const JerkJet& x) { return x.value; }

struct ReachCase {
  ProfileRequest request;
  std::vector<Tightening> tightenings{};
};

/// A case transcribed, and the fastest rates at its nodes.
struct Transcribed {
  const ReachCase& of;
  Problem problem;
  RateEnvelope envelope;

  /// A share of the fastest rate; the rates at the ends are given.
  double rate(std::size_t node, double share) const {
    const bool end = node == 0 || node + 1 == problem.node_count();
    return std::sqrt(envelope.fastest[node]) * (end ? 1.0 : share);
  }
};

/// The largest excess of every row that a segment can have, left out or not.
template <class AnyInterval, std::size_t... I>
double worst_excess(const Transcribed& on, const AnyInterval& interval, std::index_sequence<I...>) {
  double worst = 0;
  const Segment& segment = interval.segment;
  const auto look = [&](const auto& term) {
    using Term = std::decay_t<decltype(term)>;
    const double factor = factor_for(on.of.tightenings, Term::name, segment.s0, segment.s0 + segment.ds);
    for (std::size_t row = 0; row < Term::rows; ++row) {
      const Bounds bounds = term.bounds(segment, row);
      worst =
          std::max(worst, excess({bounds.low * factor, bounds.high * factor}, number(term(interval, row))));
    }
  };
  (look(std::get<I>(on.problem.terms)), ...);
  return worst;
}

template <class... Terms>
constexpr std::size_t count_rows(const std::tuple<Terms...>*) {
  return (Terms::rows + ...);
}

template <class AnyInterval>
bool kept_rows_hold(const Problem& problem, std::size_t k, const AnyInterval& interval) {
  for (std::size_t i = problem.first_row[k]; i < problem.first_row[k + 1]; ++i)
    if (excess(problem.rows[i].bounds, number(evaluate_row(problem, problem.rows[i], interval))) > 0)
      return false;
  return true;
}

/// Motions with constant acceleration in a segment.
struct Steady {
  using Point = std::array<double, 2>;  ///< rates at both ends

  static Interval<double> interval(const Segment& segment, const Point& u) {
    return plain_interval(segment, u[0] * u[0], u[1] * u[1]);
  }
  static bool holds(const Problem& problem, std::size_t k, const Point& u) {
    return kept_rows_hold(problem, k, interval(problem.segments[k], u));
  }
  static Point inside(const Transcribed& on, std::size_t k, double share) {
    return {on.rate(k, share), on.rate(k + 1, share)};
  }
  static Point aim(const Transcribed& on, std::size_t k, RandomProfiles& random) {
    return {on.rate(k, random.uniform(0, 1)), on.rate(k + 1, random.uniform(0, 1))};
  }
};

/// Motions with constant jerk in a segment: the rate is a quadratic Bezier curve in time.
struct WithJerk {
  using Point = std::array<double, 3>;  ///< its three points

  static JerkInterval<JerkJet> interval(const Segment& segment, const Point& u) {
    const double dt = 3 * segment.ds / (u[0] + u[1] + u[2]);
    return jet_jerk_interval(segment, {u[0], 2 * (u[1] - u[0]) / dt, u[2], 2 * (u[2] - u[1]) / dt, dt});
  }
  /// Kept rows, and the additional rows of a JerkProgram.
  static bool holds(const Problem& problem, std::size_t k, const Point& u) {
    const JerkInterval<JerkJet> motion = interval(problem.segments[k], u);
    const Limits& limits = problem.request->limits;
    for (double a : {motion.a0.value, motion.a1.value})
      if (a > limits.acceleration_m_s2 || a < -limits.deceleration_m_s2) return false;
    if (std::abs(motion.a1.value - motion.a0.value) > limits.jerk_m_s3 * motion.dt.value) return false;
    if (u[1] > 0.5 * (std::sqrt(problem.cap[k].squared) + std::sqrt(problem.cap[k + 1].squared)))
      return false;
    return kept_rows_hold(problem, k, motion);
  }
  static Point inside(const Transcribed& on, std::size_t k, double share) {
    const double u0 = on.rate(k, share), u1 = on.rate(k + 1, share);
    return {u0, 0.5 * (u0 + u1), u1};
  }
  static Point aim(const Transcribed& on, std::size_t k, RandomProfiles& random) {
    const double u0 = on.rate(k, random.uniform(0, 1)), u1 = on.rate(k + 1, random.uniform(0, 1));
    return {u0, random.uniform(0, 2) * std::max(on.rate(k, 1), on.rate(k + 1, 1)), u1};
  }
};

/// The motion nearest to `aim` for which the kept rows hold, from one where they do.
template <class Motions, class Point = typename Motions::Point>
Point edge(const Problem& problem, std::size_t k, Point inside, Point aim) {
  if (Motions::holds(problem, k, aim)) return aim;
  for (int i = 0; i < 40; ++i) {
    Point middle;
    for (std::size_t n = 0; n < middle.size(); ++n) middle[n] = 0.5 * (inside[n] + aim[n]);
    (Motions::holds(problem, k, middle) ? inside : aim) = middle;
  }
  return inside;
}

struct Count {
  std::size_t tried{}, left_out{};
};

/// Random motions of every segment, up to the border of the kept rows: the rows that were left out hold too.
template <class Motions>
void check(const ReachCase& of, RandomProfiles& random, int index, Count& count) {
  const PathMotion motion = path_motion(of.request);
  Transcribed on{
      of, transcribe(of.request, motion, make_grid(motion, of.request, 60), of.tightenings, nullptr), {}};
  const Problem& problem = on.problem;
  on.envelope = rate_envelope(problem);
  if (on.envelope.blocked) return;
  for (std::size_t k = 0; k < problem.segment_count(); ++k)
    for (int sample = 0; sample < 10; ++sample) {
      const auto inside = Motions::inside(on, k, random.uniform(0, 1));
      if (!Motions::holds(problem, k, inside)) continue;
      const auto at = edge<Motions>(problem, k, inside, Motions::aim(on, k, random));
      EXPECT_LE(worst_excess(on, Motions::interval(problem.segments[k], at), kTerms), 1e-6)
          << "problem " << index << ", segment " << k << " of " << problem.segment_count();
      ++count.tried;
      count.left_out +=
          problem.first_row[k + 1] - problem.first_row[k] < count_rows(static_cast<const Rows*>(nullptr));
    }
}

/// Motors small enough that their limits count; a payload that changes, a slow zone, a limit made tighter and
/// speed at the ends now and then.
ReachCase random_case(RandomProfiles& random, int index) {
  ReachCase result{random.next(joulepath::testing::kPathClasses[index % 4])};
  ProfileRequest& request = result.request;
  for (Side side : kSides) {
    request.plant.robot.motor[side].max_current_A *= random.uniform(0.02, 0.6);
    request.plant.robot.motor[side].max_voltage_V *= random.uniform(0.05, 1);
  }
  request.limits.wheel_acceleration_rad_s2 = random.uniform(2, 20);
  request.limits.yaw_acceleration_rad_s2 *= random.uniform(0.3, 3);
  request.limits.traction_coefficient *= random.uniform(0.05, 0.5);
  request.payload.to_kg = random.uniform(0, 10.5);
  request.time = {TimeMode::minimum_time};
  const double length = piece_length(request.piece);
  if (random.choice(2) == 0) {
    const double from = random.uniform(0, 0.8) * length;
    request.speed_caps = {{from, from + random.uniform(0.1, 0.3) * length, random.uniform(0.05, 0.4)}};
  }
  if (random.choice(2) == 0) request.start_rate = random.uniform(0, 0.3);
  if (random.choice(2) == 0) request.end_rate = random.uniform(0, 0.3);
  for (const char* limit : {"motor_current", "motor_voltage", "traction", "wheel_acceleration", "speed"})
    if (random.choice(3) == 0)
      result.tightenings.push_back({limit, 0.2 * length, 0.7 * length, random.uniform(0.5, 1)});
  return result;
}

TEST(Rows, HoldWhereTheyAreLeftOut) {
  RandomProfiles random(7);
  Count count;
  for (int i = 0; i < 120; ++i) check<Steady>(random_case(random, i), random, i, count);
  EXPECT_GT(count.tried, 20000u);
  EXPECT_GT(count.left_out, 10000u);
}

TEST(Rows, HoldWhereTheyAreLeftOutOfATurnOnTheSpot) {
  RandomProfiles random(8);
  Count count;
  for (int i = 0; i < 40; ++i) {
    ReachCase turn = random_case(random, 0);
    turn.request.piece = TurnInPlace{{}, random.uniform(-3, 3)};
    turn.request.speed_caps.clear();
    turn.tightenings.push_back({"motor_current", 0.0, 1.0, 0.8});
    check<Steady>(turn, random, i, count);
  }
  EXPECT_GT(count.tried, 10000u);
  EXPECT_GT(count.left_out, 1000u);
}

TEST(Rows, HoldWhereTheyAreLeftOutUnderAJerkLimit) {
  RandomProfiles random(9);
  Count count;
  for (int i = 0; i < 120; ++i) {
    ReachCase with_jerk = random_case(random, i);
    with_jerk.request.limits.jerk_m_s3 = random.uniform(0.2, 20);
    check<WithJerk>(with_jerk, random, i, count);
  }
  EXPECT_GT(count.tried, 20000u);
  EXPECT_GT(count.left_out, 10000u);
}

}  // namespace
}  // namespace joulepath::nlp
