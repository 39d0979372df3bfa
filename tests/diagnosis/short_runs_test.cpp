#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "diagnosis/checks/data_checks.hpp"
#include "diagnosis/checks/dead_channels.hpp"
#include "diagnosis/checks/plausible.hpp"
#include "diagnosis/checks/relations.hpp"
#include "diagnosis/checks/survey.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/config_error.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::nomad;
using testing::synthetic_run;

constexpr testing::LogNoise kLogNoise{0.002, 0.005, 0.01};

/// A drive from rest: it stands for `rest_s`, then starts, stops and turns smoothly.
Run drive(const std::string& name, double duration_s, double rest_s, unsigned seed, double period_s = 0.02) {
  const auto law = [=](double time_s) {
    const double t = std::max(0.0, time_s - rest_s);
    return BodyMotion<double>{.speed_m_s = 0.3 * (1 - std::cos(1.3 * t)),
                              .acceleration_m_s2 = 0.39 * std::sin(1.3 * t),
                              .yaw_rate_rad_s = 0.25 * (1 - std::cos(0.9 * t)),
                              .yaw_acceleration_rad_s2 = 0.225 * std::sin(0.9 * t)};
  };
  Run run = synthetic_run(nomad(), name, duration_s, 5.0, law, kLogNoise, seed, period_s);
  run.log.payload_kg.clear();
  run.log.battery_voltage_V.assign(run.log.size(), 24.8);
  for (std::size_t i = 0; i < run.log.size(); ++i) {
    double power_W = 10.0;
    for (const Side side : kSides)
      power_W += std::max(0.0, run.log.motor_voltage_V[side][i] * run.log.motor_current_A[side][i]);
    run.log.battery_current_A.push_back(std::round(power_W / 24.8 * 1e3) / 1e3);
  }
  return run;
}

Dataset sound_day(std::size_t runs) {
  Dataset dataset{.file = "day.yaml", .robot = nomad()};
  for (std::size_t r = 0; r < runs; ++r)
    dataset.runs.push_back(drive("run_" + std::to_string(r), 12, 1, static_cast<unsigned>(r) + 1));
  return dataset;
}

std::string described(const std::vector<DataCheck>& checks) {
  std::string text;
  for (const DataCheck& check : checks)
    text += check.run + " " + check.kind + " " + check.channel + ": " + check.evidence + "\n";
  return text;
}

/// Every usable log leaves a row, at any period and on any uneven clock.
TEST(ShortRuns, AUsableLogLeavesARow) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> jitter(0.2, 1.8);
  for (const double period_s : {0.001, 0.002, 0.005, 0.0125, 0.02, 0.1, 0.5})
    for (const bool uneven : {false, true})
      for (std::size_t samples = 40; samples < 700; samples += 7) {
        joulepath::Run run{.name = "a"};
        for (std::size_t i = 0; i < samples; ++i) {
          const double step_s = uneven ? period_s * jitter(random) : period_s;
          run.log.time_s.push_back(i == 0 ? 5.0 : run.log.time_s.back() + step_s);
          for (const Side side : kSides) run.log.wheel_speed_rad_s[side].push_back(1.0);
        }
        if (!has_usable_log(run)) continue;
        ASSERT_GT(make_run_signals(run, 0, nomad()).size(), 0)
            << samples << " samples each " << period_s << " s";
      }
}

/// Shorter than the kernel, with and without a battery: left out and said; the others are judged.
TEST(ShortRuns, AreLeftOutBesideGoodOnes) {
  for (const double length_s : {0.2, 0.3, 0.4, 0.44}) {
    Dataset dataset = sound_day(4);
    dataset.runs.push_back(drive("short", length_s, 0.1, 9, 0.005));
    dataset.runs.push_back(dataset.runs.back());
    dataset.runs.back().log.battery_current_A.clear();
    const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
    EXPECT_TRUE(found.empty()) << length_s << ": " << described(found);
    EXPECT_NE(short_runs_note(dataset).find("short, short: too short, left out"), std::string::npos)
        << short_runs_note(dataset);
  }
}

TEST(ShortRuns, AloneAreAnError) {
  for (const bool battery : {true, false}) {
    Dataset dataset{.file = "day.yaml", .robot = nomad(), .runs = {drive("short", 0.37, 0.1, 1, 0.005)}};
    dataset.runs[0].mark = {"day.yaml", 4, 5};
    if (!battery) dataset.runs[0].log.battery_current_A.clear();
    try {
      (void)diagnose(dataset);
      ADD_FAILURE() << "diagnosed";
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.detail().mark.line, 4);
      EXPECT_NE(error.detail().found.find("75 samples in 0.37 s"), std::string::npos) << error.what();
    }
  }
}

/// Rows as many as coefficients are explained exactly, whatever a channel is: no cut of a sound run is
/// suspect.
TEST(ShortRuns, NoCutOfASoundRunIsSuspect) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 12; ++trial) {
    Dataset dataset = sound_day(4);
    const double rest_s = 0.1 * static_cast<double>(random() % 12), length_s = 0.5 + 0.1 * trial;
    dataset.runs.push_back(drive("cut", length_s, rest_s, 100 + static_cast<unsigned>(trial)));
    const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
    EXPECT_TRUE(found.empty()) << length_s << " s, rest " << rest_s << " s: " << described(found);
  }
}

