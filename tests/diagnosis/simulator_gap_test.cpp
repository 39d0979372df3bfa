#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/correction/validation.hpp"
#include "diagnosis/prediction/prediction.hpp"
#include "diagnosis/simulator/simulated_runs.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/result_files/diagnosis_sentence.hpp"
#include "scenarios/result_files/next_step.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr testing::LogNoise kNoiseOfBoth{0.002, 0.005, 0.01};

/// Twelve motions: straight on and turning, slow and fast, forward and backward, empty and loaded.
testing::MotionLaw motion_of(unsigned number, double time_stretch = 1.0) {
  const double speed = (number % 3 == 2 ? -1 : 1) * (0.25 + 0.1 * (number % 4)), yaw = number % 2 ? 0.5 : 0.0;
  const testing::MotionLaw law = testing::swinging(speed, 0.15, 0.8 + 0.1 * (number % 5), yaw);
  return [=](double t) {
    BodyMotion<double> motion = law(t / time_stretch);
    motion.speed_m_s /= time_stretch, motion.yaw_rate_rad_s /= time_stretch;
    motion.acceleration_m_s2 /= time_stretch * time_stretch;
    motion.yaw_acceleration_rad_s2 /= time_stretch * time_stretch;
    return motion;
  };
}

Run driven(const Robot& robot, unsigned number, unsigned seed, double time_stretch = 1.0) {
  return testing::synthetic_run(robot, "run_" + std::to_string(number) + ".csv", 16 * time_stretch,
                                number % 4 < 2 ? 0 : 10, motion_of(number, time_stretch), kNoiseOfBoth, seed);
}

/// A day of `real` beside the logs of `simulated`, under the robot file `file`.
Dataset day_of(const Robot& file, const Robot& real, const Robot& simulated, double time_stretch = 1.0) {
  Dataset dataset{.robot = file};
  for (unsigned number = 0; number < 12; ++number) {
    dataset.runs.push_back(driven(real, number, 100 + number));
    dataset.runs.back().predicted = driven(simulated, number, 200 + number, time_stretch).log;
  }
  return dataset;
}

/// Friction 40 % off, half the file's winding, another mass: all constants are those of another robot.
Robot other_robot() {
  Robot robot = testing::nomad();
  for (Side side : kSides) {
    robot.motor[side].friction_torque_Nm *= 1.4;
    robot.motor[side].resistance_ohm *= 0.5;
    robot.motor[side].torque_constant_Nm_A *= 1.1, robot.motor[side].voltage_constant_V_s_rad *= 1.1;
  }
  robot.inertia.chassis_mass_kg *= 1.5;
  return robot;
}

Robot slightly_other_robot() {
  Robot robot = testing::nomad();
  for (Side side : kSides) {
    robot.motor[side].friction_torque_Nm *= 1.15;
    robot.motor[side].resistance_ohm *= 0.93;
  }
  return robot;
}

Robot with(Robot robot, EffectSetting effect) {
  robot.effects.push_back(std::move(effect));
  return robot;
}

const EffectSetting kMissingRolling{.name = "rolling_resistance", .parameters = {{"coefficient", 0.012}}};
const EffectSetting kMissingScrub{.name = "turning_scrub", .parameters = {{"moment_Nm", 0.8}}};

std::vector<std::string> names_of(const std::vector<Cause>& causes) {
  std::vector<std::string> names;
  for (const Cause& cause : causes) names.push_back(cause.effect.name);
  std::ranges::sort(names);
  return names;
}

TEST(SimulatorGap, IsNoneOfASimulatorThatIsTheRobotWhateverTheFileIs) {
  for (const Robot& plant : {slightly_other_robot(), with(other_robot(), kMissingRolling)}) {
    const Diagnosis d = diagnose(day_of(testing::nomad(), plant, plant), {.bootstrap = 20});
    EXPECT_EQ(d.verdict, Verdict::no_gap) << diagnosis_sentence(d);
    EXPECT_LT(d.simulator.gap_percent, 1) << diagnosis_sentence(d);
    EXPECT_EQ(next_step(d), "The simulator needs no correction.");
  }
}

