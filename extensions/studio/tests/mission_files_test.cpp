#include "extensions/studio/server/mission_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scenarios/text/document.hpp"
#include "tests/support/locations.hpp"

namespace joulepath::studio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

/// A mission in a folder of its own; its robot in the folder, or beside it.
class MissionFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        fs::temp_directory_path() / ("joulepath_" + std::string(test->name()) + std::to_string(::getpid()));
    fs::create_directories(folder_ / "missions");
    nomad_ = read_text_file(std::string(JOULEPATH_SOURCE_DIR) + "/scenarios/robots/nomad_super_scout.yaml");
  }
  void TearDown() override { fs::remove_all(folder_); }

  MissionFiles files_with(const std::string& robot) {
    write((folder_ / "missions" / robot).string(), nomad_);
    write(mission(),
          "robot: " + robot +
              "  # ours\nlegs:\n  - {path: {bezier_m: [[[0, 0], [1, 0], [2, 0], [3, 1]]]}, payload_kg: 1}\n");
    return MissionFiles(mission(), [this](const std::string& file, const std::string& content) {
      written_.push_back(fs::path(file).filename().string());
      write(file, content);
    });
  }
  std::string mission() const { return (folder_ / "missions" / "round.yaml").string(); }

  fs::path folder_{};
  std::string nomad_{};
  std::vector<std::string> written_{};
};

TEST_F(MissionFolder, SavesOnlyWhatChanged) {
  MissionFiles files = files_with("robot.yaml");
  Json state = files.load();
  EXPECT_EQ(files.save(state)["base"], state["base"]);
  EXPECT_TRUE(written_.empty());
  state["mission"]["legs"][0]["payload_kg"] = 2.5;
  const Json saved = files.save(state);
  EXPECT_EQ(written_, std::vector<std::string>{"round.yaml"});
  EXPECT_NE(saved["base"]["mission"].get<std::string>().find("robot.yaml  # ours"), std::string::npos);
}

TEST_F(MissionFolder, ARobotOutsideOfTheFolderIsCopiedNotChanged) {
  MissionFiles files = files_with("../robot.yaml");
  Json state = files.load();
  state["robot"]["limits"]["speed_m_s"] = 0.75;
  const Json saved = files.save(state);
  EXPECT_EQ(read_text_file((folder_ / "robot.yaml").string()), nomad_);
  EXPECT_EQ(saved["mission"]["robot"], "round_robot.yaml");
  EXPECT_EQ(saved["robot"]["limits"]["speed_m_s"], 0.75);
  Json again = saved;
  again["robot"]["limits"]["speed_m_s"] = 0.5;
  EXPECT_EQ(files.save(again)["robot"]["limits"]["speed_m_s"], 0.5);
}

TEST_F(MissionFolder, AFileThatAnotherProgramChangedIsNotOverwritten) {
  MissionFiles files = files_with("robot.yaml");
  Json state = files.load();
  state["mission"]["legs"][0]["payload_kg"] = 2.5;
  write((folder_ / "missions" / "robot.yaml").string(), nomad_ + "# by hand\n");
  EXPECT_TRUE(files.save(state).contains("conflict"));
  write(mission(), state["base"]["mission"].get<std::string>() + "# by hand\n");
  EXPECT_TRUE(files.save(state).contains("conflict"));
  EXPECT_TRUE(written_.empty());
}

TEST_F(MissionFolder, ACopyOfAnotherMissionsRobotIsNotOverwritten) {
  MissionFiles files = files_with("../robot.yaml");
  write((folder_ / "missions" / "round_robot.yaml").string(), nomad_);
  Json state = files.load();
  state["robot"]["limits"]["speed_m_s"] = 0.75;
  EXPECT_TRUE(files.save(state).contains("conflict"));
  EXPECT_TRUE(written_.empty());
}

TEST_F(MissionFolder, ValuesThatNoReaderTakesAreRefusedBeforeAnythingIsWritten) {
  MissionFiles files = files_with("robot.yaml");
  Json state = files.load();
  state["robot"]["limits"]["speed_m_s"] = 0.75;
  state["mission"]["legs"][0]["payload_kg"] = -1;
  EXPECT_THROW(static_cast<void>(files.save(state)), ConfigError);
  EXPECT_TRUE(written_.empty());
}

TEST_F(MissionFolder, APageCannotNameOtherFiles) {
  MissionFiles files = files_with("robot.yaml");
  write((folder_ / "missions" / "other.yaml").string(), nomad_);
  for (const auto& [key, name] : {std::pair<const char*, Json>{"robot", "other.yaml"},
                                  {"robot", "gone.yaml"},
                                  {"map", "map.yaml"},
                                  {"speed_mask", {{"file", "mask.yaml"}}}}) {
    Json state = files.load();
    state["mission"][key] = name;
    EXPECT_THROW(static_cast<void>(files.save(state)), ConfigError) << key;
  }
  EXPECT_TRUE(written_.empty());
}

TEST_F(MissionFolder, WhatIsSavedIsWhatIsReadAgain) {
  for (const char* robot : {"robot.yaml", "../robot.yaml"}) {
    MissionFiles files = files_with(robot);
    Json state = files.load();
    state["robot"]["limits"]["speed_m_s"] = 0.75;
    state["mission"]["legs"][0]["payload_kg"] = 2.5;
    const Json saved = files.save(state);
    EXPECT_EQ(saved, files.load()) << robot;
  }
}

}  // namespace
}  // namespace joulepath::studio
