// Wheel speeds that a first-order filter smoothed before they were logged, against those of a late clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/delay_search.hpp"
#include "diagnosis/evidence/velocity_filter_search.hpp"
#include "diagnosis/prediction/prediction.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/simulation/simulate.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// T dy/dt = x - y by a thousand steps between samples, x linear between them.
void smooth_by(double time_constant_s, const std::vector<double>& time_s, std::vector<double>& channel) {
  const std::vector<double> sharp = channel;
  double y = sharp.front();
  for (std::size_t k = 1; k < sharp.size(); ++k) {
    constexpr int kSteps = 1000;
    const double step_s = (time_s[k] - time_s[k - 1]) / kSteps;
    for (int s = 0; s < kSteps; ++s)
      y += step_s / time_constant_s * (sharp[k - 1] + (s + 0.5) / kSteps * (sharp[k] - sharp[k - 1]) - y);
    channel[k] = y;
  }
}

void smooth_speeds(double time_constant_s, Dataset& day) {
  for (joulepath::Run& run : day.runs)
    for (Side side : kSides) smooth_by(time_constant_s, run.log.time_s, run.log.wheel_speed_rad_s[side]);
}

/// The electrical channels show what comes `samples` samples later: wheel speeds of a late clock.
void make_late(long samples, Dataset& day) {
  for (joulepath::Run& run : day.runs)
    for (Side side : kSides)
      for (auto* motor : {&run.log.motor_voltage_V, &run.log.motor_current_A}) {
        std::vector<double>& channel = (*motor)[side];
        std::rotate(channel.begin(), channel.begin() + samples, channel.end());
        std::fill(channel.end() - samples, channel.end(), *(channel.end() - samples - 1));
      }
}

/// Ramps of the speed between rests, there and back, then a turn: empty and loaded in turns.
Dataset day_of_ramps(std::uint64_t seed, const std::vector<EffectSetting>& effects = {},
                     const SensorSettings& sensors = typical_sensors()) {
  Dataset day{.robot = testing::nomad()};
  for (std::size_t r = 0; r < 12; ++r) {
    const double payload_kg = r % 2 == 0 ? 0.0 : 6.0;
    Trajectory reference;
    for (int k = 0; k <= 1400; ++k) {
      const double t = 0.01 * k, part_s = std::fmod(t, 3.5),
                   share = std::clamp(std::min(part_s - 0.5, 3.0 - part_s) / 0.8, 0.0, 1.0);
      reference.time_s.push_back(t);
      reference.linear_speed_m_s.push_back(t < 3.5 ? 0.5 * share : t < 7 ? -0.5 * share : 0.3 * share);
      reference.angular_speed_rad_s.push_back(t < 7 ? 0.0 : (t < 10.5 ? 0.6 : -0.6) * share);
    }
    const SimulationRequest request{.robot = day.robot,
                                    .effects = effects,
                                    .reference = reference,
                                    .payload_kg = payload_kg,
                                    .sensors = sensors,
                                    .seed = seed + r};
    day.runs.push_back(
        {.name = "ramps", .log = simulate(request).log, .payload = {{0, payload_kg}}, .payload_known = true});
  }
  return day;
}

/// Four runs at rest: encoders that count nothing, and readings about the voltage that holds.
void add_standing_runs(Dataset& day) {
  for (std::size_t r = 0; r < 4; ++r) {
    joulepath::Run& run = day.runs.emplace_back(day.runs[r]);
    run.name = "standing";
    for (Side side : kSides) {
      std::fill(run.log.wheel_speed_rad_s[side].begin(), run.log.wheel_speed_rad_s[side].end(), 0.0);
      for (std::size_t k = 0; k < run.log.size(); ++k) {
        run.log.motor_current_A[side][k] = 0.02 * std::cos(1.7 * static_cast<double>(k * k));
        run.log.motor_voltage_V[side][k] = 0.1 * std::sin(1.3 * static_cast<double>(k * k));
      }
    }
  }
}

void smooth_speeds_over_two(Dataset& day) {
  for (joulepath::Run& run : day.runs)
    for (Side side : kSides) {
      std::vector<double>& speed = run.log.wheel_speed_rad_s[side];
      for (std::size_t k = speed.size(); k-- > 1;) speed[k] = 0.5 * (speed[k] + speed[k - 1]);
    }
}

LateSpeeds examined(const Dataset& day) {
  LogSet logs{.dataset = &day};
  for (std::size_t r = 0; r < day.runs.size(); ++r) logs.runs.push_back(r);
  return examine_late_speeds(logs, std::min(0.0, rough_channel_delay_s(logs)));
}

