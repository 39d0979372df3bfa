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

}  // namespace
}  // namespace joulepath
