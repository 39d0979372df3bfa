// A payload that neither the dataset nor the log states is an unknown of its run, not 0 kg.
#include "diagnosis/evidence/unstated_payload.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "diagnosis/values/constant_payload.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "tests/support/blind_day.hpp"

namespace joulepath {
namespace {

void unstate(Run& run) {
  run.payload = {{0.0, 0.0}};
  run.payload_known = false;
  run.log.payload_kg.clear();
}

Dataset without_payloads(Dataset day) {
  for (Run& run : day.runs) unstate(run);
  return day;
}

class UnstatedPayload : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::have_blind_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  }
};

TEST_F(UnstatedPayload, IsEstimatedFromTheLog) {
  for (const char* effect : {"none", "rolling_resistance --size 0.012"}) {
    const Dataset day = testing::blind_day(std::string("--effect ") + effect + " --protocol 24 --seed 9");
    Dataset blank = without_payloads(day);
    blank.runs[1] = day.runs[1];
    const RunsByUse runs = with_estimated_payloads(sort_runs(blank));
    ASSERT_EQ(runs.diagnosis.estimated_payload_kg.size(), 23U);
    EXPECT_FALSE(runs.diagnosis.estimated_payload_kg.contains(1));
    double square = 0;
    for (const auto& [run, kg] : runs.diagnosis.estimated_payload_kg)
      square += std::pow(kg - constant_payload_kg(day.runs[run]), 2);
    EXPECT_LT(std::sqrt(square / 23), 1.0) << effect;  // friction that scatters looks like a rolling load
  }
}

TEST_F(UnstatedPayload, OfARobotThatCarriesNoneIsNone) {
  Dataset day = without_payloads(testing::blind_day("--effect none --protocol 6 --seed 9"));
  if (!day.robot.limits) day.robot.limits.emplace();
  day.robot.limits->max_payload_kg = 0;
  EXPECT_TRUE(with_estimated_payloads(sort_runs(day)).diagnosis.estimated_payload_kg.empty());
}

TEST_F(UnstatedPayload, NamesNothingInRunsWithoutAGap) {
  for (const int seed : {3, 4}) {
    const Diagnosis d =
        diagnose(without_payloads(testing::blind_day("none", 0, 0, 24, seed)), {.bootstrap = 20});
    EXPECT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict);
    EXPECT_TRUE(d.causes.empty()) << d.causes.front().effect.name;
    EXPECT_TRUE(d.unknowns.empty()) << d.unknowns.front().depends_on;
    EXPECT_FALSE(d.corrected_robot);
    EXPECT_TRUE(std::ranges::any_of(
        d.notes, [&](const std::string& note) { return note.find("payload_kg: ") != std::string::npos; }));
  }
}

TEST_F(UnstatedPayload, LeavesTheNameOfALawThatItCannotImitate) {
  const Diagnosis d = diagnose(without_payloads(testing::blind_day("rolling_resistance", 0.012, 0, 24, 31)),
                               {.bootstrap = 20});
  ASSERT_EQ(d.causes.size(), 1U) << verdict_name(d.verdict);
  const Cause& cause = d.causes.front();
  EXPECT_TRUE(cause.effect.name == "rolling_resistance" ||
              std::ranges::count(cause.indistinguishable_from, "rolling_resistance") > 0)
      << cause.effect.name;
}

}  // namespace
}  // namespace joulepath
