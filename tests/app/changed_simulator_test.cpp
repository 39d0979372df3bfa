#include "app/diagnose/changed_simulator.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "app/diagnose/diagnosis_results.hpp"
#include "diagnosis/signals/velocity_filter.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

constexpr testing::LogNoise kSensorNoise{0.002, 0.005, 0.01};
constexpr double kFilter_s = 0.1;

Robot robot_with_rolling(double coefficient) {
  Robot robot = testing::nomad();
  if (coefficient != 0)
    robot.effects.push_back({.name = "rolling_resistance", .parameters = {{"coefficient", coefficient}}});
  return robot;
}

std::string log_of(const Robot& robot, unsigned number, unsigned seed) {
  const double kind = number % 4;
  return run_log_text(testing::synthetic_run(robot, "", 10, kind < 2 ? 0 : 10,
                                             testing::swinging(0.3 + 0.1 * kind, 0.1, 1, 0.2 * kind),
                                             kSensorNoise, seed)
                          .log);
}

/// Eight runs of a robot that rolls hard, and a simulator without that; its diagnosis. The changed
/// simulator's logs stand in `changed`, one that was not changed in `same`.
class AfterAChange : public ::testing::Test {
 protected:
  void SetUp() override {
    text_ = "schema: joulepath/dataset/1\nrobot: robot.yaml\nruns:\n";
    scratch_.write("robot.yaml", robot_text(testing::nomad()));
    for (unsigned number = 1; number <= 8; ++number) {
      const std::string name = "run_" + std::to_string(number) + ".csv";
      scratch_.write(name, log_of(robot_with_rolling(0.012), number, number));
      for (const char* folder : {"sim/", "same/"})
        scratch_.write(folder + name, log_of(testing::nomad(), number, 100 + number));
      scratch_.write("changed/" + name, log_of(robot_with_rolling(0.0115), number, 200 + number));
      text_ += "  - {file: " + name + ", predicted: sim/" + name + "}\n";
    }
    dataset_ = scratch_.write("dataset.yaml", text_);
    json_ = diagnosis_results(read_dataset(dataset_), {.bootstrap = 50}).json;
    first_ = scratch_.write("diagnosis.json", json_);
  }

  [[nodiscard]] ChangedSimulator after(const std::string& directory, const std::string& dataset) const {
    return changed_simulator(read_dataset(dataset), first_, scratch_.at(directory));
  }

  /// The message of the refusal; empty: none.
  [[nodiscard]] std::string refusal(const std::string& directory, const std::string& dataset) const {
    try {
      static_cast<void>(after(directory, dataset));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const ScratchDirectory scratch_{};
  std::string dataset_{}, first_{}, text_{}, json_{};
};

TEST_F(AfterAChange, TheGapShrinksBesideItsForecast) {
  const auto first = nlohmann::json::parse(json_);
  const auto json = nlohmann::json::parse(after("changed", dataset_).json);
  EXPECT_EQ(json["causes"], nlohmann::json({"rolling_resistance"}));
  EXPECT_EQ(json["forecast"]["shrink_fraction"], first["gap"]["energy"]["shrink_fraction"]);
  EXPECT_NEAR(json["gap"]["energy"]["before_percent"], first["gap"]["energy"]["before_percent"], 0.05);
  // 0.0115 of 0.012: a 24th of the gap remains.
  EXPECT_NEAR(json["gap"]["energy"]["shrink_fraction"], 1 - 1.0 / 24, 0.02);
  EXPECT_LT(json["gap"]["energy"]["shrink_interval_95"][0], 1 - 1.0 / 24);
  EXPECT_GT(json["gap"]["energy"]["shrink_interval_95"][1], 1 - 1.0 / 24);
  EXPECT_EQ(json["validation"]["runs"].size(), 8u);
}

TEST_F(AfterAChange, AnUnchangedSimulatorClosesNothing) {
  const auto json = nlohmann::json::parse(after("same", dataset_).json);
  EXPECT_EQ(json["gap"]["energy"]["shrink_fraction"], 0.0);
}

TEST_F(AfterAChange, OtherRunsAndOtherLogsAreRefused) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = text_;
    text.replace(text.find(from), from.size(), to);
    return scratch_.write("other.yaml", text);
  };
  const auto says = [](const std::string& refusal, const std::string& part) {
    return refusal.find(part) != std::string::npos;
  };
  EXPECT_TRUE(says(refusal("empty", dataset_), "runs[0].predicted: found no file"))
      << refusal("empty", dataset_);
  const std::string line = "  - {file: run_8.csv, predicted: sim/run_8.csv}\n";
  EXPECT_TRUE(says(refusal("changed", with(line, "")), "found \"run_8.csv\", which"));
  EXPECT_TRUE(says(refusal("changed", with("sim/run_8.csv", "changed/run_8.csv")),
                   "another content of the prediction of run_8.csv"));
  scratch_.write("run_8.csv", log_of(robot_with_rolling(0.012), 8, 77));
  EXPECT_TRUE(says(refusal("changed", dataset_), "found another content of run_8.csv"));
}

