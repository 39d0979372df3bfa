// What a patch of a simulator's model may hold: only what shrinks the gap of the runs that judge it.
#include "extensions/simulators/proposed_effect.hpp"

#include <gtest/gtest.h>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

EffectSetting resistance(double fraction) {
  return {.name = "winding_resistance_error", .parameters = {{"fraction", fraction}}};
}
EffectSetting drag(Side side, double torque_Nm) {
  return {.name = "dragging_wheel", .parameters = {{"torque_Nm", torque_Nm}}, .side = side};
}

Diagnosis with_gap(double before_percent, double after_percent) {
  Diagnosis diagnosis{.causes = {{.effect = resistance(-0.09)}}};
  diagnosis.gap.energy = {.before_percent = before_percent, .after_percent = after_percent};
  return diagnosis;
}

std::optional<EffectSetting> first_of(const Diagnosis& diagnosis) {
  return proposed_effect(diagnosis.causes.front(), diagnosis);
}

TEST(ProposedEffect, IsNoneThatWidensTheGapOrLeavesItAsItIs) {
  EXPECT_FALSE(first_of(with_gap(8.2, 9.4)));
  EXPECT_FALSE(first_of(with_gap(8.2, 8.2)));
  EXPECT_TRUE(first_of(with_gap(8.2, 0.3)));
}

TEST(ProposedEffect, MayShrinkTheGapOfAnotherSignalWhereTheEnergyHardlyChanges) {
  Diagnosis diagnosis = with_gap(0.5, 0.51);
  diagnosis.gap.position_m = {.before_rms = 0.2, .after_rms = 0.02, .present = true};
  EXPECT_TRUE(first_of(diagnosis));
  diagnosis.gap.energy.after_percent = 1.5;
  EXPECT_FALSE(first_of(diagnosis));
}

/// The correction decides what is in the model, with its own size.
TEST(ProposedEffect, IsTheCorrectionsWhereThereIsOne) {
  Diagnosis diagnosis = with_gap(8.2, 0.3);
  diagnosis.causes.push_back({.effect = drag(Side::right, 0.2)});
  diagnosis.corrected_robot = testing::nomad();
  diagnosis.corrected_effects = {drag(Side::left, 0.7), drag(Side::right, 0.1)};
  EXPECT_FALSE(first_of(diagnosis)) << "the correction leaves it out";
  const auto kept = proposed_effect(diagnosis.causes.back(), diagnosis);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->side, Side::right);
  EXPECT_EQ(kept->parameters.at("torque_Nm"), 0.1);
  diagnosis.corrected_instruments = {resistance(0.6)};
  EXPECT_TRUE(first_of(diagnosis));
}

// The model has what its user set: a patch proposes what the correction adds.
TEST(ProposedEffect, IsNeverTheRobotFilesOwn) {
  Diagnosis diagnosis = with_gap(8.2, 0.3);
  diagnosis.causes.push_back({.effect = drag(Side::right, 0.2)});
  diagnosis.corrected_robot = testing::nomad();
  diagnosis.corrected_robot->effects = {drag(Side::right, 0.9), resistance(-0.09)};
  diagnosis.corrected_effects = {resistance(-0.09)};
  EXPECT_TRUE(first_of(diagnosis));
  EXPECT_FALSE(proposed_effect(diagnosis.causes.back(), diagnosis)) << "the correction leaves it as it is";
}

// The gap shrank by the instrument: a wheel that the correction leaves as it is stays so in the model.
TEST(ProposedEffect, IsNoneBesideACorrectionOfInstrumentsAlone) {
  Diagnosis diagnosis = with_gap(8.2, 0.3);
  diagnosis.causes = {{.effect = drag(Side::right, 0.2)}};
  diagnosis.corrected_instruments = {{.name = "current_sensor_gain", .parameters = {{"fraction", 0.1}}}};
  EXPECT_FALSE(first_of(diagnosis));
}

}  // namespace
}  // namespace joulepath
