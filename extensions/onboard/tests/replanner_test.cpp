#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <new>

#include "extensions/onboard/tests/situations.hpp"

namespace {
thread_local bool counting = false;
thread_local std::size_t allocations = 0;
void* allocate(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace joulepath {
namespace {

using testing::asked;
using testing::judge;
using testing::Judgment;
using testing::PathClass;
using testing::planned;
using testing::PlannedPiece;
using testing::RandomProfiles;
using testing::RandomSituations;
using testing::worst_use;

std::vector<PlannedPiece> pieces(unsigned seed, int count) {
  RandomProfiles random(seed);
  std::vector<PlannedPiece> all;
  for (int i = 0; i < count; ++i) {
    const bool free = i % 3 == 2;
    const double slack = random.uniform(1.1, 1.6);
    ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    if (auto piece = planned(std::move(request), free ? std::nullopt : std::optional(slack)))
      all.push_back(std::move(*piece));
  }
  return all;
}

PlannedPiece straight(double length_m, double slack = 1.3) {
  Robot robot = testing::nomad();
  return *planned({.piece = straight_piece({}, length_m),
                   .plant = make_plant(robot),
                   .limits = *robot.limits,
                   .payload = {4.0, 4.0}},
                  slack);
}

double difference(const nlp::Affine& x, const nlp::Affine& y) {
  return std::abs(x.constant - y.constant) + std::abs(x.of_a - y.of_a) + std::abs(x.of_b - y.of_b) +
         std::abs(x.of_u - y.of_u);
}

TEST(OnlineProblem, IsTheTranscriptionOfTheLoadOnBoard) {
  for (const PlannedPiece& piece : pieces(10, 8)) {
    OnlineProblem online(piece.request, piece.plan, 100);
    const PathMotion motion = path_motion(piece.request);
    const Situation situation{.payload_kg = motion.payload_kg(0) + 3.5};
    online.set(situation, 0);
    const nlp::Problem& tables = online.problem();
    const ProfileRequest request = asked(piece, situation);
    const PathMotion loaded = path_motion(request);
    const nlp::Problem fresh = nlp::transcribe(request, loaded, tables.s, {}, &piece.plan);
    ASSERT_EQ(tables.segment_count(), fresh.segment_count());
    for (std::size_t k = 0; k < fresh.segment_count(); ++k)
      for (std::size_t i = 0; i < nlp::kLimitPoints; ++i) {
        const nlp::SegmentPoint &a = tables.segments[k].limit_points[i],
                                &b = fresh.segments[k].limit_points[i];
        EXPECT_NEAR(a.site.payload_kg, b.site.payload_kg, 1e-9);
        for (const Side side : kSides) {
          EXPECT_LT(difference(a.wheel[side].current_A, b.wheel[side].current_A), 1e-8);
          EXPECT_LT(difference(a.wheel[side].force_N, b.wheel[side].force_N), 1e-6);
        }
      }
    for (std::size_t k = 1; k + 1 < fresh.node_count(); ++k)
      EXPECT_NEAR(tables.cap[k].squared / fresh.cap[k].squared, 1, 1e-6) << k;
  }
}

TEST(LoadedLimits, AreThoseOfTheRobotsTable) {
  Robot robot = testing::nomad();
  robot.limits_by_payload = {{.payload_kg = 2, .limit_by_key = {{"speed_m_s", 0.9}}},
                             {.payload_kg = 8, .limit_by_key = {{"speed_m_s", 0.5}, {"jerk_m_s3", 1.0}}}};
  const LoadedLimits loaded(robot, limits_for_payload(robot, 1), {1, 1});
  for (const double from : {0.0, 2.0, 3.3, 9.0})
    for (const double to : {from, from + 1.7, from + 9}) {
      const Limits expected = limits_between_payloads(robot, from, to), found = loaded.between(from, to);
      EXPECT_NEAR(found.speed_m_s, expected.speed_m_s, 1e-12);
      EXPECT_EQ(found.jerk_m_s3, expected.jerk_m_s3);
      EXPECT_EQ(found.acceleration_m_s2, expected.acceleration_m_s2);
    }
}

TEST(Replanner, AllocatesNothingAfterConstruction) {
  for (const PlannedPiece& piece : pieces(11, 8)) {
    Replanner replanner(piece.request, piece.plan);
    RandomSituations random(5);
    for (int i = 0; i < 40; ++i) {
      Situation situation = random.next(piece);
      if (i % 5 == 0) situation.stop_at = situation.s + 0.05 * i;
      if (i % 7 == 0) situation.time_left_s = 0.1;
      allocations = 0;
      counting = true;
      (void)replanner.replan(situation, {.iterations = i % 11 == 0 ? 3 : 60});
      counting = false;
      EXPECT_EQ(allocations, 0u) << "call " << i;
    }
  }
}

/// At the end, beyond it and just before it: a profile of the rest, at rest or braking, never a crash.
TEST(Replanner, TheEndOfThePieceIsASituation) {
  for (const PlannedPiece& piece : pieces(15, 8)) {
    Replanner replanner(piece.request, piece.plan);
    const PathMotion motion = path_motion(piece.request);
    const double length = replanner.length();
    for (const double s :
         {length, length * (1 + 1e-9), length + 0.01, length * (1 - 1e-7), length - 1e-6, -0.01})
      for (const double rate : {0.0, 1e-3})
        for (const double stop_at : {kNoLimit, length, s + 1e-9}) {
          const Replan& replan = replanner.replan(
              {.s = s, .rate = rate, .payload_kg = motion.payload_kg(length), .stop_at = stop_at});
          ASSERT_GE(replan.profile->s.size(), 2u);
          EXPECT_TRUE(std::isfinite(replan.duration_s)) << s << " " << rate << " " << stop_at;
        }
  }
}

TEST(Replanner, FromTheStartItIsThePlan) {
  for (const PlannedPiece& piece : pieces(12, 8)) {
    Replanner replanner(piece.request, piece.plan);
    const PathMotion motion = path_motion(piece.request);
    Situation situation{.payload_kg = motion.payload_kg(0)};
    if (piece.request.time.mode == TimeMode::time_budget)
      situation.time_left_s = piece.request.time.duration_s;
    const Replan& again = replanner.replan(situation);
    EXPECT_EQ(again.status, ReplanStatus::optimal);
    const double planned_J = testing::exact_energy_J(motion, piece.plan);
    EXPECT_NEAR(testing::exact_energy_J(motion, *again.profile) / planned_J, 1, 2e-3);
    EXPECT_NEAR(again.energy_J / planned_J, 1, 3e-3);
  }
}

/// The optimum is that of the rest of the path, transcribed afresh from the model on four times the nodes.
TEST(Replanner, OffThePlanItIsWithinOnePercentOfTheOptimum) {
  int compared = 0;
  for (const PlannedPiece& piece : pieces(13, 8)) {
    Replanner replanner(piece.request, piece.plan);
    RandomSituations random(6);
    for (int i = 0; i < 6; ++i) {
      const Situation situation = random.next(piece);
      const ProfileRequest request = asked(piece, situation);
      const Judgment best = judge(request, situation.s);
      const Replan& replan = replanner.replan(situation);
      if (!best.energy_J) continue;
      ++compared;
      EXPECT_EQ(replan.status, ReplanStatus::optimal) << i;
      const double energy_J = testing::exact_energy_J(path_motion(request), *replan.profile);
      EXPECT_LT(energy_J, 1.01 * *best.energy_J);
      EXPECT_LE(replan.duration_s, situation.time_left_s * (1 + 1e-5));
    }
  }
  EXPECT_GT(compared, 20);
}

TEST(Replanner, KeepsTheDeadlineWheneverItCanBeKept) {
  const PlannedPiece piece = straight(8);
  Replanner replanner(piece.request, piece.plan);
  const ProfileState state = piece.plan.at_time(4);
  Situation situation{.s = state.s, .rate = state.rate, .payload_kg = 4};
  const double least_s = judge(asked(piece, situation), state.s).least_time_s;
  situation.time_left_s = 1.002 * least_s;
  EXPECT_EQ(replanner.replan(situation).status, ReplanStatus::optimal);
  situation.time_left_s = least_s - 0.5;
  const Replan& late = replanner.replan(situation);
  EXPECT_EQ(late.status, ReplanStatus::late);
  EXPECT_NEAR(late.late_s, 0.5, 0.01);
  EXPECT_NEAR(late.duration_s, least_s, 0.01);
}

TEST(Replanner, KeepsEveryLimitBetweenNodesToo) {
  for (const PlannedPiece& piece : pieces(14, 8)) {
    Replanner replanner(piece.request, piece.plan);
    RandomSituations random(7);
    for (int i = 0; i < 10; ++i) {
      const Situation situation = random.next(piece);
      const Replan& replan = replanner.replan(situation);
      if (replan.status == ReplanStatus::stopping || replan.above_cap_until > 0) continue;
      std::string_view which;
      EXPECT_LT(worst_use(asked(piece, situation), *replan.profile, &which), 1.01) << which;
    }
  }
}

TEST(Replanner, AnyBudgetGivesAProfileWithinLimitsAndInTime) {
  for (const PlannedPiece& piece : pieces(15, 8)) {
    RandomSituations random(8);
    for (int iterations = 0; iterations < 12; ++iterations) {
      Replanner replanner(piece.request, piece.plan);
      const Situation situation = random.next(piece);
      const Replan& replan = replanner.replan(situation, {.iterations = iterations});
      if (replan.status != ReplanStatus::feasible) continue;
      EXPECT_LE(replan.duration_s, situation.time_left_s * (1 + 1e-5));
      EXPECT_TRUE(std::isnan(replan.gap_percent));
      if (replan.above_cap_until > 0) continue;
      std::string_view which;
      EXPECT_LT(worst_use(asked(piece, situation), *replan.profile, &which), 1.01) << which;
    }
  }
}

TEST(Replanner, TheTimeBudgetEndsTheSearchAndNotTheProfile) {
  const PlannedPiece piece = straight(8);
  Replanner replanner(piece.request, piece.plan);
  const Situation situation{.s = 1, .rate = 0.2, .payload_kg = 4, .time_left_s = 20};
  const Replan& replan = replanner.replan(situation, {.cpu_s = 0});
  EXPECT_EQ(replan.status, ReplanStatus::feasible);
  EXPECT_EQ(replan.iterations, 0);
  EXPECT_LE(replan.duration_s, 20);
  EXPECT_NEAR(replan.profile->s.back(), 8, 1e-9);
}

TEST(Replanner, StandsBeforeABlockedStretch) {
  const PlannedPiece piece = straight(8);
  Replanner replanner(piece.request, piece.plan);
  const Replan& replan =
      replanner.replan({.s = 1, .rate = 0.5, .payload_kg = 4, .time_left_s = 20, .stop_at = 3});
  EXPECT_EQ(replan.status, ReplanStatus::optimal);
  EXPECT_NEAR(replan.profile->s.back(), 3, 1e-9);
  EXPECT_EQ(replan.profile->rate.back(), 0);
}

/// v^2/(2 d) = 1 m is needed where 0.4 m are left.
TEST(Replanner, BrakesAtTheLimitWhereItCannotStopInTime) {
  const PlannedPiece piece = straight(8);
  Replanner replanner(piece.request, piece.plan);
  const Replan& replan = replanner.replan({.s = 2, .rate = 1.0, .payload_kg = 4, .stop_at = 2.4});
  EXPECT_EQ(replan.status, ReplanStatus::stopping);
  EXPECT_NEAR(replan.profile->s.back(), 3.0, 2e-3);
  EXPECT_NEAR(replan.overrun, 0.6, 2e-3);
  EXPECT_EQ(replan.profile->rate.back(), 0);
  EXPECT_LT(worst_use(piece.request, *replan.profile), 1.001);
}

/// The robot may carry 12 kg. v^2/(2 d) = 0.25/(2 0.5) = 0.25 m.
TEST(Replanner, StopsWithAPayloadThatTheRobotMayNotCarry) {
  const PlannedPiece piece = straight(8);
  Replanner replanner(piece.request, piece.plan);
  EXPECT_EQ(replanner.replan({.s = 2, .rate = 0.5, .payload_kg = 12}).status, ReplanStatus::optimal);
  const Replan& replan = replanner.replan({.s = 2, .rate = 0.5, .payload_kg = 12.001, .time_left_s = 60});
  EXPECT_EQ(replan.status, ReplanStatus::stopping);
  EXPECT_EQ(replan.limit, "max_payload");
  EXPECT_NEAR(replan.profile->s.back(), 2.25, 2e-3);
  EXPECT_EQ(replan.profile->rate.back(), 0);
  EXPECT_EQ(replan.overrun, 0);
  EXPECT_EQ(replanner.replan({.s = 2.25, .rate = 0, .payload_kg = 40}).profile->s.back(), 2.25);
  EXPECT_EQ(replanner.replan({.s = 2.25, .rate = 0, .payload_kg = 4}).status, ReplanStatus::optimal);
}

/// From 0.8 to 0.3 m/s at 0.5 m/s^2: (0.64 - 0.09)/(2 0.5) = 0.55 m.
TEST(Replanner, BrakesToANewSpeedLimitThatHoldsAtOnce) {
  const PlannedPiece piece = straight(8);
  Replanner replanner(piece.request, piece.plan);
  const SpeedCap cap{0, 5, 0.3};
  const Replan& replan = replanner.replan({.s = 2, .rate = 0.8, .payload_kg = 4, .speed_caps = {&cap, 1}});
  EXPECT_EQ(replan.status, ReplanStatus::optimal);
  EXPECT_NEAR(replan.above_cap_until, 2.55, 0.1);
  EXPECT_LT(replan.profile->at_s(2.66).rate, 0.3 * (1 + 1e-6));
  EXPECT_LT(replan.profile->at_s(4.99).rate, 0.3 * (1 + 1e-6));
  EXPECT_LT(worst_use(piece.request, *replan.profile), 1.001);
}

TEST(Replanner, StandsStillWhereItIsBlockedAtRest) {
  const PlannedPiece piece = straight(8);
  Replanner replanner(piece.request, piece.plan);
  const Replan& replan = replanner.replan({.s = 2, .rate = 0, .payload_kg = 4, .stop_at = 2});
  EXPECT_EQ(replan.profile->at_time(1).rate, 0);
  EXPECT_NEAR(replan.profile->at_time(1).s, 2, 1e-4);
}

}  // namespace
}  // namespace joulepath