/// Eight runs whose speeds a filter smoothed before they were logged, and a simulator that is the robot but
/// for `rolling`: before a change, and after it without that.
ChangedSimulator behind_a_filter(const ScratchDirectory& scratch, double rolling) {
  std::string text = "schema: joulepath/dataset/1\nrobot: robot.yaml\nruns:\n";
  scratch.write("robot.yaml", robot_text(testing::nomad()));
  const auto turning = [](unsigned number) {
    return testing::swinging(0.1 * (number % 4), 0.2, 2, 0.6, 1.1 + 0.2 * (number % 3));
  };
  const auto drive = [&](double coefficient, unsigned number, unsigned seed) {
    return testing::synthetic_run(robot_with_rolling(coefficient), "", 12, number % 2 == 0 ? 0 : 10,
                                  turning(number), kSensorNoise, seed)
        .log;
  };
  for (unsigned number = 1; number <= 8; ++number) {
    Trajectory real = drive(0, number, number);
    for (Side side : kSides)
      real.wheel_speed_rad_s[side] =
          behind_velocity_filter(real.wheel_speed_rad_s[side], real.time_s, kFilter_s);
    const std::string name = "run_" + std::to_string(number) + ".csv";
    scratch.write(name, run_log_text(real));
    scratch.write("sim/" + name, run_log_text(drive(rolling, number, 100 + number)));
    scratch.write("changed/" + name, run_log_text(drive(0, number, 200 + number)));
    text += "  - {file: " + name + ", predicted: sim/" + name + "}\n";
  }
  const std::string dataset = scratch.write("dataset.yaml", text),
                    json = diagnosis_results(read_dataset(dataset), {.bootstrap = 20}).json,
                    first = scratch.write("diagnosis.json", json);
  EXPECT_NEAR(nlohmann::json::parse(json).value("velocity_filter_s", 0.0), kFilter_s, 0.2 * kFilter_s);
  return changed_simulator(read_dataset(dataset), first, scratch.at("changed"));
}

/// Where the simulator is exact, its gap is noise, whatever filter the robot's speeds are behind.
TEST(AfterAChangeBehindAFilter, AnExactSimulatorHasTheGapOfNoise) {
  for (const double rolling : {0.0, 0.012}) {
    const ScratchDirectory scratch;
    const auto energy = nlohmann::json::parse(behind_a_filter(scratch, rolling).json)["gap"]["energy"];
    EXPECT_LT(energy["after_percent"], 2 * double(energy["noise_floor_percent"]) + 0.1) << energy;
    if (rolling == 0) {
      EXPECT_LT(energy["before_percent"], 2 * double(energy["noise_floor_percent"]) + 0.1) << energy;
    }
  }
}

}  // namespace
}  // namespace joulepath