TEST(SimulatorGap, IsWhatTheSimulatorLacksWhateverTheFileIs) {
  for (const Robot& plant : {slightly_other_robot(), other_robot()}) {
    const Diagnosis d =
        diagnose(day_of(testing::nomad(), with(plant, kMissingRolling), plant), {.bootstrap = 20});
    EXPECT_EQ(d.verdict, Verdict::explained) << diagnosis_sentence(d);
    ASSERT_EQ(names_of(d.causes), std::vector<std::string>{"rolling_resistance"}) << diagnosis_sentence(d);
    if (!d.simulator.is_another_robots) {
      EXPECT_NEAR(d.causes.front().parameters.front().value, 0.012, 0.0012);
    }
    EXPECT_GT(d.gap.energy.shrink_fraction, 0.85) << diagnosis_sentence(d);
  }
}

TEST(SimulatorGap, IsNotWhatTheSimulatorContains) {
  const Robot simulated = with(testing::nomad(), kMissingRolling), real = with(simulated, kMissingScrub);
  const Diagnosis d = diagnose(day_of(testing::nomad(), real, simulated), {.bootstrap = 20});
  EXPECT_EQ(names_of(d.simulator.contains), std::vector<std::string>{"rolling_resistance"});
  EXPECT_EQ(names_of(d.causes), std::vector<std::string>{"turning_scrub"}) << diagnosis_sentence(d);
  ASSERT_TRUE(d.corrected_robot);
  EXPECT_EQ(d.corrected_robot->effects.size(), 2u);
  ASSERT_EQ(d.corrected_effects.size(), 1u) << "what the correction adds";
  EXPECT_EQ(d.corrected_effects.front().name, "turning_scrub");
  EXPECT_EQ(d.corrected_robot->effects.back().probability, d.causes.front().probability);
  EXPECT_NE(diagnosis_sentence(d).find("the simulator contains rolling resistance"), std::string::npos)
      << diagnosis_sentence(d);
}

/// An effect of the file is the robot's for certain, even where a cause of its name adds to it.
TEST(CorrectedFile, StatesTheProbabilityOfWhatWasFoundAlone) {
  const EffectSetting half{.name = "rolling_resistance", .parameters = {{"coefficient", 0.006}}};
  const Robot file = with(testing::nomad(), half), real = with(testing::nomad(), kMissingRolling);
  const Diagnosis d = diagnose(day_of(file, real, file), {.bootstrap = 20});
  ASSERT_EQ(names_of(d.causes), std::vector<std::string>{"rolling_resistance"}) << diagnosis_sentence(d);
  ASSERT_TRUE(d.corrected_robot);
  ASSERT_EQ(d.corrected_robot->effects.size(), 2u);
  EXPECT_EQ(d.corrected_robot->effects[0].probability, 1.0);
  EXPECT_EQ(d.corrected_robot->effects[1].probability, d.causes.front().probability);
  EXPECT_LT(d.causes.front().probability, 1.0);
}

/// The robot's windings differ from the simulator's, and the best set holds a curve of voltage over current
/// beside the names. That curve is a resistance as well: it takes the gap and the name's evidence over,
/// unless it is left out where nothing reports it.
TEST(SimulatorGap, IsLeftToTheNamesAndNotToATermThatNothingReports) {
  const std::string curve = "current (voltage)";
  Robot real = with(other_robot(), {.name = "rolling_resistance", .parameters = {{"coefficient", 0.003}}});
  for (Side side : kSides) real.motor[side].resistance_ohm *= 0.45;
  const ComparedRuns compared = compare_runs(day_of(testing::nomad(), real, other_robot()), testing::nomad());
  const RunsByUse runs = sort_runs(compared.dataset);
  Identification id = identify(runs.diagnosis, {});
  const auto term = std::ranges::find(id.equations.unknowns, curve, &UnknownTerm::label);
  ASSERT_NE(term, id.equations.unknowns.end());
  id.explanations.front().unknowns = {static_cast<int>(term - id.equations.unknowns.begin())};
  const Examination x{.dataset = compared.dataset, .runs = runs, .id = id};
  Judgment judgment{.verdict = Verdict::explained, .named = id.state.effects, .sizes = {.greatest = 10}};
  std::erase_if(judgment.named, [](const ActiveEffect& effect) {
    const std::string label = effect.candidate.label();
    return label != "rolling_resistance" && label != "winding_resistance_error";
  });
  ASSERT_EQ(judgment.named.size(), 2u);
  const auto after_percent = [&](const Validation& v) { return held_out_gap(x, v, 20).energy.after_percent; };
  const Validation v = validate(x, judgment);
  EXPECT_EQ(verdict_name(v.judgment.verdict), verdict_name(Verdict::explained));
  EXPECT_EQ(v.judgment.named.size(), 2u);
  EXPECT_LT(after_percent(v), 1);
  judgment.unknowns = {{.depends_on = curve}};
  EXPECT_GT(after_percent(validate(x, judgment)), 2) << "a reported term keeps its part";
}

