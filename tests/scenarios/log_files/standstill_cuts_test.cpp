#include "scenarios/log_files/standstill_cuts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace joulepath {
namespace {

/// A log of drives of 30 s with stops of 2 s between them.
Run drives(int count) {
  Run run{.name = "day.csv", .start_time_s = 100.0};
  for (int i = 0; i < count * 320; ++i) {
    const double t = 0.1 * i, within = std::fmod(t, 32.0);
    run.log.time_s.push_back(t);
    run.log.payload_kg.push_back(t < 319.5 ? 0.0 : 5.0);
    for (Side side : kSides) run.log.wheel_speed_rad_s[side].push_back(within < 30 ? 3.0 : 0.01);
  }
  return run;
}

TEST(StandstillCuts, ALongLogBecomesRunsThatBeginAndEndAtRest) {
  std::vector<LogArtifact> artifacts;
  const auto parts = cut_at_standstill({drives(20)}, artifacts);
  ASSERT_EQ(parts.size(), 20u);
  ASSERT_EQ(artifacts.size(), 1u);
  EXPECT_EQ(artifacts[0].kind, "cut");
  std::size_t samples = 0;
  for (const auto& part : parts) {
    samples += part.log.size();
    EXPECT_EQ(part.log.payload_kg.front(), part.log.payload_kg.back());
  }
  EXPECT_EQ(samples, 20u * 320u);
  for (std::size_t k = 1; k < parts.size(); ++k) {
    EXPECT_LT(parts[k].log.wheel_speed_rad_s.left.front(), 0.1);
    EXPECT_DOUBLE_EQ(parts[k].log.time_s.front(), 0.0);
    const double within_stop_s = k == 10 ? 1.5 : 1.0;  // where the payload changes, else its middle
    EXPECT_NEAR(*parts[k].start_time_s, 98 + 32.0 * static_cast<double>(k) + within_stop_s, 0.2);
  }
}

TEST(StandstillCuts, TheNumberOfPartsIsBounded) {
  std::vector<LogArtifact> artifacts;
  EXPECT_LE(cut_at_standstill({drives(1000)}, artifacts).size(), 200u);
}

TEST(StandstillCuts, AShortLogAndOneWithAnEnergyOfTheWholeStayWhole) {
  std::vector<LogArtifact> artifacts;
  EXPECT_EQ(cut_at_standstill({drives(3)}, artifacts).size(), 1u);
  auto measured = drives(20);
  measured.battery_energy_Wh = 1.0;
  EXPECT_EQ(cut_at_standstill({measured}, artifacts).size(), 1u);
  EXPECT_TRUE(artifacts.empty());
}

}  // namespace
}  // namespace joulepath
