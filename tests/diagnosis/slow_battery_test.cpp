// A battery monitor that reads once a second beside a driver that reads every sample: its readings hold, are
// means since the reading before, or are drawn as lines between readings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/limit_table.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

using testing::blind_day;
using testing::have_blind_plant;

enum class Monitor { holds, averages, drawn_as_lines };

std::vector<double> read_slowly(const std::vector<double>& channel, std::size_t every, Monitor monitor) {
  std::vector<double> slow(channel.size());
  const auto at = [&](std::size_t i) { return channel[std::min(i, channel.size() - 1)]; };
  for (std::size_t i = 0; i < slow.size(); ++i) {
    const std::size_t from = i / every * every;
    const double share = static_cast<double>(i - from) / static_cast<double>(every);
    if (monitor == Monitor::holds) slow[i] = channel[from];
    if (monitor == Monitor::drawn_as_lines) slow[i] = (1 - share) * at(from) + share * at(from + every);
    if (monitor == Monitor::averages) {
      const auto first = channel.begin() + static_cast<std::ptrdiff_t>(from < every ? 0 : from - every);
      const auto last = channel.begin() + static_cast<std::ptrdiff_t>(from);
      slow[i] = first == last ? channel[0] : std::accumulate(first, last, 0.0) / double(last - first);
    }
  }
  return slow;
}

Dataset with_slow_monitor(Dataset dataset, double period_s, Monitor monitor) {
  for (joulepath::Run& run : dataset.runs) {
    Trajectory& log = run.log;
    const auto every = static_cast<std::size_t>(std::lround(period_s / (log.time_s[1] - log.time_s[0])));
    log.battery_current_A = read_slowly(log.battery_current_A, every, monitor);
    log.battery_voltage_V = read_slowly(log.battery_voltage_V, every, monitor);
  }
  return dataset;
}

constexpr std::array kMonitors{Monitor::holds, Monitor::averages, Monitor::drawn_as_lines};

TEST(SlowBatteryMonitor, IsNoGap) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset day = blind_day("none", 0, 0, 12, 31);
  for (const double period_s : {0.5, 1.0, 2.0})
    for (const Monitor monitor : kMonitors) {
      const Diagnosis d = diagnose(with_slow_monitor(day, period_s, monitor), {.bootstrap = 0});
      EXPECT_EQ(d.verdict, Verdict::no_gap)
          << verdict_name(d.verdict) << ' ' << period_s << " s, monitor " << static_cast<int>(monitor);
    }
}

/// Readings whose stamps are not the log's, drawn as lines between: each bends two samples.
TEST(SlowBatteryMonitor, OfAnotherClockIsNoGap) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = blind_day("none", 0, 0, 12, 33);
  for (joulepath::Run& run : dataset.runs) {
    std::vector<double> at_s;
    for (double t = run.log.time_s.front(); t < run.log.time_s.back(); t += 0.973) at_s.push_back(t);
    for (std::vector<double>* channel : {&run.log.battery_current_A, &run.log.battery_voltage_V})
      *channel = interpolate(at_s, interpolate(run.log.time_s, *channel, at_s), run.log.time_s);
  }
  EXPECT_GT(make_run_signals(dataset.runs[0], 0, dataset.robot).reading_period_s.battery_s, 0.9);
  const Diagnosis d = diagnose(dataset, {.bootstrap = 0});
  EXPECT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict);
}

/// Five readings a second, each the mean of the last fifth: a tenth late where it changes. Two orders of that
/// delay left something unexplained on such days of a robot of 150 kg.
TEST(SlowBatteryMonitor, OfMeansIsNoGap) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  for (const double period_s : {0.1, 0.14, 0.2})
    for (const char* seed : {"2", "3", "4"}) {
      const Dataset day =
          blind_day(std::string("--effect none --robot warehouse --level 0 --protocol 24 --seed ") + seed);
      const Diagnosis d = diagnose(with_slow_monitor(day, period_s, Monitor::averages), {.bootstrap = 0});
      EXPECT_EQ(d.verdict, Verdict::no_gap)
          << verdict_name(d.verdict) << ", " << period_s << " s, seed " << seed;
    }
}

TEST(SlowBatteryMonitor, ShowsAStandbyPower) {
  if (!have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset day = blind_day("standby_power_error", 3.0, 0, 12, 32);
  for (const Monitor monitor : kMonitors) {
    const Diagnosis d = diagnose(with_slow_monitor(day, 1.0, monitor), {.bootstrap = 0});
    ASSERT_EQ(d.causes.size(), 1u) << verdict_name(d.verdict) << ", monitor " << static_cast<int>(monitor);
    EXPECT_EQ(d.causes[0].effect.name, "standby_power_error");
    EXPECT_NEAR(d.causes[0].parameters[0].value, 3.0, 0.3);
  }
}

}  // namespace
}  // namespace joulepath