/// With fewer rows than ten and its coefficients a law is asked nothing.
TEST(ShortRuns, OfFewRowsHaveNoRelation) {
  for (const double length_s : {0.6, 0.8, 1.0}) {
    const RunSignals signals = make_run_signals(drive("short", length_s, 0.1, 5, 0.01), 0, nomad());
    ASSERT_GT(signals.size(), 0) << length_s;
    ASSERT_LE(signals.size(), 10) << length_s;
    for (const std::optional<Relation>& relation : relations_of(signals, nomad()))
      EXPECT_FALSE(relation) << relation->law << " of " << signals.size() << " rows";
  }
}

/// A coarse current sensor reads one value while the robot stands; a gyro may lock.
TEST(RunsAtRest, SayNothing) {
  for (const double length_s : {0.8, 3.0, 20.0}) {
    Dataset dataset = sound_day(4);
    joulepath::Run rest = drive("rest", length_s, 100, 7);
    for (const Side side : kSides) {
      for (double& current : rest.log.motor_current_A[side]) current = 0.08;
      for (double& voltage : rest.log.motor_voltage_V[side]) voltage = 0.3;
    }
    rest.log.battery_current_A.assign(rest.log.size(), 3.2);
    rest.log.gyro_yaw_rate_rad_s.assign(rest.log.size(), 0.0);
    dataset.runs.push_back(rest);
    const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
    EXPECT_TRUE(found.empty()) << length_s << ": " << described(found);
  }
}

bool names_the_clock(const Run& run) {
  return std::ranges::any_of(implausible_channels(run, nomad()),
                             [](const Implausible& found) { return found.channel == "time_s"; });
}

/// A clock in a smaller unit, from 0 or from 1970, at the rates of robots' loggers.
TEST(Clock, InAnotherUnitIsImplausible) {
  for (const double period_s : {0.001, 0.002, 0.01, 0.02, 0.05}) {
    const joulepath::Run sound = drive("a", 8, 1, 4, period_s);
    EXPECT_FALSE(names_the_clock(sound)) << period_s;
    for (const double unit : {1e3, 1e6, 1e9, 1e-3, 1e-6}) {
      joulepath::Run run = sound;
      for (double& time_s : run.log.time_s) time_s *= unit;
      EXPECT_TRUE(names_the_clock(run)) << period_s << " s times " << unit;
    }
    joulepath::Run since_1970 = sound;
    since_1970.clock_origin_s = 1.76e9;
    EXPECT_FALSE(names_the_clock(since_1970));
    since_1970.clock_origin_s = 1.76e12;
    EXPECT_TRUE(names_the_clock(since_1970));
  }
}

/// A repair of one run's clock is tried on the others, too, which it makes too short.
TEST(Clock, OfOneRunInMillisecondsIsNamedWithThatRun) {
  Dataset dataset = sound_day(5);
  for (double& time_s : dataset.runs[2].log.time_s) time_s *= 1e3;
  for (double& current_A : dataset.runs[0].log.motor_current_A.left) current_A *= -1;  // another broken run
  const std::vector<DataCheck> found = check_data(dataset, sort_runs(dataset));
  EXPECT_TRUE(std::ranges::any_of(found, [](const DataCheck& check) {
    return check.channel == "time_s" && check.run == "run_2";
  })) << described(found);
}

/// A minute with 30 samples is too short by its rate, not by its time.
TEST(ShortRuns, OfALongTimeAreToldTheirRate) {
  const auto hint = [](double duration_s, double period_s) -> std::string {
    Dataset dataset{.file = "day.yaml", .robot = nomad()};
    dataset.runs = {drive("slow", duration_s, 1, 1, period_s)};
    try {
      refuse_short_runs(dataset);
    } catch (const ConfigError& error) {
      return error.detail().hint;
    }
    return "accepted";
  };
  EXPECT_NE(hint(30, 1.0).find("samples a second are too few: record at 20 to 100 Hz"), std::string::npos);
  EXPECT_EQ(hint(0.4, 0.02).find("samples a second"), std::string::npos);
}

/// Slow logs of sound robots: a sample each ten or thirty seconds, a drive without a stop, a slow start.
TEST(Clock, OfASlowLogIsPlausible) {
  for (const double period_s : {1.0, 10.0, 30.0}) {
    joulepath::Run run{.name = "telemetry"};
    for (int i = 0; i < 200; ++i) {
      run.log.time_s.push_back(period_s * i);
      for (const Side side : kSides) run.log.wheel_speed_rad_s[side].push_back(i / 8 % 2 == 0 ? 0.0 : 5.0);
    }
    EXPECT_FALSE(names_the_clock(run)) << period_s;
  }
  const auto creeps_first = [](double t) {
    const double speed_m_s = t < 5     ? 0.0
                             : t < 205 ? std::min(0.2, 0.2 * (t - 5))
                                       : std::min(0.9, 0.2 + 0.3 * (t - 205));
    return BodyMotion<double>{.speed_m_s = speed_m_s};
  };
  EXPECT_FALSE(names_the_clock(synthetic_run(nomad(), "creeps first", 240, 0, creeps_first, kLogNoise)));
  EXPECT_FALSE(
      names_the_clock(synthetic_run(nomad(), "steady", 600, 0, testing::constant_speed(0.4), kLogNoise)));
}

}  // namespace
}  // namespace joulepath
