// Parts of a batch or a sweep in several processes, and their merge.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "app/build_id.hpp"
#include "extensions/studies/tests/sweep_fixture.hpp"

namespace joulepath {
namespace {

class Shards : public Sweep {
 protected:
  void SetUp() override {
    std::string lines;
    for (int k = 0; k < 7; ++k)
      lines += R"({"name": "m)" + std::to_string(k) +
               R"(", "robot": "robot.yaml", "legs": [{"path": {"bezier_m": [[[0, 0], [1, 0], [2, 0], [)" +
               std::to_string(3 + k) + R"(, 0]]]}}]})" + "\n";
    source = scratch.write("m.jsonl", lines);
  }
  ProgramResult batch(const std::string& out, const std::string& more = "") {
    return run_program(scratch, "batch " + source + " -q --nodes 20 --out " + scratch.at(out) + " " + more);
  }
  ProgramResult merge(const std::string& directories, const std::string& out) {
    std::string all;
    std::istringstream names(directories);
    for (std::string name; names >> name;) all += scratch.at(name) + " ";
    return run_program(scratch, "merge " + all + "-q --out " + scratch.at(out));
  }
  std::string source;
};

TEST_F(Shards, MergedAreTheBytesOfOneRun) {
  ASSERT_EQ(batch("whole").code, 0);
  for (const char* k : {"1", "2", "3"})
    ASSERT_EQ(batch(std::string("s") + k, std::string("--shard ") + k + "/3").code, 0);
  const auto done = merge("s3 s1 s2", "all");
  ASSERT_EQ(done.code, 0) << done.err;
  for (const char* file : {"/results.jsonl", "/report.html"})
    EXPECT_EQ(text_of(scratch.at(std::string("all") + file)),
              text_of(scratch.at(std::string("whole") + file)))
        << file;
}

TEST_F(Shards, SweepsMergeToo) {
  const std::string study =
      "missions: mission.yaml\nparameters: {gear: {key: robot.motor.gear_ratio, from: 10, to: 40, count: "
      "5}}\n";
  ASSERT_EQ(sweep(study).code, 0);
  for (const char* k : {"1", "2"})
    ASSERT_EQ(run_program(scratch, "sweep " + scratch.at("study.yaml") + " -q --nodes 100 --shard " + k +
                                       "/2 --out " + scratch.at(std::string("s") + k))
                  .code,
              0);
  ASSERT_EQ(merge("s1 s2", "all").code, 0);
  for (const char* file : {"/sweep.csv", "/sweep.json", "/report.html"})
    EXPECT_EQ(text_of(scratch.at(std::string("all") + file)), text_of(scratch.at(std::string("out") + file)))
        << file;
}

/// Maps and masks are shared by missions: no line may depend on the missions before it.
TEST_F(Shards, ALineDoesNotDependOnTheLinesBefore) {
  scratch.write("half.pgm", "P2\n2 1\n255\n128 128\n");
  scratch.write("half.yaml",
                "image: half.pgm\nmode: scale\nresolution: 10\norigin: [0, -5, 0]\nnegate: 0\n"
                "occupied_thresh: 1.0\nfree_thresh: 0.0\n");
  const std::string along =
      R"("robot": "robot.yaml", "legs": [{"path": {"bezier_m": [[[0, 0], [1, 0], [2, 0], [3, 0]]]}, )";
  source = scratch.write(
      "m.jsonl",
      "{" + along + R"("payload_kg": 0}]})" + "\n{" + along + R"("payload_kg": 30}]})" + "\n{" + along +
          R"("payload_kg": 1}], "speed_mask": {"file": "half.yaml", "kind": "absolute", "base": 2, "multiplier": -0.02}})" +
          "\n{" + along +
          R"("payload_kg": 1}], "speed_mask": {"file": "half.yaml", "kind": "absolute", "base": 1, "multiplier": -0.01}})" +
          "\n");
  ASSERT_EQ(batch("whole", "-j 1").code, 0);
  std::string directories;
  for (const char* k : {"1", "2", "3", "4"}) {
    ASSERT_EQ(batch(std::string("s") + k, std::string("--shard ") + k + "/4").code, 0);
    directories += std::string(" s") + k;
  }
  ASSERT_EQ(merge(directories, "all").code, 0);
  EXPECT_EQ(text_of(scratch.at("all/results.jsonl")), text_of(scratch.at("whole/results.jsonl")));
}

TEST_F(Shards, OneShardOfOneIsMergedToo) {
  ASSERT_EQ(batch("whole").code, 0);
  ASSERT_EQ(batch("s1", "--shard 1/1").code, 0);
  ASSERT_EQ(merge("s1", "all").code, 0);
  EXPECT_EQ(text_of(scratch.at("all/results.jsonl")), text_of(scratch.at("whole/results.jsonl")));
}

/// The value of a parameter may name a file.
TEST_F(Shards, FilesThatADesignNamesAreInputs) {
  for (const char* name : {"a.yaml", "b.yaml"}) scratch.write(name, kSimpleRobot);
  const std::string file = scratch.write(
      "study.yaml",
      "missions: mission.yaml\nparameters:\n  robot: {key: mission.robot, values: [a.yaml, b.yaml]}\n"
      "  payload: {key: 'mission.legs[*].payload_kg', values: [0, 1]}\n");
  const auto shard = [&](const std::string& k) {
    return run_program(
        scratch, "sweep " + file + " -q --nodes 20 --out " + scratch.at("s" + k) + " --shard " + k + "/2");
  };
  ASSERT_EQ(shard("1").code, 0);
  scratch.write("b.yaml", kSimpleRobot + "# the same robot\n");
  ASSERT_EQ(shard("2").code, 0);
  const auto done = merge("s1 s2", "all");
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("b.yaml with another content"), std::string::npos) << done.err;
}

/// A file that one shard could not read, or could not make sense of, is another input, too.
TEST_F(Shards, AFileThatOneShardCouldNotReadIsAnInput) {
  const auto refused = [&](const std::string& word) {
    const auto done = merge("s1 s2", "all");
    EXPECT_EQ(done.code, 2);
    EXPECT_NE(done.err.find(word + " with another content"), std::string::npos) << done.err;
  };
  std::filesystem::rename(scratch.at("robot.yaml"), scratch.at("away.yaml"));
  ASSERT_EQ(batch("s1", "--shard 1/2").code, 0);
  std::filesystem::rename(scratch.at("away.yaml"), scratch.at("robot.yaml"));
  ASSERT_EQ(batch("s2", "--shard 2/2").code, 0);
  refused("robot.yaml");
  const std::string study = scratch.write("study.yaml",
                                          "missions: [mission.yaml, other.yaml, third.yaml]\nparameters:\n"
                                          "  gear: {key: robot.motor.gear_ratio, values: [10, 20]}\n");
  scratch.write("third.yaml", kMission + "name: third\n");
  for (const std::string k : {"1", "2"}) {
    scratch.write("other.yaml", k == "1" ? "legs: [\n" : kMission);
    ASSERT_EQ(run_program(scratch, "sweep " + study + " -q --nodes 20 --force --out " + scratch.at("s" + k) +
                                       " --shard " + k + "/2")
                  .code,
              0);
  }
  refused("other.yaml");
}

TEST_F(Shards, ShardsOfDifferentRunsAreRejected) {
  for (const char* k : {"1", "2", "3"})
    ASSERT_EQ(batch(std::string("s") + k, std::string("--shard ") + k + "/3").code, 0);
  const auto refused = [&](const std::string& directories, const std::string& word) {
    const auto done = merge(directories, "all");
    EXPECT_EQ(done.code, 2) << done.err;
    EXPECT_NE(done.err.find(word), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.at("all")));
  };
  refused("s1 s3", "missing: 2");
  refused("s1 s2 s2 s3", "each shard once");
  ASSERT_EQ(batch("other", "--shard 2/3 --seed 2").code, 0);
  refused("s1 other s3", "--seed: found 2, accepted: 1, as in");
  const std::string missions = text_of(source);
  scratch.write("m.jsonl",
                missions.substr(missions.find('\n') + 1) + missions.substr(0, missions.find('\n')));
  ASSERT_EQ(batch("others", "--shard 2/3").code, 0);
  refused("s1 others s3", "list: found other missions or designs");
  scratch.write("m.jsonl", missions);
  scratch.write("robot.yaml", kSimpleRobot + "# the same robot\n");
  ASSERT_EQ(batch("s2", "--shard 2/3 --force").code, 0);
  refused("s1 s2 s3", "robot.yaml with another content");
  std::string manifest = text_of(scratch.at("s3/shard.json"));
  const auto at = manifest.find("\"version\": \"");
  manifest.insert(at + 12, "9");
  scratch.write("s3/shard.json", manifest);
  refused("s1 s3", "version");
  EXPECT_EQ(batch("bad", "--shard 4/3").code, 2);
  EXPECT_EQ(batch("bad", "--shard x").code, 2);
  EXPECT_EQ(batch("bad", "--shard ''").code, 2) << "a script's variable that is not set";
}

/// Two programs of one version may have other code: only the build says whether their results belong
/// together.
TEST_F(Shards, ShardsOfAnotherBuildAreRejected) {
  for (const char* k : {"1", "2"})
    ASSERT_EQ(batch(std::string("s") + k, std::string("--shard ") + k + "/2").code, 0);
  const std::string build(kBuildId), other = "0123456789abcdef";
  EXPECT_NE(run_program(scratch, "--version").out.find(build), std::string::npos);
  const auto refused = [&] {
    const auto done = merge("s1 s2", "all");
    EXPECT_EQ(done.code, 2) << done.err;
    EXPECT_NE(done.err.find(build), std::string::npos) << done.err;
    EXPECT_NE(done.err.find(other), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.at("all")));
  };
  for (const std::string shard : {"s2", "s1"}) {  // then both are of another build than the merging program
    std::string manifest = text_of(scratch.at(shard + "/shard.json"));
    ASSERT_NE(manifest.find(build), std::string::npos) << manifest;
    scratch.write(shard + "/shard.json", manifest.replace(manifest.find(build), build.size(), other));
    refused();
  }
}

TEST_F(Shards, ResumeKeepsTheFinishedShardOfOtherMissions) {
  ASSERT_EQ(batch("s1", "--shard 1/2").code, 0);
  const std::string finished = text_of(scratch.at("s1/results.jsonl"));
  EXPECT_EQ(batch("s1", "--shard 1/2 --resume").code, 0);
  EXPECT_EQ(batch("s1", "--shard 2/2 --resume").code, 2);
  scratch.write("m.jsonl", text_of(source) + text_of(source));
  const auto done = batch("s1", "--shard 1/2 --resume");
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("the finished shard 1/2 of another batch"), std::string::npos) << done.err;
  EXPECT_EQ(text_of(scratch.at("s1/results.jsonl")), finished);
}

TEST_F(Shards, ACutShardIsRefused) {
  for (const char* k : {"1", "2"})
    ASSERT_EQ(batch(std::string("s") + k, std::string("--shard ") + k + "/2").code, 0);
  const std::string lines = text_of(scratch.at("s1/results.jsonl"));
  scratch.write("s1/results.jsonl", lines.substr(0, lines.size() / 2));
  EXPECT_EQ(merge("s1 s2", "all").code, 2);
  scratch.write("s1/results.jsonl", lines + lines);
  EXPECT_EQ(merge("s1 s2", "all").code, 2);
  std::string edited = lines;
  char& digit = edited[edited.find("\"energy_J\":") + 11];
  digit = digit == '9' ? '8' : '9';
  scratch.write("s1/results.jsonl", edited);
  const auto done = merge("s1 s2", "all");
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("changed or cut"), std::string::npos) << done.err;
  scratch.write("s1/results.jsonl", lines);
  const std::string timings = text_of(scratch.at("s1/timings.jsonl"));
  scratch.write("s1/timings.jsonl", "");
  EXPECT_EQ(merge("s1 s2", "all").code, 2);
  scratch.write("s1/timings.jsonl", timings);
  EXPECT_EQ(merge("s1 s2", "all").code, 0);
}

TEST_F(Shards, MergeDoesNotWriteIntoAShard) {
  ASSERT_EQ(batch("one", "--shard 1/2").code, 0);
  ASSERT_EQ(batch("two", "--shard 2/2").code, 0);
  const std::string lines = text_of(scratch.at("one/results.jsonl"));
  EXPECT_EQ(merge("one two", "one --force").code, 2);
  EXPECT_EQ(text_of(scratch.at("one/results.jsonl")), lines);
}

}  // namespace
}  // namespace joulepath
