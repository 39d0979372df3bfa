#include "diagnosis/checks/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "diagnosis/values/diagnosis.hpp"
#include "diagnosis/verdict/verdict.hpp"
#include "tests/support/blind_day.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::nomad;
using testing::swinging;
using testing::synthetic_run;

/// Runs with currents and voltages, without pose, gyro, battery and time of day.
Dataset bare_day(const Robot& real, double yaw_swing_rad_s) {
  Dataset dataset{.robot = nomad()};
  for (unsigned seed = 1; seed <= 8; ++seed)
    dataset.runs.push_back(synthetic_run(real, "run_" + std::to_string(seed), 15, seed % 2 == 0 ? 5.0 : 0.0,
                                         swinging(0.3 + 0.05 * (seed % 4), 0.1, 1.0, yaw_swing_rad_s),
                                         {0.002, 0.005, 0.01}, seed));
  return dataset;
}

Survey survey_of(const Dataset& dataset) {
  std::vector<RunSignals> signals;
  for (const Run& run : dataset.runs) signals.push_back(make_run_signals(run, signals.size(), dataset.robot));
  return survey_dataset(dataset, signals);
}

TEST(Survey, ListsTheEffectsThatNoRunCanShow) {
  const Survey turning = survey_of(bare_day(nomad(), 0.4)), straight = survey_of(bare_day(nomad(), 0));
  for (const char* effect : {"wheel_slip", "wheel_radius_error", "floor_patch", "track_width_error",
                             "winding_heating", "supply_sag", "direction_dependent_friction"})
    EXPECT_TRUE(turning.invisible_effects.contains(effect)) << effect;
  for (const char* effect : {"turning_scrub", "caster_swivel", "rolling_resistance"})
    EXPECT_FALSE(turning.invisible_effects.contains(effect)) << effect;
  for (const char* effect : {"turning_scrub", "caster_swivel", "yaw_inertia_error"})
    EXPECT_TRUE(straight.invisible_effects.contains(effect)) << effect;
}

TEST(Survey, RunsInWhichNoWheelTurnsAreNoted) {
  const auto notes_them = [](const Dataset& dataset) {
    return std::ranges::any_of(survey_of(dataset).notes, [](const std::string& note) {
      return note.starts_with("no wheel turns in any run");
    });
  };
  Dataset dataset = bare_day(nomad(), 0.4);
  EXPECT_FALSE(notes_them(dataset));
  for (joulepath::Run& run : dataset.runs)
    for (const Side side : kSides) std::ranges::fill(run.log.wheel_speed_rad_s[side], 0.001);
  EXPECT_TRUE(notes_them(dataset));
}

/// Without turns it shows neither: a radius changes torques alone, as many effects do.
TEST(Survey, OneRunWithAGyroShowsTrackWidthAndRadius) {
  for (const double yaw_swing_rad_s : {0.0, 0.4}) {
    Dataset dataset = bare_day(nomad(), yaw_swing_rad_s);
    dataset.runs.front().log.gyro_yaw_rate_rad_s.assign(dataset.runs.front().log.size(), 0.0);
    const Survey survey = survey_of(dataset);
    for (const char* effect : {"track_width_error", "wheel_radius_error"})
      EXPECT_EQ(survey.invisible_effects.contains(effect), yaw_swing_rad_s == 0) << effect;
  }
}

/// The yaw rate of a gyro without a pose: larger wheels and a narrower track turn the body alike.
Dataset day_with_a_gyro(const Robot& real, unsigned first_seed, double noise_rad_s = 0.005) {
  Dataset dataset{.robot = nomad()};
  for (unsigned number = 0; number < 10; ++number) {
    const unsigned seed = first_seed + number;
    const double speed_m_s = (number % 3 == 2 ? -1 : 1) * (0.25 + 0.1 * (number % 4));
    const testing::MotionLaw law =
        swinging(speed_m_s, 0.15, 0.8 + 0.1 * (number % 5), number % 4 == 3 ? 0.0 : 0.6);
    joulepath::Run& run = dataset.runs.emplace_back(synthetic_run(real, "run_" + std::to_string(number), 15,
                                                                  number % 2 == 0 ? 8.0 : 0.0, law,
                                                                  {0.002, 0.005, 0.01}, seed));
    std::mt19937_64 random(1000 + seed);
    std::normal_distribution<double> noise(0, noise_rad_s);
    for (double t : run.log.time_s)
      run.log.gyro_yaw_rate_rad_s.push_back(law(t).yaw_rate_rad_s + noise(random));
  }
  return dataset;
}

