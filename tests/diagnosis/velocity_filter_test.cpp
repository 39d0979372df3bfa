// Wheel speeds that a first-order filter smoothed before they were logged, against those of a late clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/velocity_filter_search.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/simulation/simulate.hpp"
#include "tests/support/nomad.hpp"

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
Dataset day_of_ramps(std::uint64_t seed, const std::vector<EffectSetting>& effects = {}) {
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
                                    .sensors = typical_sensors(),
                                    .seed = seed + r};
    day.runs.push_back(
        {.name = "ramps", .log = simulate(request).log, .payload = {{0, payload_kg}}, .payload_known = true});
  }
  return day;
}

LateSpeeds examined(const Dataset& day) {
  LogSet logs{.dataset = &day};
  for (std::size_t r = 0; r < day.runs.size(); ++r) logs.runs.push_back(r);
  return examine_late_speeds(logs);
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
    EXPECT_FALSE(examined(day).filter_fits_too) << samples << ": where the windings tell";
  }
  EXPECT_EQ(examined(day_of_ramps(3)).filter_s, 0);
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

bool doubts_the_delay(const Diagnosis& d) {
  return std::ranges::any_of(d.notes, [](const std::string& note) {
    return note.find("a clock offset and a filter of that time constant") != std::string::npos;
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

}  // namespace
}  // namespace joulepath
