#include <gtest/gtest.h>

#include <filesystem>

#include "tests/app/program_result.hpp"

namespace joulepath {
namespace {

const std::string kNomadFile = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";

/// Nothing is planned for a model, and it is written only of a payload that the robot may carry.
TEST(SimulatorCommands, OptionsOfAPlanAreRefusedAndNoFileIsWritten) {
  const ScratchDirectory scratch;
  const std::string model = scratch.at("robot.xml");
  for (const std::string& option :
       {"--robot " + kNomadFile, std::string("--time 3"), std::string("--tolerance 0.1"),
        std::string("--payload 1e5"), std::string("--payload=-1")}) {
    const auto result =
        run_program(scratch, "export " + kNomadFile + " --to mjcf --out " + model + " " + option);
    EXPECT_EQ(result.code, 2) << option;
    EXPECT_NE(result.err.find(option.substr(0, 6)), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(model)) << option;
  }
  EXPECT_EQ(run_program(scratch, "export " + kNomadFile + " --to mjcf --payload 3 --out " + model).code, 0);
  EXPECT_TRUE(std::filesystem::exists(model));
}

TEST(SimulatorCommands, WheelsWithoutAFileAreRefused) {
  const ScratchDirectory scratch;
  const auto result = run_program(scratch, "init " + scratch.at("robot") + " --wheels a,b");
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("--wheels"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("--from"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(scratch.at("robot")));
}

TEST(SimulatorCommands, APatchIsMadeOfAModelAlone) {
  const ScratchDirectory scratch;
  const std::string day =
      " " JOULEPATH_SOURCE_DIR "/tests/data/practice/p04_dragging_wheel_rough/dataset.yaml";
  const auto diagnose = [&](const std::string& options) {
    return run_program(scratch, "diagnose" + day + " --out " + scratch.at("out") + " " + options);
  };
  const std::string model = scratch.at("robot.urdf");
  ASSERT_EQ(run_program(scratch, "export " + kNomadFile + " --to urdf --out " + model).code, 0);
  for (const auto& [options, told] :
       {std::pair<std::string, std::string>{"--wheels a,b", "--simulator-model"},
        {"--simulator-model " + kNomadFile, "XML"},
        {"--simulator-model " + model + " --wheels left_wheel_joint", "LEFT,RIGHT"},
        {"--simulator-model " + model + " --wheels a,b", "no joint a"}}) {
    const auto refused = diagnose(options);
    EXPECT_EQ(refused.code, 2) << options;
    EXPECT_NE(refused.err.find(told), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.at("out"))) << options;
  }
  const auto patched = diagnose("--simulator-model " + model);
  EXPECT_EQ(patched.code, 0) << patched.err;
  EXPECT_NE(patched.out.find("simulator's model, dragging_wheel (right): dry friction"), std::string::npos);
  EXPECT_NE(text_of(scratch.at("out/simulator_patch.diff")).find("+"), std::string::npos);
  EXPECT_NE(text_of(scratch.at("out/robot_patched.urdf")), text_of(model));
}

}  // namespace
}  // namespace joulepath
