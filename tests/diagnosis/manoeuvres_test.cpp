// The library of manoeuvres: what each is for, seen in its motions.
#include "diagnosis/next_run/manoeuvres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/signals/manoeuvres.hpp"
#include "diagnosis/thresholds.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// The unloaded manoeuvre whose reason contains a word.
Manoeuvre manoeuvre_for(const std::string& word) {
  const std::vector<Manoeuvre> library = manoeuvre_library(testing::nomad());
  const auto found = std::ranges::find_if(
      library, [&](const Manoeuvre& m) { return m.why.find(word) != std::string::npos; });
  if (found == library.end()) throw std::runtime_error("no manoeuvre for " + word);
  return *found;
}

TEST(Manoeuvres, EachIsDrivenEmptyAndWithTheGreatestPayloadAndWithBoth) {
  const std::vector<Manoeuvre> library = manoeuvre_library(testing::nomad());
  const std::size_t third = library.size() / 3;
  ASSERT_EQ(library.size(), 3 * third);
  for (std::size_t k = 0; k < third; ++k) {
    const Manoeuvre &empty = library[k], &full = library[third + k], &both = library[2 * third + k];
    const std::size_t n = empty.motions.size();
    EXPECT_EQ(empty.loads, std::vector<double>(n, 0.0));
    EXPECT_EQ(full.loads, std::vector<double>(n, 1.0));
    EXPECT_EQ(full.why, empty.why);
    ASSERT_EQ(both.motions.size(), 2 * n + 1);
    ASSERT_EQ(both.loads.size(), 2 * n + 1);
    EXPECT_EQ(both.motions[n].profile, MotionProfile::stand) << "a payload changes at a standstill";
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(both.motions[i].speed_m_s, both.motions[n + 1 + i].speed_m_s);
      EXPECT_EQ(both.loads[i], 0.0);
      EXPECT_EQ(both.loads[n + 1 + i], 1.0);
    }
  }
}

/// What separates losses by direction is the same drive there and back.
TEST(Manoeuvres, WayBackDiffersInDirectionOnly) {
  for (const char* word : {"lane", "spins", "arcs"}) {
    const std::vector<PrescribedMotion> motions = manoeuvre_for(word).motions;
    ASSERT_EQ(motions.size(), 3u) << word;
    const PrescribedMotion &there = motions[0], &back = motions[2];
    EXPECT_EQ(there.speed_m_s, back.speed_m_s) << word;
    EXPECT_EQ(there.acceleration_m_s2, back.acceleration_m_s2) << word;
    EXPECT_EQ(there.distance_m, back.distance_m) << word;
    EXPECT_EQ(there.radius_m, back.radius_m) << word;
    EXPECT_EQ(there.yaw_rate_rad_s, back.yaw_rate_rad_s) << word;
    EXPECT_EQ(there.angle_rad.value_or(0.0), -back.angle_rad.value_or(0.0)) << word;
    EXPECT_TRUE(there.reverse != back.reverse || there.angle_rad) << word;
  }
}

/// Hard starts accelerate harder than every other manoeuvre, the fast run is faster and the crawl slower.
TEST(Manoeuvres, EachGoesToItsExtreme) {
  const auto most = [](const Manoeuvre& m, auto member) {
    double value = 0;
    for (const PrescribedMotion& motion : m.motions) value = std::max(value, (motion.*member).value_or(0.0));
    return value;
  };
  const auto acceleration = &PrescribedMotion::acceleration_m_s2;
  const auto speed = &PrescribedMotion::speed_m_s;
  const Manoeuvre hard = manoeuvre_for("hard"), fast = manoeuvre_for("fast"), crawl = manoeuvre_for("crawl");
  for (const Manoeuvre& other : manoeuvre_library(testing::nomad())) {
    EXPECT_TRUE(other.why == hard.why || most(other, acceleration) < most(hard, acceleration)) << other.why;
    EXPECT_TRUE(other.why == fast.why || most(other, speed) < most(fast, speed)) << other.why;
    EXPECT_TRUE(other.why == crawl.why || most(other, speed) == 0 ||
                most(other, speed) > 2 * most(crawl, speed))
        << other.why;
  }
}

