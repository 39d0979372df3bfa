#include "scenarios/result_files/diagnosis_sentence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "scenarios/result_files/next_step.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"

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
          .probability = 0.97,
          .parameters = {{"torque_Nm", 0.2413, {0.22, 0.26}}}};
}

TEST(DiagnosisSentence, NamesTheCauseItsSizeAndWhatBecomesOfTheGap) {
  Diagnosis d = with_gap(Verdict::explained, 26.04, 0.302);
  d.causes = {dragging(Side::left)};
  EXPECT_EQ(
      diagnosis_sentence(d),
      "Explained: dragging wheel (left), 0.241 N m (probability 0.97). The energy gap shrinks from 26 % to "
      "0.302 % (noise floor 0.1 %).");
}

/// A wrong standby power is nothing of the motors': both gaps are stated.
TEST(DiagnosisSentence, StatesTheGapOfMotorsAndBattery) {
  Diagnosis d = with_gap(Verdict::explained, 0.716, 0.716);
  d.causes = {{.effect = {.name = "standby_power_error"},
               .probability = 0.97,
               .parameters = {{"power_W", 8.9, {8.8, 9.0}}}}};
  d.gap.battery_energy = with_gap(Verdict::explained, 16.8, 0.31).gap.energy;
  EXPECT_EQ(diagnosis_sentence(d),
            "Explained: standby power error, 8.9 W (probability 0.97). The energy gap at the motors is 0.716 "
            "% (noise floor 0.1 %). "
            "The energy gap at the battery shrinks from 16.8 % to 0.31 % (noise floor 0.1 %).");
}

TEST(DiagnosisSentence, BeginsWithTheTitleOfItsVerdict) {
  for (std::size_t k = 0; k < kVerdicts.size(); ++k) {
    const std::string said = diagnosis_sentence({.verdict = static_cast<Verdict>(k)});
    EXPECT_EQ(said.rfind(std::string(kVerdicts[k].title) + ": ", 0), 0u) << said;
  }
}

TEST(DiagnosisSentence, SaysNoShrinkWhereThereIsNone) {
  for (const double after_percent : {1.3, 1.15}) {
    Diagnosis d = with_gap(Verdict::explained, 1.2, after_percent);
    d.causes = {dragging(Side::right)};
    const std::string said = diagnosis_sentence(d);
    EXPECT_EQ(said.find("shrinks"), std::string::npos) << said;
    EXPECT_NE(said.find("The energy gap is 1.2 %"), std::string::npos) << said;
  }
}

