// Compares the laws of the effects with runs of a plant that shares no code with this project.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "diagnosis/estimation/estimate_dataset.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "tests/support/practice_sets.hpp"

namespace joulepath {
namespace {

/// The effects of a set's label.
std::vector<EffectSetting> labelled_effects(const std::string& set) {
  const Document truth = Document::load(testing::practice_file(set, "truth.yaml"));
  std::vector<EffectSetting> effects;
  for (const Node& item : truth.root()["effects"].items()) {
    EffectSetting setting;
    for (const auto& [key, value] : item.entries()) {
      if (key == "effect")
        setting.name = value.text();
      else if (key == "side")
        setting.side = value.text() == "left" ? Side::left : Side::right;
      else
        setting.parameters[key] = value.number();
    }
    effects.push_back(setting);
  }
  return effects;
}

TEST(IndependentPlant, LabelledEffectsCloseTheEnergyGap) {
  for (const char* set : {"p03_rolling_resistance", "p04_dragging_wheel_rough", "p05_floor_slope",
                          "p06_turning_scrub_rough", "p11_gear_efficiency_rough", "p14_floor_patch_rough"}) {
    Dataset dataset = read_dataset(testing::practice_file(set));
    dataset.robot.uncertainty.clear();  // no interval is needed
    const double before = estimate_dataset(dataset).model_error.value();
    dataset.robot.effects = labelled_effects(set);
    const double after = estimate_dataset(dataset).model_error.value();
    EXPECT_GT(before, 0.1) << set;
    EXPECT_LT(after, 0.03) << set;  // calibration errors of the plant, and its scatter where it is rough
    EXPECT_LT(after, before / 5) << set;
  }
}

TEST(IndependentPlant, NominalModelExplainsTheNullSet) {
  const DatasetEstimate all = estimate_dataset(read_dataset(testing::practice_file("p01_null")));
  EXPECT_EQ(all.compared, 12u);
  EXPECT_EQ(all.fitness, 1.0);
  EXPECT_LT(all.model_error.value(), 0.01);
}

}  // namespace
}  // namespace joulepath