/// One change each: slower, faster, longer, the other way where it goes one way, other loads.
TEST(Manoeuvres, VariantsChangeOneThing) {
  const Manoeuvre fast = manoeuvre_for("fast");
  const std::vector<Manoeuvre> variants = variants_of(fast);
  ASSERT_EQ(variants.size(), 6u);
  const PrescribedMotion& own = fast.motions[0];
  EXPECT_NEAR(*variants[0].motions[0].speed_m_s, 0.5 * *own.speed_m_s, 1e-12);
  EXPECT_NEAR(*variants[1].motions[0].speed_m_s, 1.5 * *own.speed_m_s, 1e-12);
  EXPECT_NEAR(*variants[2].motions[0].distance_m, 2 * *own.distance_m, 1e-12);
  EXPECT_NE(variants[3].motions[0].reverse, own.reverse);
  EXPECT_EQ(variants[4].loads, (std::vector<double>{0.5}));
  EXPECT_EQ(variants[5].loads, (std::vector<double>{1.0}));
  EXPECT_EQ(variants_of(manoeuvre_library(testing::nomad()).back()).size(), 3u) << "it has both loads";
  EXPECT_EQ(variants_of(manoeuvre_for("lane")).size(), 5u) << "it goes both ways already";
  EXPECT_NEAR(*variants_of(manoeuvre_for("standstill"))[2].motions[0].duration_s, 40, 1e-12);
}

/// An arc of radius r at speed v has lateral acceleration v^2/r, yaw rate v/r, yaw acceleration a/r.
TEST(Manoeuvres, AnArcIsWithinEachLimitOfTurning) {
  const std::vector<PrescribedMotion> arcs = manoeuvre_for("arcs").motions;
  const double r = *arcs[0].radius_m;
  const auto with = [&](Limits limits) { return within(limits, arcs[0]); };
  EXPECT_NEAR(*with({.lateral_acceleration_m_s2 = 0.1}).speed_m_s, std::sqrt(0.1 * r), 1e-12);
  EXPECT_NEAR(*with({.yaw_rate_rad_s = 0.2}).speed_m_s, 0.2 * r, 1e-12);
  EXPECT_NEAR(*with({.yaw_acceleration_rad_s2 = 0.05}).acceleration_m_s2, 0.05 * r, 1e-12);
  EXPECT_NEAR(*with({.deceleration_m_s2 = 0.07}).acceleration_m_s2, 0.07, 1e-12);
  EXPECT_EQ(with({}).speed_m_s, arcs[0].speed_m_s);
}

/// 5 and 5.5 rad/s are a straight drive, whatever its direction; 5 and 8 rad/s are a turn.
TEST(ManoeuvresOfRuns, CountTurnsByTheSizeOfTheSpeeds) {
  for (const double sign : {1.0, -1.0})
    for (const double right : {5.5, 8.0}) {
      RunSignals run;
      run.time_s = Eigen::VectorXd::LinSpaced(10, 0, 0.9);
      run.wheel_speed_rad_s = {Eigen::VectorXd::Constant(10, 5 * sign),
                               Eigen::VectorXd::Constant(10, right * sign)};
      const Manoeuvres share = manoeuvres_of({run});
      EXPECT_EQ(share.turning, right > 6 ? 1.0 : 0.0) << sign;
      EXPECT_EQ(share.reverse, sign < 0 ? 1.0 : 0.0);
      EXPECT_EQ(share.still, 0.0);
    }
}

/// A sudden turn is within 2 `half` windows: half a percent of a long run, 1.5 % of a shorter one.
TEST(ManoeuvresOfRuns, HaveYawFromAPercentOfTheSamples) {
  constexpr double kPeriod_s = 0.05;
  const auto half = std::max<Eigen::Index>(1, std::lround(kAccelerationWindow_s / kPeriod_s));
  for (const double share : {0.005, 0.015}) {
    const auto samples = static_cast<Eigen::Index>(2 * static_cast<double>(half) / share);
    RunSignals run;
    run.period_s = kPeriod_s;
    run.time_s = Eigen::VectorXd::LinSpaced(samples, 0, kPeriod_s * static_cast<double>(samples - 1));
    run.wheel_angle_rad = {Eigen::VectorXd::Zero(samples), Eigen::VectorXd::Zero(samples)};
    run.wheel_angle_rad.right.tail(samples / 2).setConstant(10.0);
    EXPECT_EQ(has_yaw({run}, testing::nomad().geometry), share > 0.01) << share;
  }
}

}  // namespace
}  // namespace joulepath