TEST(VelocityFilter, IsToldFromADelayByTheSecondOrder) {
  for (const double time_constant_s : {0.05, 0.1}) {
    Dataset day = day_of_ramps(1);
    smooth_speeds(time_constant_s, day);
    EXPECT_NEAR(examined(day).filter_s / time_constant_s, 1, 0.2);
    for (Side side : kSides) day.robot.motor[side].resistance_ohm *= 1.5;
    EXPECT_NEAR(examined(day).filter_s / time_constant_s, 1, 0.2) << "the file's winding is wrong";
  }
  for (const long samples : {-3L, 2L, 5L}) {
    Dataset day = day_of_ramps(2);
    if (samples > 0)
      make_late(samples, day);
    else
      for (joulepath::Run& run : day.runs)
        for (Side side : kSides)
          std::rotate(run.log.wheel_speed_rad_s[side].begin(),
                      run.log.wheel_speed_rad_s[side].begin() - samples,
                      run.log.wheel_speed_rad_s[side].end());
    EXPECT_EQ(examined(day).filter_s, 0) << samples;
    EXPECT_FALSE(examined(day).undecided) << samples << ": where the windings tell";
  }
  EXPECT_EQ(examined(day_of_ramps(3)).filter_s, 0);
}

/// Noise of a coarse encoder, which the slope of the speeds has most of, makes both fit alike under a narrow
/// kernel.
TEST(VelocityFilter, IsToldBehindACoarseEncoder) {
  SensorSettings coarse = typical_sensors();
  coarse.encoder_counts_per_revolution = 512;
  Dataset day = day_of_ramps(6, {}, coarse);
  EXPECT_EQ(examined(day).filter_s, 0);
  smooth_speeds(0.06, day);
  EXPECT_NEAR(examined(day).filter_s / 0.06, 1, 0.2);
}

/// A delay beside speeds that are means over two samples: what runs at rest leave is no sign of a filter.
TEST(VelocityFilter, IsNotToldByRunsAtRest) {
  for (const long samples : {2L, 3L, 4L}) {
    Dataset day = day_of_ramps(2);
    make_late(samples, day);
    smooth_speeds_over_two(day);
    add_standing_runs(day);
    EXPECT_EQ(examined(day).filter_s, 0) << samples;
  }
}

/// A filter that fits far better than a delay, but is longer than any that is sought, is not as likely as
/// one.
TEST(VelocityFilter, IsNotPossibleWhereItIsTooLong) {
  Dataset day = day_of_ramps(2);
  smooth_speeds(0.4, day);
  EXPECT_EQ(examined(day).filter_s, 0);
  EXPECT_FALSE(examined(day).undecided);
}

/// A delay of half a step of the rough search, which finds none: exact logs tell it from a filter.
TEST(VelocityFilter, IsToldFromAShortDelay) {
  Dataset day = day_of_ramps(2, {}, {.sample_rate_Hz = 100});
  make_late(1, day);
  LogSet logs{.dataset = &day, .runs = {0, 1, 2, 3}};
  ASSERT_EQ(rough_channel_delay_s(logs), 0);
  const LateSpeeds late = examine_late_speeds(logs, 0);
  EXPECT_EQ(late.filter_s, 0);
  EXPECT_FALSE(late.undecided);
}

/// Root mean square of what the robot's own model leaves of the left current.
double current_left_A(const Dataset& day, double filter_s) {
  joulepath::Run run = day.runs.front();
  run.velocity_filter_s = filter_s;
  const RunSignals signals = make_run_signals(run, 0, day.robot);
  const Eigen::VectorXd left =
      signals.motor_current_A.left - predict(signals, {.robot = day.robot}).current_A.left;
  return std::sqrt(left.squaredNorm() / static_cast<double>(left.size()));
}

/// The filtered speed of a wheel that stopped still falls: dry friction acts while the wheel itself turns.
TEST(VelocityFilter, LeavesDryFrictionItsTimes) {
  const Dataset sharp = day_of_ramps(5);
  Dataset smooth = sharp;
  smooth_speeds(0.1, smooth);
  EXPECT_LT(current_left_A(smooth, 0.1), 1.2 * current_left_A(sharp, 0));
}

