#include "extensions/bags/topic_samples.hpp"

#include <gtest/gtest.h>

#include <random>

namespace joulepath {
namespace {

constexpr std::uint64_t kEpoch_ns = 1'700'000'000'000'000'000;

TEST(LogTimes, AreThoseOfTheMessagesToTheLastBit) {
  const std::vector<std::uint64_t> times_ns{kEpoch_ns,
                                            kEpoch_ns + 10'000'001,
                                            kEpoch_ns - 5'000'000'000,
                                            kEpoch_ns - 5'000'000'000,
                                            kEpoch_ns - 5'000'000'000 + INT32_MAX,
                                            kEpoch_ns - 7'147'483'649,
                                            0,
                                            ~std::uint64_t{0},
                                            1};
  LogTimes times;
  for (const std::uint64_t time_ns : times_ns) times.add(time_ns);
  const std::vector<double> seconds = times.seconds();
  ASSERT_EQ(times.size(), times_ns.size());
  ASSERT_EQ(seconds.size(), times_ns.size());
  for (std::size_t i = 0; i < seconds.size(); ++i)
    EXPECT_EQ(seconds[i], 1e-9 * static_cast<double>(times_ns[i])) << i;
}

/// Messages whose stamps are before the log times by the lags.
TopicSamples with_lags(const std::vector<double>& lags_s) {
  TopicSamples samples{.name = "/odom", .columns = {"/odom.x"}, .values = {{}}, .stamped = true};
  for (std::size_t i = 0; i < lags_s.size(); ++i) {
    const std::uint64_t time_ns = kEpoch_ns + i * 1'000'000'000'000;
    samples.log_times.add(time_ns);
    samples.stamp_s.push_back(1e-9 * static_cast<double>(time_ns) - lags_s[i]);
    samples.values[0].push_back(static_cast<double>(i));
  }
  return samples;
}

TEST(TopicSamples, TheMedianLagDecidesWhichClockTheStampsAreOf) {
  std::mt19937 random(3);
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<double> lags_s;
    for (std::size_t i = 0; i < count; ++i) lags_s.push_back((i * 7 + random() % 3) % 5 < 2 ? 0.002 : 5.0);
    if (count % 3 == 0)
      for (double& lag_s : lags_s) lag_s = -lag_s;
    std::vector<double> sorted = lags_s;
    std::ranges::sort(sorted);
    const bool foreign = std::abs(sorted[count / 2]) > 1.0;
    std::vector<LogArtifact> artifacts;
    const CsvTable table = table_of_samples(with_lags(lags_s), "day.mcap", "day", artifacts);
    EXPECT_EQ(!artifacts.empty() && artifacts[0].kind == "other_clock", foreign) << count;
    EXPECT_EQ(table.rows(), count);
    EXPECT_EQ(table.columns[0][0] == 1e-9 * static_cast<double>(kEpoch_ns), foreign);
  }
}

}  // namespace
}  // namespace joulepath