TEST(GyroInTurns, NeverNamesTheTrackAloneForAWrongRadius) {
  for (const double factor : {1.02, 0.98, 1.04})
    for (const unsigned seed : {1U, 100U, 200U}) {
      Robot real = nomad();
      for (Side side : kSides) real.geometry.wheel_radius_m[side] *= factor;
      const Diagnosis d = diagnose(day_with_a_gyro(real, seed), {.bootstrap = 20});
      SCOPED_TRACE(std::to_string(factor) + ", seed " + std::to_string(seed) + ": " +
                   verdict_name(d.verdict));
      EXPECT_NE(d.verdict, Verdict::no_gap) << "the yaw rate is 2 % off";
      for (const Cause& cause : d.causes) {
        const auto& group = cause.indistinguishable_from;
        const bool holds_radius =
            cause.effect.name == "wheel_radius_error" || std::ranges::count(group, "wheel_radius_error") > 0;
        EXPECT_TRUE(holds_radius) << cause.effect.name;
      }
    }
}

TEST(GyroInTurns, TellsATrackAsOneOrInAGroup) {
  for (const unsigned seed : {1U, 100U}) {
    Robot real = nomad();
    real.geometry.half_track_m *= 0.96;
    const Diagnosis d = diagnose(day_with_a_gyro(real, seed), {.bootstrap = 20});
    ASSERT_EQ(d.causes.size(), 1U) << verdict_name(d.verdict);
    EXPECT_TRUE(d.causes.front().effect.name == "track_width_error" ||
                std::ranges::count(d.causes.front().indistinguishable_from, "track_width_error") > 0)
        << d.causes.front().effect.name;
  }
}

/// A track that is 40 % narrower changes the torques in turns, and no log here can tell it from other causes.
TEST(Survey, WhatNoRunCanShowIsNeitherNamedNorRanked) {
  Robot narrow = nomad();
  narrow.geometry.half_track_m *= 0.6;
  const Diagnosis d = diagnose(bare_day(narrow, 0.8), {.bootstrap = 20});
  EXPECT_NE(d.verdict, Verdict::no_gap) << "the turns take another torque";
  std::vector<std::string> said;
  for (const Cause& cause : d.causes) {
    said.push_back(cause.effect.name);
    said.insert(said.end(), cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  }
  for (const RankedEffect& entry : d.ranking) said.push_back(entry.effect);
  for (const char* effect : {"track_width_error", "wheel_radius_error", "wheel_slip"})
    EXPECT_EQ(std::ranges::count(said, effect), 0) << effect;
}

/// The yaw rate of straight runs is noise of the wheels and veering: no gap depends on it.
TEST(Survey, StraightRunsHaveNoCauseThatDependsOnTheYawRate) {
  if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const char* effect : {"none", "rolling_resistance --size 0.012", "gear_efficiency --size 0.11"}) {
    Dataset day = testing::blind_day(std::string("--effect ") + effect + " --protocol 24 --seed 31");
    std::erase_if(day.runs, [](const auto& run) {
      const std::vector<double>& gyro = run.log.gyro_yaw_rate_rad_s;
      return std::ranges::count_if(gyro, [](double rad_s) { return std::abs(rad_s) > 0.1; }) > 0;
    });
    ASSERT_GT(day.runs.size(), 8U);
    const Diagnosis d = diagnose(day, {.bootstrap = 20});
    EXPECT_TRUE(d.unknowns.empty()) << effect << ": " << d.unknowns.front().depends_on;
    EXPECT_NE(d.verdict, Verdict::partly_explained) << effect;
    EXPECT_NE(d.verdict, Verdict::unexplained) << effect;
  }
}

/// The search may find an unknown term in very few runs: it is no cause.
TEST(Verdict, OfTooFewRunsStatesNoCause) {
  const Dataset dataset;
  const RunsByUse runs{.few = true};
  const Identification id;
  const Names names{.unknowns = {{.depends_on = "wheel speed (current)", .probability = 0.9, .share = 0.8}}};
  const Judgment judgment = judge({.dataset = dataset, .runs = runs, .id = id}, names);
  EXPECT_EQ(judgment.verdict, Verdict::too_little_data);
  EXPECT_TRUE(judgment.unknowns.empty());
  EXPECT_EQ(judgment.depends_on, "");
}

}  // namespace
}  // namespace joulepath
