#include "scenarios/diagnosis_sentence.hpp"

#include <gtest/gtest.h>

#include "scenarios/next_step.hpp"

namespace joulepath {
namespace {

Diagnosis with_gap(Verdict verdict, double before_percent, double after_percent) {
  Diagnosis d{.verdict = verdict};
  d.gap.energy.before_J = 100;
  d.gap.energy.before_percent = before_percent;
  d.gap.energy.after_percent = after_percent;
  d.gap.energy.noise_floor_percent = 0.1;
  return d;
}

Cause dragging(Side side) {
  return {.effect = {.name = "dragging_wheel", .side = side},
          .parameters = {{"torque_Nm", 0.2413, {0.22, 0.26}}}};
}

TEST(DiagnosisSentence, NamesTheCauseItsSizeAndWhatBecomesOfTheGap) {
  Diagnosis d = with_gap(Verdict::explained, 26.04, 0.302);
  d.causes = {dragging(Side::left)};
  EXPECT_EQ(diagnosis_sentence(d),
            "Explained: dragging wheel (left), 0.241 N m. The energy gap shrinks from 26 % to 0.302 % (noise "
            "floor 0.1 %).");
}

/// A wrong standby power is nothing of the motors': both gaps are stated.
TEST(DiagnosisSentence, StatesTheGapOfMotorsAndBattery) {
  Diagnosis d = with_gap(Verdict::explained, 0.716, 0.716);
  d.causes = {{.effect = {.name = "standby_power_error"}, .parameters = {{"power_W", 8.9, {8.8, 9.0}}}}};
  d.gap.battery_energy = with_gap(Verdict::explained, 16.8, 0.31).gap.energy;
  EXPECT_EQ(diagnosis_sentence(d),
            "Explained: standby power error, 8.9 W. The motors' energy gap is 0.716 % (noise floor 0.1 %). "
            "The battery's energy gap shrinks from 16.8 % to 0.31 % (noise floor 0.1 %).");
}

TEST(DiagnosisSentence, BeginsWithTheTitleOfItsVerdict) {
  for (std::size_t k = 0; k < kVerdicts.size(); ++k) {
    const std::string said = diagnosis_sentence({.verdict = static_cast<Verdict>(k)});
    EXPECT_EQ(said.rfind(std::string(kVerdicts[k].title) + ": ", 0), 0u) << said;
  }
}

TEST(DiagnosisSentence, SaysNoShrinkWhereThereIsNone) {
  Diagnosis d = with_gap(Verdict::explained, 1.2, 1.3);
  d.causes = {dragging(Side::right)};
  const std::string said = diagnosis_sentence(d);
  EXPECT_EQ(said.find("shrinks"), std::string::npos) << said;
  EXPECT_NE(said.find("The energy gap is 1.2 %"), std::string::npos) << said;
}

TEST(DiagnosisSentence, WithoutMeasuredEnergySaysNothingOfIt) {
  Diagnosis d{.verdict = Verdict::unexplained, .leftover_significant = true};
  d.leftover_description = "depends on heading (current)";
  EXPECT_EQ(
      diagnosis_sentence(d),
      "Unexplained: no effect of the catalog fits. What no effect explains depends on heading (current).");
}

/// An all-clear says how small a gap it has looked for, where more than one percent would have been missed.
TEST(DiagnosisSentence, OfAnAllClearSaysAboveWhichSize) {
  Diagnosis d = with_gap(Verdict::no_gap, 0.4, 0.4);
  d.gap.energy.detectable_percent = 2.34;
  EXPECT_EQ(diagnosis_sentence(d).rfind("No gap above 2.34 % of the energy: ", 0), 0u)
      << diagnosis_sentence(d);
  d.gap.energy.detectable_percent = 0.5;
  EXPECT_EQ(diagnosis_sentence(d).rfind("No gap: ", 0), 0u) << diagnosis_sentence(d);
  d = with_gap(Verdict::no_gap, 5.85, 5.85);  // which calibration errors explain
  d.gap.energy.detectable_percent = 3.65;
  EXPECT_EQ(diagnosis_sentence(d).rfind("No gap above 5.85 % of the energy: ", 0), 0u)
      << diagnosis_sentence(d);
}

TEST(DiagnosisSentence, OfAGroupNamesItsMembersAndOfASuspectChannelItsRun) {
  Diagnosis group = with_gap(Verdict::ambiguous, 4, 1);
  group.causes = {dragging(Side::left)};
  group.causes[0].indistinguishable_from = {"coulomb_friction", "rolling_resistance"};
  EXPECT_EQ(diagnosis_sentence(group).rfind("Ambiguous: these runs cannot tell dragging wheel (left), 0.241 "
                                            "N m from coulomb friction, rolling resistance.",
                                            0),
            0u)
      << diagnosis_sentence(group);
  const Diagnosis suspect{
      .verdict = Verdict::data_suspect,
      .data_checks = {{.run = "run_03.csv", .channel = "gyro_yaw_rate_rad_s", .kind = "inverted"}}};
  EXPECT_EQ(diagnosis_sentence(suspect),
            "Suspect data: gyro_yaw_rate_rad_s inverted in run_03.csv. Repair the dataset first.");
}

TEST(NextStep, OfEachVerdictIsASentence) {
  for (std::size_t k = 0; k < kVerdicts.size(); ++k) {
    const std::string step = next_step({.verdict = static_cast<Verdict>(k)});
    ASSERT_FALSE(step.empty()) << kVerdicts[k].name;
    EXPECT_EQ(step.back(), '.') << step;
    EXPECT_EQ(step.find("  "), std::string::npos) << step;
  }
}

TEST(NextStep, NamesCorrectedFilesOnlyWhereTheyAreWritten) {
  for (const Verdict verdict : {Verdict::explained, Verdict::partly_explained}) {
    Diagnosis d{.verdict = verdict};
    EXPECT_EQ(next_step(d).find("corrected files"), std::string::npos) << next_step(d);
    d.corrected_robot = Robot{};
    EXPECT_EQ(next_step(d).rfind("Plan with the corrected files.", 0), 0u) << next_step(d);
  }
}

TEST(NextStep, NamesTheQuantitiesThatUnknownCausesDependOn) {
  const Diagnosis d{.verdict = Verdict::unexplained,
                    .unknowns = {{.depends_on = "heading (current)"}, {.depends_on = "payload (torque)"}}};
  EXPECT_EQ(next_step(d),
            "Nothing is corrected. Examine the robot where the gap depends on heading (current), payload "
            "(torque).");
}

TEST(NextStep, OfAGroupIsTheProposedRunWhereThereIsOne) {
  Diagnosis d{.verdict = Verdict::ambiguous};
  EXPECT_EQ(next_step(d), next_step({.verdict = Verdict::too_little_data}));
  d.next.motions = {PrescribedMotion{}};
  d.next.payload_kg = {0.0};
  EXPECT_EQ(next_step(d), "Drive the proposed run.");
}

}  // namespace
}  // namespace joulepath
