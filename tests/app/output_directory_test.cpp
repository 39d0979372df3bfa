#include "app/output_directory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/command.hpp"
#include "app/terminal.hpp"
#include "model/config_error.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

std::string content(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t entries(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(OutputDirectory, NothingIsThereBeforeCommitAndAllOfItAfter) {
  const ScratchDirectory scratch;
  OutputDirectory out(scratch.at("deep/out/"), {"a.json", "b.csv"}, false);
  out.write("a.json", "{}");
  EXPECT_FALSE(fs::exists(scratch.at("deep")));
  out.commit();
  EXPECT_EQ(content(scratch.at("deep/out/a.json")), "{}");
  EXPECT_EQ(entries(scratch.at("deep")), 1u) << "a temporary directory stays behind";
}

TEST(OutputDirectory, ExistingResultsAreKeptWithoutForce) {
  const ScratchDirectory scratch;
  scratch.write("out/a.json", "old");
  EXPECT_THROW(OutputDirectory(scratch.at("out"), {"a.json"}, false), ConfigError);
  EXPECT_NO_THROW(OutputDirectory(scratch.at("out"), {"other.json"}, false));
  EXPECT_THROW(OutputDirectory(scratch.at("out/a.json"), {"a.json"}, true), ConfigError)
      << "a file is no directory";
}

TEST(OutputDirectory, ForceReplacesOurFilesRemovesStaleOnesAndLeavesStrangersAlone) {
  const ScratchDirectory scratch;
  scratch.write("out/plan.json", "old");
  scratch.write("out/trajectory.csv", "old");
  scratch.write("out/notes.txt", "mine");
  OutputDirectory out(scratch.at("out"), {"plan.json", "trajectory.csv"}, true);
  out.write("plan.json", "infeasible");
  out.commit();
  EXPECT_EQ(content(scratch.at("out/plan.json")), "infeasible");
  EXPECT_FALSE(fs::exists(scratch.at("out/trajectory.csv")));
  EXPECT_EQ(content(scratch.at("out/notes.txt")), "mine");
}

TEST(OutputDirectory, AFullDiskIsAnEnvironmentErrorAndLeavesTheOldResults) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(write_output_file("/proc/joulepath/x.json", "{}", true), EnvironmentError);
  EXPECT_THROW(write_output_file("/dev/full/x.json", "{}", true), EnvironmentError);
}

TEST(OutputFile, IsReplacedOnlyByForce) {
  const ScratchDirectory scratch;
  const std::string file = scratch.at("robot.yaml");
  write_output_file(file, "one", false);
  EXPECT_THROW(write_output_file(file, "two", false), ConfigError);
  EXPECT_EQ(content(file), "one");
  write_output_file(file, "two", true);
  EXPECT_EQ(content(file), "two");
}

TEST(EditedFile, KeepsItsLinkAndItsMode) {
  const ScratchDirectory scratch;
  const std::string file = scratch.write("real/robot.yaml", "one"), link = scratch.at("robot.yaml");
  fs::create_symlink("real/robot.yaml", link);
  for (const unsigned mode : {0600u, 0640u, 0755u}) {
    fs::permissions(file, fs::perms{mode});
    replace_file(link, "two " + std::to_string(mode));
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(content(file), "two " + std::to_string(mode));
    EXPECT_EQ(fs::status(file).permissions(), fs::perms{mode});
    EXPECT_EQ(entries(scratch.at("real")), 1u);
  }
}

TEST(Figure, KeepsSignificantDigitsWithoutExponents) {
  EXPECT_EQ(figure(1942.2345), "1942");
  EXPECT_EQ(figure(0.0123456), "0.01235");
  EXPECT_EQ(figure(-3.14159, 3), "-3.14");
  EXPECT_EQ(figure(0.0), "0");
  EXPECT_EQ(figure(1e9), "1.000e+09");
}

TEST(Table, AlignsNumbersToTheRight) {
  Table table({"leg", "energy J"});
  table.row({"dock", "12.5"});
  table.row({"Fläche", "1000.0"});
  std::ostringstream stream;
  table.print(stream);
  EXPECT_EQ(stream.str(), "leg     energy J\ndock        12.5\nFläche    1000.0\n");
}

}  // namespace
}  // namespace joulepath
