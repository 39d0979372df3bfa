#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "model/limit_table.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

TEST(Limits, EveryFieldHasOneRowAndEveryRowOneName) {
  std::set<std::string_view> names, keys;
  Limits limits;
  std::size_t fields = 0;
  for (const Limit& row : kLimits) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(keys.insert(row.key).second) << row.key;
    EXPECT_FALSE(row.unit.empty() || row.meaning.empty()) << row.name;
    EXPECT_NE(row.field == nullptr, row.rating == nullptr) << row.name;
    EXPECT_EQ(limit_named(row.name), &row);
    if (row.field == nullptr) continue;
    ++fields;
    EXPECT_TRUE(std::isinf(limits.*row.field)) << row.name << ": a field that another row has";
    limits.*row.field = 1.0;
  }
  EXPECT_EQ(fields * sizeof(double), sizeof(Limits)) << "a field without a row";
  EXPECT_EQ(limit_named("no such limit"), nullptr);
}

TEST(Limits, AZeroLimitIsUsedInfinitelyOrNotAtAll) {
  EXPECT_EQ(limit_fraction(0.0, 0.0), 0.0);
  EXPECT_EQ(limit_fraction(1e-13, 0.0), 0.0);
  EXPECT_TRUE(std::isinf(limit_fraction(-1e-3, 0.0)));
  EXPECT_EQ(limit_fraction(-3.0, 2.0), 1.5);
}

/// A row that names only its payload has the values outside of by_payload.
TEST(LimitsForPayload, AKeyThatARowLeavesOutHasItsBaseValueThere) {
  Robot robot = testing::nomad();
  robot.limits->acceleration_m_s2 = 0.5;
  robot.limits_by_payload = {{.payload_kg = 0},
                             {.payload_kg = 100, .limit_by_key = {{"acceleration_m_s2", 0.4}}}};
  EXPECT_EQ(limits_for_payload(robot, 0).acceleration_m_s2, 0.5);
  EXPECT_NEAR(limits_for_payload(robot, 25).acceleration_m_s2, 0.475, 1e-12);
  EXPECT_EQ(limits_for_payload(robot, 100).acceleration_m_s2, 0.4);
  EXPECT_EQ(limits_for_payload(robot, 300).acceleration_m_s2, 0.4) << "beyond the last row its value holds";
}

TEST(LimitsForPayload, RowsThatNameDifferentKeysDoNotMix) {
  Robot robot = testing::nomad();
  robot.limits->speed_m_s = 1.0;
  robot.limits->acceleration_m_s2 = 0.5;
  robot.limits_by_payload = {{.payload_kg = 10, .limit_by_key = {{"speed_m_s", 0.6}}},
                             {.payload_kg = 20, .limit_by_key = {{"acceleration_m_s2", 0.3}}}};
  const Limits at_10_kg = limits_for_payload(robot, 10), at_20_kg = limits_for_payload(robot, 20);
  EXPECT_EQ(at_10_kg.speed_m_s, 0.6);
  EXPECT_EQ(at_10_kg.acceleration_m_s2, 0.5);
  EXPECT_EQ(at_20_kg.speed_m_s, 1.0);
  EXPECT_EQ(at_20_kg.acceleration_m_s2, 0.3);
  EXPECT_NEAR(limits_for_payload(robot, 15).speed_m_s, 0.8, 1e-12);
  EXPECT_EQ(limits_for_payload(robot, 15).yaw_rate_rad_s, 2.0) << "no row names it";
}

TEST(LimitsForPayload, BetweenALimitAndNoneTheLimitHolds) {
  Robot robot = testing::nomad();
  robot.limits_by_payload = {{.payload_kg = 0},
                             {.payload_kg = 10, .limit_by_key = {{"battery_power_W", 60}}}};
  EXPECT_TRUE(std::isinf(limits_for_payload(robot, 0).battery_power_W));
  EXPECT_EQ(limits_for_payload(robot, 0.1).battery_power_W, 60);
  EXPECT_EQ(limits_for_payload(robot, 10).battery_power_W, 60);
}

TEST(LimitsForPayload, AChangingPayloadGetsTheLeastOfEveryLimitOnTheWay) {
  Robot robot = testing::nomad();
  for (const Limit& row : kLimits) {
    if (row.field == nullptr) continue;
    robot.limits = Limits{};
    (*robot.limits).*row.field = 3.0;
    robot.limits_by_payload = {{.payload_kg = 0},
                               {.payload_kg = 5, .limit_by_key = {{std::string(row.key), 1.0}}},
                               {.payload_kg = 10}};
    const double least = row.by_payload ? 1.0 : 3.0, at_8_kg = row.by_payload ? 2.2 : 3.0;
    EXPECT_NEAR(limits_between_payloads(robot, 0, 10).*row.field, least, 1e-12) << row.name;
    EXPECT_NEAR(limits_between_payloads(robot, 10, 0).*row.field, least, 1e-12) << row.name;
    EXPECT_NEAR(limits_between_payloads(robot, 8, 9).*row.field, at_8_kg, 1e-12) << row.name;
  }
}

}  // namespace
}  // namespace joulepath