TEST(DiagnosisSentence, SaysWhatBecomesOfThePose) {
  Diagnosis d = with_gap(Verdict::explained, 0.306, 0.288);
  d.causes = {dragging(Side::left)};
  d.gap.position_m = {.before_rms = 0.0684, .after_rms = 0.0121, .noise_floor_rms = 0.003, .present = true};
  EXPECT_NE(diagnosis_sentence(d).find("The position gap shrinks from 68.4 to 12.1 mm."), std::string::npos)
      << diagnosis_sentence(d);
  d.gap.position_m.noise_floor_rms = 0.1;
  EXPECT_EQ(diagnosis_sentence(d).find("position"), std::string::npos) << diagnosis_sentence(d);
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

/// What no size would show is null in the file, not a large number.
TEST(DiagnosisJson, ListsWhatShowsLate) {
  Diagnosis d = with_gap(Verdict::no_gap, 0.4, 0.4);
  d.gap.energy.hard_to_see = {{"coulomb_friction", 6.25},
                              {"supply_sag", std::numeric_limits<double>::infinity()}};
  const nlohmann::json hard = nlohmann::json::parse(diagnosis_json(d))["gap"]["energy"]["hard_to_see"];
  EXPECT_EQ(hard.at(0).at("effect"), "coulomb_friction");
  EXPECT_EQ(hard.at(0).at("detectable_percent"), 6.25);
  EXPECT_TRUE(hard.at(1).at("detectable_percent").is_null());
}

TEST(DiagnosisSentence, TellsTheFilterOfTheWheelSpeeds) {
  Diagnosis d = with_gap(Verdict::no_gap, 0.4, 0.4);
  EXPECT_FALSE(nlohmann::json::parse(diagnosis_json(d)).contains("velocity_filter_s"));
  EXPECT_EQ(diagnosis_sentence(d).find("filter"), std::string::npos);
  d.velocity_filter_s = 0.0801;
  EXPECT_NE(diagnosis_sentence(d).find(" The wheel speeds are behind a filter of 0.0801 s"),
            std::string::npos)
      << diagnosis_sentence(d);
  EXPECT_EQ(nlohmann::json::parse(diagnosis_json(d))["velocity_filter_s"], 0.0801);
}

TEST(DiagnosisSentence, OfAGroupNamesItsMembersAndOfASuspectChannelItsRun) {
  Diagnosis group = with_gap(Verdict::ambiguous, 4, 1);
  group.causes = {dragging(Side::left)};
  group.causes[0].indistinguishable_from = {"coulomb_friction", "rolling_resistance"};
  EXPECT_EQ(
      diagnosis_sentence(group).rfind("Ambiguous: these runs cannot tell dragging wheel (left), 0.241 "
                                      "N m (probability 0.97) from coulomb friction, rolling resistance.",
                                      0),
      0u)
      << diagnosis_sentence(group);
  const Diagnosis suspect{
      .verdict = Verdict::data_suspect,
      .data_checks = {{.run = "run_03.csv", .channel = "gyro_yaw_rate_rad_s", .kind = "inverted"}}};
  EXPECT_EQ(diagnosis_sentence(suspect),
            "Suspect data: gyro_yaw_rate_rad_s inverted in run_03.csv. Repair the dataset first.");
}

/// Currents that are 6.9 times too large in all runs: so they are beside a file of a robot with another
/// motor.
TEST(DiagnosisSentence, NamesTheOtherReadingOfAScaledDrive) {
  const auto sentence_of = [](const char* channel, const char* kind, const char* run) {
    return diagnosis_sentence(
        {.verdict = Verdict::data_suspect, .data_checks = {{.run = run, .channel = channel, .kind = kind}}});
  };
  const auto has_other_reading = [](const std::string& said) {
    return said.find("Another robot's file gives the same picture") != std::string::npos;
  };
  EXPECT_TRUE(has_other_reading(sentence_of("motor_current_left_A, motor_current_right_A", "scaled", "")));
  EXPECT_FALSE(has_other_reading(sentence_of("motor_current_left_A", "unit", "")));
  EXPECT_FALSE(has_other_reading(sentence_of("motor_current_left_A", "scaled", "run_2")));
  EXPECT_FALSE(has_other_reading(sentence_of("gyro_yaw_rate_rad_s", "scaled", "")));
  EXPECT_FALSE(has_other_reading(
      diagnosis_sentence({.verdict = Verdict::data_suspect,
                          .data_checks = {{.channel = "gyro_yaw_rate_rad_s", .kind = "scaled"},
                                          {.channel = "battery_current_A", .kind = "scaled"}}})))
      << "no constant of the robot tells a heading from a gyro";
}

TEST(DiagnosisSentence, AsksForTheRightRobotFile) {
  const DataCheck left{.run = "run_1", .channel = "motor_current_left_A", .kind = "scaled"},
      right{.run = "run_2", .channel = "motor_current_right_A", .kind = "scaled"};
  const auto begins = [](const std::string& question) {
    return question.starts_with("is r.yaml the right robot file? ");
  };
  EXPECT_EQ(right_robot_question("r.yaml", {}, {}), "");
  EXPECT_EQ(right_robot_question("r.yaml", {}, {left}), "");
  EXPECT_TRUE(begins(right_robot_question("r.yaml", {}, {left, right})));
  EXPECT_EQ(right_robot_question("r.yaml", {{"winding resistance", "ohm", 2.7, 0.5}}, {}),
            "is r.yaml the right robot file? The robot file does not describe this robot: winding resistance "
            "2.7 ohm in the file, 0.5 ohm in the runs.");
}

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// To three digits, as a sentence says it: an answer in a file rounds to six.
double as_said(double value) { return std::stod(digits(value)); }

/// Numbers of all orders, so that every branch is met.
struct RandomDiagnosis {
  std::mt19937_64 random;

  bool coin() { return random() % 2 == 0; }
  double fraction() { return as_said(std::uniform_real_distribution(0.0, 1.0)(random)); }
  double size() { return as_said(std::pow(10, std::uniform_real_distribution(-3.0, 2.0)(random))); }
  double after(double before) {
    return as_said(before * std::pow(10, std::uniform_real_distribution(-1.5, 0.3)(random)));
  }

  SignalGap signal() {
    const double before = as_said(0.01 * size());
    return {.before_rms = before,
            .after_rms = after(before),
            .noise_floor_rms = after(before),
            .present = coin()};
  }

  EnergyGap energy() {
    const double before = size();
    return {.before_percent = before,
            .after_percent = after(before),
            .noise_floor_percent = after(before),
            .before_J = coin() ? 10.0 : 0.0};
  }

  Diagnosis draw() {
    Diagnosis d{.verdict = static_cast<Verdict>(random() % kVerdicts.size())};
    d.gap.energy = energy();
    if (coin()) d.gap.battery_energy = energy();
    d.gap.energy.detectable_percent = size();
    d.gap.position_m = signal(), d.gap.heading_rad = signal();
    const bool names = d.verdict == Verdict::explained || d.verdict == Verdict::partly_explained ||
                       d.verdict == Verdict::ambiguous;
    for (std::size_t k = 0; names && k < 1 + random() % 3; ++k) {
      d.causes.push_back(dragging(k % 2 == 0 ? Side::left : Side::right));
      d.causes.back().probability = fraction();
      if (coin()) d.causes.back().indistinguishable_from = {"coulomb_friction", "rolling_resistance"};
    }
    d.leftover_significant = d.verdict == Verdict::partly_explained || d.verdict == Verdict::unexplained;
    d.leftover_description = d.leftover_significant ? "goes with payload" : "";
    if (d.leftover_significant && coin())
      d.unknowns = {{.depends_on = "speed (current)", .probability = 0.9, .share = fraction()}};
    if (d.verdict == Verdict::data_suspect)
      d.data_checks = {{.run = coin() ? "run_2" : "", .channel = "gyro_yaw_rate_rad_s", .kind = "inverted"}};
    if (d.verdict == Verdict::unexplained && random() % 4 == 0)
      d.foreign_constants = {{"winding resistance", "ohm", size(), size()}};
    if (coin()) d.below_materiality = {{"floor_patch", 0.97, 20, 0.4}};
    if (coin()) d.runs_apart = {{"run_3", as_said(100 * (fraction() - 0.5)), fraction()}};
    if (coin()) {
      d.simulator = {.runs = 3, .of_runs = 4, .gap_percent = size(), .contents = d.verdict};
      if (coin()) d.simulator.by_path = 2, d.simulator.by_time = 1;
      if (coin()) d.simulator.contains = d.causes, d.simulator.lacking_channels = {"gyro"};
    }
    return d;
  }
};

bool says(const std::string& sentence, const std::string& part) {
  return sentence.find(part) != std::string::npos;
}

/// A gap is said to shrink where causes are named and the numbers of the answer do so by a tenth and began
/// above their floor.
void expect_shrink(const std::string& said, const std::string& subject, bool named, double before,
                   double after, double floor, const std::string& numbers) {
  const bool shrinks = named && after <= 0.9 * before && before > floor;
  EXPECT_EQ(says(said, subject + " shrinks from " + numbers), shrinks) << said;
  EXPECT_EQ(says(said, subject + " shrinks"), shrinks) << said;
}

/// A gap of energy is told with its numbers where energy was measured, and not where it was not.
void expect_energy(const std::string& said, const std::string& subject, bool named,
                   const nlohmann::json& gap) {
  const double before = gap["before_percent"], after = gap["after_percent"];
  const bool measured = gap["before_J"] > 0;
  EXPECT_EQ(says(said, subject + " shrinks from ") || says(said, subject + " is " + digits(before) + " %"),
            measured)
      << said;
  if (measured)
    expect_shrink(said, subject, named, before, after, gap["noise_floor_percent"],
                  digits(before) + " % to " + digits(after) + " %");
}

void expect_motion(const std::string& said, const Diagnosis& d, const nlohmann::json& motion) {
  const bool named = !d.causes.empty();
  const SignalGap &position = d.gap.position_m, &heading = d.gap.heading_rad;
  if (motion.contains("before_rms_m"))
    expect_shrink(said, "position gap", named, motion["before_rms_m"], motion["after_rms_m"],
                  motion["noise_floor_rms_m"],
                  digits(1000 * position.before_rms) + " to " + digits(1000 * position.after_rms) + " mm");
  if (motion.contains("heading_before_rms_rad"))
    expect_shrink(said, "heading gap", named, motion["heading_before_rms_rad"],
                  motion["heading_after_rms_rad"], motion["heading_noise_floor_rms_rad"],
                  digits(heading.before_rms) + " to " + digits(heading.after_rms) + " rad");
}

/// Every cause of the answer is told with its probability, and whatever it is not told from.
void expect_causes(const std::string& said, const nlohmann::json& causes) {
  for (const auto& cause : causes) {
    EXPECT_TRUE(says(said, "dragging wheel (" + cause["parameters"]["side"]["value"].get<std::string>()))
        << said;
    EXPECT_TRUE(says(said, "(probability " + digits(cause["probability"]))) << said;
    for (const auto& other : cause["indistinguishable_from"])
      EXPECT_TRUE(says(said, other == "coulomb_friction" ? "coulomb friction" : "rolling resistance"))
          << said;
  }
}

/// What the simulator contains, how its runs are aligned, what it lacks and what it leaves out.
void expect_simulator(const std::string& said, const nlohmann::json& json) {
  const bool any = json.contains("simulator");
  EXPECT_EQ(says(said, "the simulator contains") || says(said, "The simulator contains"), any) << said;
  EXPECT_EQ(says(said, " 1 runs without a prediction are left out."), any) << said;
  if (!any) return;
  const nlohmann::json& simulator = json["simulator"];
  EXPECT_TRUE(says(said, simulator["sentence"])) << said;
  EXPECT_EQ(says(said, "aligned 2 by the path, 1 by the time."), simulator["aligned_by"]["path"] == 2)
      << said;
  EXPECT_EQ(says(said, "this program's model: gyro."), !simulator["lacking_channels"].empty()) << said;
}

TEST(DiagnosisSentence, FollowsFromTheNumbersOfItsAnswer) {
  RandomDiagnosis random{std::mt19937_64(5)};
  for (int k = 0; k < 1000; ++k) {
    const Diagnosis d = random.draw();
    const nlohmann::json json = nlohmann::json::parse(diagnosis_json(d));
    const std::string said = json["sentence"];
    EXPECT_EQ(says(said, "Left out: "), !json["runs_apart"].empty()) << said;
    for (const auto& apart : json["runs_apart"])
      EXPECT_TRUE(says(said, apart["run"].get<std::string>() + ", whose energy is " +
                                 digits(std::abs(apart["over_model_percent"].get<double>())) + " %"))
          << said;
    EXPECT_EQ(says(said, "too small to count"),
              d.verdict == Verdict::no_gap && !json["below_materiality"].empty())
        << said;
    expect_simulator(said, json);
    expect_causes(said, json["causes"]);
    for (const DataCheck& check : d.data_checks)
      EXPECT_TRUE(says(said, check.channel + " inverted" + (check.run.empty() ? "." : " in run_2."))) << said;
    for (const ForeignConstant& one : d.foreign_constants)
      EXPECT_TRUE(says(said, digits(one.in_file) + " ohm in the file, " + digits(one.in_runs) + " ohm"))
          << said;
    if (!d.data_checks.empty() || !d.foreign_constants.empty()) continue;
    const std::string of_motors =
        json["gap"].contains("battery_energy") ? "energy gap at the motors" : "energy gap";
    const std::string whose = json.contains("simulator") ? "The simulator's " : "The ";
    expect_energy(said, whose + of_motors, !d.causes.empty(), json["gap"]["energy"]);
    if (d.gap.battery_energy)
      expect_energy(said, whose + "energy gap at the battery", !d.causes.empty(),
                    json["gap"]["battery_energy"]);
    expect_motion(said, d, json["gap"]["motion"]);
    for (const auto& unknown : json["unknowns"])
      EXPECT_TRUE(says(said, digits(100 * unknown["share"].get<double>()) + " % of the explained gap"))
          << said;
  }
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
