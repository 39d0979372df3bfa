#include "tests/support/practice_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/result_files/decision_cost.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"
#include "tests/support/practice_truth.hpp"

namespace joulepath {
namespace {

/// Accuracy of plans on 80 nodes.
constexpr double kPlannersAccuracy_percent = 0.1;

struct Practice {
  std::string folder{};
  std::vector<std::string> effects{};  ///< empty: no name is allowed
  bool foreign{};
};

void PrintTo(const Practice& practice, std::ostream* out) { *out << practice.folder; }

/// A corrected robot file gives better plans on the labelled robot (its true constants and effect), by at
/// least half of the claimed saving; without a significant claim, plans must not get worse.
void expect_better_plans(const std::string& folder, const Robot& nominal, const Diagnosis& d) {
  if (!d.corrected_robot) return;
  const double claimed = decision_cost(nominal, *d.corrected_robot).joules_lost_percent;
  const Robot truth = testing::true_robot(nominal, testing::practice_file(folder, "truth.yaml"));
  const DecisionCost cost = decision_cost(nominal, *d.corrected_robot, truth);
  EXPECT_EQ(cost.missions, 4u);
  if (claimed > kPlannersAccuracy_percent)
    EXPECT_GT(cost.joules_lost_percent, 0.5 * claimed);
  else
    EXPECT_GT(cost.joules_lost_percent, -kPlannersAccuracy_percent);
}

class PracticeSet : public ::testing::TestWithParam<Practice> {};

TEST_P(PracticeSet, GetsTheRightVerdict) {
  const Practice& practice = GetParam();
  const Dataset dataset = read_dataset(testing::practice_file(practice.folder));
  const Diagnosis d = diagnose(dataset, {.bootstrap = 50});
  expect_better_plans(practice.folder, dataset.robot, d);
  if (practice.foreign) {
    EXPECT_TRUE(d.verdict == Verdict::unexplained || d.verdict == Verdict::partly_explained)
        << verdict_name(d.verdict);
    EXPECT_LE(d.gap.energy.after_percent, 1.05 * d.gap.energy.before_percent);
    return;
  }
  if (practice.effects.empty()) {
    EXPECT_EQ(d.verdict, Verdict::no_gap) << verdict_name(d.verdict);
    return;
  }
  for (const std::string& effect : practice.effects)
    EXPECT_TRUE(std::any_of(d.causes.begin(), d.causes.end(),
                            [&](const Cause& cause) {
                              return cause.effect.name == effect ||
                                     std::count(cause.indistinguishable_from.begin(),
                                                cause.indistinguishable_from.end(), effect) > 0;
                            }))
        << effect << " is not named; verdict " << verdict_name(d.verdict);
  EXPECT_EQ(d.causes.size(), practice.effects.size());
  const EnergyGap& energy = d.gap.energy;
  if (energy.before_percent > 2 + energy.noise_floor_percent) {
    EXPECT_LT(energy.after_percent - energy.noise_floor_percent,
              0.15 * (energy.before_percent - energy.noise_floor_percent));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Labeled, PracticeSet,
    ::testing::Values(Practice{"p01_null", {}}, Practice{"p02_null_rough", {}},
                      Practice{"p03_rolling_resistance", {"rolling_resistance"}},
                      Practice{"p04_dragging_wheel_rough", {"dragging_wheel"}},
                      Practice{"p05_floor_slope", {"floor_slope"}},
                      Practice{"p06_turning_scrub_rough", {"turning_scrub"}},
                      Practice{"p07_winding_heating_rough", {"winding_heating"}},
                      Practice{"p08_center_of_mass_offset", {"center_of_mass_offset"}},
                      Practice{"p09_track_width_error_rough", {"track_width_error"}},
                      Practice{"p10_time_misalignment", {"time_misalignment"}},
                      Practice{"p11_gear_efficiency_rough", {"gear_efficiency"}},
                      Practice{"p12_two_effects_rough", {"rolling_resistance", "current_sensor_offset"}},
                      Practice{"p13_foreign_rough", {}, true},
                      Practice{"p14_floor_patch_rough", {"floor_patch"}}),
    [](const ::testing::TestParamInfo<Practice>& practice) { return practice.param.folder; });

TEST(DiagnosisJson, HasTheKeysThatAreDocumented) {
  const nlohmann::json json = nlohmann::json::parse(diagnosis_json(Diagnosis{}));
  for (const char* key :
       {"schema", "gap", "where", "verdict", "causes", "ranking", "leftover", "next_experiment", "ceiling",
        "control", "pinned_combination", "artifacts", "missing_channels", "decisions", "validation"})
    EXPECT_TRUE(json.contains(key)) << key;
  for (const char* key : {"before_percent", "after_percent", "bias_before_percent", "noise_floor_percent",
                          "before_J", "after_J", "shrink_fraction", "shrink_interval_95"})
    EXPECT_TRUE(json["gap"]["energy"].contains(key)) << key;
  EXPECT_EQ(json["schema"], "joulepath/diagnosis/1");
}

TEST(Diagnosis, DoesNotDependOnTheOrderOfTheRunsAndRepeatsToTheByte) {
  Dataset dataset = read_dataset(testing::practice_file("p04_dragging_wheel_rough"));
  const Diagnosis first = diagnose(dataset, {.bootstrap = 20});
  EXPECT_EQ(diagnosis_json(first), diagnosis_json(diagnose(dataset, {.bootstrap = 20})));
  std::reverse(dataset.runs.begin(), dataset.runs.end());
  const Diagnosis reversed = diagnose(dataset, {.bootstrap = 20});
  ASSERT_EQ(first.causes.size(), reversed.causes.size());
  ASSERT_FALSE(first.causes.empty());
  EXPECT_EQ(first.causes[0].effect.name, reversed.causes[0].effect.name);
  EXPECT_NEAR(first.causes[0].parameters[0].value, reversed.causes[0].parameters[0].value, 1e-6);
}

TEST(Diagnosis, NeverNamesAnEffectRemovedFromTheCatalog) {
  using SetAndEffect = std::pair<const char*, const char*>;
  for (const auto& [folder, effect] : {SetAndEffect{"p14_floor_patch_rough", "floor_patch"},
                                       SetAndEffect{"p10_time_misalignment", "time_misalignment"}}) {
    const Diagnosis d =
        diagnose(read_dataset(testing::practice_file(folder)), {.bootstrap = 20, .without = {effect}});
    for (const Cause& cause : d.causes) {
      EXPECT_NE(cause.effect.name, effect);
      EXPECT_EQ(std::ranges::count(cause.indistinguishable_from, effect), 0) << effect;
    }
    for (const RankedEffect& ranked : d.ranking) EXPECT_NE(ranked.effect, effect);
  }
}

TEST(Diagnosis, OfTooFewRunsNamesNothing) {
  Dataset dataset = read_dataset(testing::practice_file("p03_rolling_resistance"));
  dataset.runs.resize(2);
  const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
  EXPECT_EQ(d.verdict, Verdict::too_little_data);
  EXPECT_TRUE(d.causes.empty());
  EXPECT_FALSE(d.where.empty());
  EXPECT_FALSE(d.ranking.empty());
}

}  // namespace
}  // namespace joulepath