/// A filter is no property of the robot: no cause is named for it, and none is lost behind it.
TEST(VelocityFilter, BringsNoCauseAndHidesNone) {
  const EffectSetting rolling{.name = "rolling_resistance", .parameters = {{"coefficient", 0.008}}};
  for (const double time_constant_s : {0.05, 0.1}) {
    Dataset null = day_of_ramps(20);
    smooth_speeds(time_constant_s, null);
    const Diagnosis silent = diagnose(null);
    EXPECT_EQ(silent.verdict, Verdict::no_gap) << verdict_name(silent.verdict);
    EXPECT_TRUE(silent.causes.empty() && silent.unknowns.empty());
    EXPECT_NEAR(silent.velocity_filter_s / time_constant_s, 1, 0.2);
    Dataset heavy = day_of_ramps(40, {rolling});
    smooth_speeds(time_constant_s, heavy);
    const Diagnosis named = diagnose(heavy);
    ASSERT_EQ(named.causes.size(), 1u) << verdict_name(named.verdict);
    EXPECT_EQ(named.causes.front().effect.name, "rolling_resistance");
    EXPECT_NEAR(named.causes.front().parameters.front().value, 0.008, 0.0008);
  }
}

/// What remains behind a filter has its memory: rows of a narrower kernel repeat each other. A short run
/// keeps its rows.
TEST(VelocityFilter, WidensTheKernelToItself) {
  Dataset day = day_of_ramps(50);
  joulepath::Run& run = day.runs.front();
  const double usual_s = make_run_signals(run, 0, day.robot).kernel_sigma_s;
  run.velocity_filter_s = 0.2;
  EXPECT_EQ(make_run_signals(run, 0, day.robot).kernel_sigma_s, 0.2);
  EXPECT_LT(make_run_signals(run, 0, day.robot, {.kernel_sigma_s = 0.02}).kernel_sigma_s, 0.03)
      << "as little as the log allows";
  run.velocity_filter_s = 0.02;
  EXPECT_EQ(make_run_signals(run, 0, day.robot).kernel_sigma_s, usual_s);
  Dataset brief = day;
  brief.runs.front().log =
      testing::synthetic_run(day.robot, "brief", 0.9, 0, testing::swinging(0.5, 0.1, 2)).log;
  brief.runs.front().velocity_filter_s = 0.25;
  EXPECT_GT(make_run_signals(brief.runs.front(), 0, day.robot).size(), 2);
}

bool doubts_the_delay(const Diagnosis& d) {
  return std::ranges::any_of(d.notes, [](const std::string& note) {
    return note.find("whether by a clock offset or by a filter") != std::string::npos;
  });
}

/// A late clock stays one. Where accelerations follow the currents alone, both are told.
TEST(VelocityFilter, ADelayStaysOneAndADoubtIsTold) {
  Dataset day = day_of_ramps(60);
  make_late(3, day);
  const Diagnosis late = diagnose(day);
  ASSERT_EQ(late.causes.size(), 1u) << verdict_name(late.verdict);
  EXPECT_NEAR(late.causes.front().parameters.front().value, -0.06, 0.006);
  EXPECT_EQ(late.velocity_filter_s, 0);
  EXPECT_FALSE(doubts_the_delay(late));
  for (joulepath::Run& run : day.runs) run.log.motor_voltage_V = {};
  const Diagnosis doubted = diagnose(day);
  ASSERT_FALSE(doubted.causes.empty()) << verdict_name(doubted.verdict);
  EXPECT_TRUE(doubts_the_delay(doubted)) << "no winding tells either";
}

/// A simulator's speeds are sharp; the robot's filter is no gap of it.
TEST(VelocityFilter, OfTheRobotIsNoGapOfItsSimulator) {
  const EffectSetting rolling{.name = "rolling_resistance", .parameters = {{"coefficient", 0.008}}};
  for (const std::vector<EffectSetting>& effects : {std::vector<EffectSetting>{}, {rolling}}) {
    Dataset day = day_of_ramps(80, effects);
    smooth_speeds(0.1, day);
    const Dataset simulator = day_of_ramps(100);
    for (std::size_t r = 0; r < day.runs.size(); ++r) day.runs[r].predicted = simulator.runs[r].log;
    const Diagnosis d = diagnose(day);
    EXPECT_NEAR(d.velocity_filter_s, 0.1, 0.02);
    EXPECT_EQ(d.verdict, effects.empty() ? Verdict::no_gap : Verdict::explained) << verdict_name(d.verdict);
    EXPECT_TRUE(d.unknowns.empty());
    ASSERT_EQ(d.causes.size(), effects.size());
    if (effects.empty()) continue;
    EXPECT_EQ(d.causes.front().effect.name, "rolling_resistance");
    EXPECT_NEAR(d.causes.front().parameters.front().value, 0.008, 0.0008);
  }
}

}  // namespace
}  // namespace joulepath