TEST(SimulatorGap, OfFortyPercentIsNotAllClear) {
  for (const double factor : {0.7, 1.4}) {
    Dataset dataset = day_of(testing::nomad(), testing::nomad(), testing::nomad());
    for (auto& run : dataset.runs)
      for (Side side : kSides)
        for (double& current_A : run.predicted->motor_current_A[side]) current_A *= factor;
    const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
    EXPECT_NE(d.verdict, Verdict::no_gap) << diagnosis_sentence(d);
    EXPECT_NEAR(d.simulator.bias_percent, 100 * (factor - 1), 2.0);
  }
}

/// A simulator that drives the same way in more time.
TEST(SimulatorGap, OfAnotherMotionIsAlignedByThePath) {
  const Robot plant = slightly_other_robot();
  const Diagnosis none = diagnose(day_of(testing::nomad(), plant, plant, 1.05), {.bootstrap = 20});
  EXPECT_EQ(none.verdict, Verdict::no_gap) << diagnosis_sentence(none);
  EXPECT_EQ(none.simulator.by_path, 12u);
  const Diagnosis d =
      diagnose(day_of(testing::nomad(), with(plant, kMissingRolling), plant, 1.05), {.bootstrap = 20});
  EXPECT_EQ(names_of(d.causes), std::vector<std::string>{"rolling_resistance"}) << diagnosis_sentence(d);
}

TEST(SimulatorGap, OfAChannelThatThePredictionLacksIsThatOfTheModel) {
  Dataset dataset = day_of(testing::nomad(), with(testing::nomad(), kMissingRolling), testing::nomad());
  for (auto& run : dataset.runs) run.predicted->motor_voltage_V = {};
  const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
  EXPECT_EQ(d.simulator.lacking_channels, std::vector<std::string>{"motor voltage"});
  EXPECT_EQ(names_of(d.causes), std::vector<std::string>{"rolling_resistance"}) << diagnosis_sentence(d);
}

TEST(SimulatorGap, LeavesOutRunsWithoutAPrediction) {
  Dataset dataset = day_of(testing::nomad(), testing::nomad(), testing::nomad());
  dataset.runs[3].predicted.reset();
  const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
  EXPECT_EQ(d.simulator.runs, 11u);
  EXPECT_EQ(d.simulator.of_runs, 12u);
  EXPECT_EQ(std::ranges::count(d.validation_runs, "run_3.csv"), 0);
}

TEST(SimulatorGap, RefusesAPredictionOfAnotherRun) {
  Dataset dataset = day_of(testing::nomad(), testing::nomad(), testing::nomad());
  dataset.runs[0].predicted = dataset.runs[2].predicted;
  EXPECT_THROW(static_cast<void>(diagnose(dataset)), ConfigError);
}

/// The control variate: an error that the model makes in both leaves nothing, to the noise.
TEST(SimulatorGap, DeviationOfTheSamePlantLeavesTheNoiseOfBoth) {
  const Dataset dataset = day_of(testing::nomad(), other_robot(), other_robot());
  const ComparedRuns compared = compare_runs(dataset, testing::nomad());
  for (std::size_t r = 0; r < compared.dataset.runs.size(); ++r) {
    const RunSignals run = make_run_signals(compared.dataset.runs[r], r, testing::nomad());
    const Prediction p = predict(run, {.robot = testing::nomad()});
    for (Side side : kSides) {
      EXPECT_LT((run.motor_current_A[side] - p.current_A[side]).cwiseAbs().maxCoeff(), 0.08) << r;
      EXPECT_LT((run.motor_voltage_V[side] - p.voltage_V[side]).cwiseAbs().maxCoeff(), 0.12) << r;
    }
  }
}

}  // namespace
}  // namespace joulepath
