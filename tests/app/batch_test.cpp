#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "app/jobs/journal.hpp"
#include "app/jobs/mission_planner.hpp"
#include "app/jobs/progress.hpp"
#include "tests/app/program_result.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

const std::string kGoodRobot = JOULEPATH_SOURCE_DIR "/tests/data/broken/good/robot.yaml";

std::vector<Json> lines_of(const std::string& file) {
  std::vector<Json> lines;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}

std::string mission(const std::string& name, double length_m, const std::string& robot = "robot.yaml") {
  const std::string end = std::to_string(length_m);
  return R"({"name": ")" + name + R"(", "robot": ")" + robot +
         R"(", "legs": [{"path": {"bezier_m": [[[0, 0], [1, 0], [2, 0], [)" + end + ", 0]]]}}]}";
}

TEST(Batch, ABrokenMissionAffectsItsOwnLineOnly) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  ASSERT_EQ(::mkfifo(scratch.at("pipe.yaml").c_str(), 0600), 0);
  const std::string lines =
      scratch.write("m.jsonl", mission("a", 3) + "\n" + mission("\xff", 3) + "\nbroken{{{\n" +
                                   mission("b", 3) + ",\n" + mission("c", 3, "none.yaml") + "\n" +
                                   mission("d", 3, "pipe.yaml") + "\n" + mission("e", 4) + "\n");
  const auto result =
      run_program(scratch, "batch " + lines + " -j 2 -q --nodes 20 --out " + scratch.at("out"));
  EXPECT_EQ(result.code, 1) << "not every line could be read";
  const auto results = lines_of(scratch.at("out/results.jsonl"));
  ASSERT_EQ(results.size(), 7u);
  for (const std::size_t good : {0u, 6u}) EXPECT_TRUE(results[good].contains("energy_J")) << results[good];
  for (const std::size_t bad : {1u, 2u, 3u, 4u, 5u}) {
    EXPECT_EQ(results[bad]["status"], "bad_input") << results[bad];
    EXPECT_NE(results[bad]["message"].get<std::string>().find("m.jsonl:" + std::to_string(bad + 1)),
              std::string::npos)
        << results[bad];
  }
}

/// A shell's `*.yaml` is a list of files.
TEST(Batch, SeveralFilesAreOneList) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  std::string files;
  for (const char* name : {"a", "b"})
    files += " " + scratch.write(name + std::string(".yaml"), mission(name, 3));
  files += " " + scratch.write("m.jsonl", mission("c", 4) + "\n" + mission("d", 5) + "\n");
  const std::string options = " -q --nodes 20 --out " + scratch.at("out");
  const auto result = run_program(scratch, "batch" + files + options);
  EXPECT_EQ(result.code, 0) << result.err;
  std::string names;
  for (const Json& line : lines_of(scratch.at("out/results.jsonl"))) {
    EXPECT_TRUE(line.contains("energy_J")) << line;
    names += line.at("name").get<std::string>();
  }
  EXPECT_EQ(names, "abcd");
  EXPECT_NE(text_of(scratch.at("out/report.html")).find("a.yaml and 2 other files"), std::string::npos);
  const auto absent = run_program(scratch, "batch" + files + " none.yaml --force" + options);
  EXPECT_EQ(absent.code, 2);
  EXPECT_NE(absent.err.find("none.yaml"), std::string::npos) << absent.err;
  const auto mistyped = run_program(scratch, "batch" + files + " --ouut " + scratch.at("other"));
  EXPECT_NE(mistyped.err.find("unknown argument --ouut (did you mean --out?)"), std::string::npos)
      << mistyped.err;
}

TEST(Batch, CheckTellsEveryBrokenLineOfAList) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  const std::string lines =
      scratch.write("m.jsonl", mission("a", 3) + "\nbroken{{{\n" + mission("b", 3, "none.yaml") + "\n" +
                                   mission("c", 4) + "\n{\"robot\": \"robot.yaml\", \"leg\": []}\n");
  const auto told = run_program(scratch, "check " + lines);
  EXPECT_EQ(told.code, 1) << told.err;
  EXPECT_NE(told.out.find("m.jsonl: broken (missions: 5 missions, 3 cannot be read)"), std::string::npos)
      << told.out;
  for (const char* line : {"m.jsonl:2:", "m.jsonl:3:", "m.jsonl:5:"})
    EXPECT_NE(told.err.find(line), std::string::npos) << line << told.err;
  EXPECT_EQ(told.err.find("m.jsonl:1:"), std::string::npos) << told.err;
  const auto json = Json::parse(run_program(scratch, "check --json " + lines).out).at(0);
  EXPECT_FALSE(json.at("ok").get<bool>());
  ASSERT_EQ(json.at("errors").size(), 3u) << json;
  EXPECT_EQ(json["errors"][2].at("line"), 5) << json;
}

TEST(Batch, ARowSaysWhatItsPromisesAreKeptWith) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml"));
  std::string sure = mission("sure", 3);
  sure.insert(sure.size() - 1, R"(, "objective": {"minimize": "time", "confidence": 0.9})");
  const std::string lines = scratch.write("m.jsonl", sure + "\n" + mission("plain", 3) + "\n");
  ASSERT_EQ(run_program(scratch, "batch " + lines + " -q --nodes 20 --out " + scratch.at("out")).code, 0);
  const auto results = lines_of(scratch.at("out/results.jsonl"));
  const double kept = results.at(0).at("kept");
  EXPECT_GE(kept, 0.9) << results[0];
  ASSERT_FALSE(results[0].at("promises").empty()) << results[0];
  for (const auto& [name, share] : results[0]["promises"].items()) {
    EXPECT_GE(share.get<double>(), kept) << name;
    EXPECT_LE(share.get<double>(), 1.0) << name;
  }
  EXPECT_FALSE(results.at(1).contains("kept")) << results[1];
  // The option asks the same of every mission; lines of another confidence are planned again.
  const std::string again =
      "batch " + lines + " -q --nodes 20 --force --confidence 0.95 --out " + scratch.at("out");
  ASSERT_EQ(run_program(scratch, again).code, 0);
  for (const Json& line : lines_of(scratch.at("out/results.jsonl")))
    EXPECT_GE(line.value("kept", 0.0), 0.95) << line;
}

/// Missions that share legs, and missions that differ from each other in one property.
std::vector<std::string> sharing_missions() {
  const std::string legs[] = {
      R"([{"to": "shelf"}, {"to": "dock", "payload_kg": 5}])",
      R"([{"to": "shelf"}, {"to": "free"}])",
      R"([{"to": "free"}, {"to": "dock", "payload_kg": 5}])",
      R"([{"to": "shelf", "payload_kg": 5}])",
      R"([{"to": "shelf"}, {"to": "dock"}], "speed_zones": [{"leg": 0, "from_m": 0.2, "to_m": 0.6, "speed_m_s": 0.2}])",
      R"([{"to": "shelf", "deadline_s": 6}])"};
  std::vector<std::string> missions;
  for (const std::string& some : legs)
    missions.push_back(
        R"({"robot": "robot.yaml", "map": "map.yaml", "start": {"station": "dock"}, "stations": {)"
        R"("dock": {"x_m": 0.5, "y_m": 0.5, "heading_rad": 0.0},)"
        R"("shelf": {"x_m": 1.5, "y_m": 0.5, "heading_rad": 1.5},)"
        R"("free": {"x_m": 1.1, "y_m": 0.6}}, "legs": )" +
        some + "}\n");
  return missions;
}

/// The figures of a result line, without its place in the list.
std::string figures(Json line) {
  line.erase("index");
  line.erase("name");
  return line.dump();
}

TEST(Batch, ResultsDoNotDependOnOrderThreadsOrCache) {
  const ScratchDirectory scratch;
  const std::string good = JOULEPATH_SOURCE_DIR "/tests/data/broken/good/";
  for (const char* file : {"robot.yaml", "map.yaml", "map.pgm"}) scratch.write(file, text_of(good + file));
  const std::vector<std::string> missions = sharing_missions();
  const auto batch = [&](const std::vector<std::string>& some, const std::string& options) {
    std::string text;
    for (const std::string& mission : some) text += mission;
    const std::string file = scratch.write("m.jsonl", text);
    const auto result = run_program(
        scratch, "batch " + file + " --force -q --nodes 30 --out " + scratch.at("out") + " " + options);
    EXPECT_EQ(result.code, 0) << result.err;
    std::vector<std::string> found;
    for (const Json& line : lines_of(scratch.at("out/results.jsonl"))) found.push_back(figures(line));
    return found;
  };
  std::vector<std::string> alone;
  for (const std::string& mission : missions) {
    alone.push_back(batch({mission}, "--no-cache -j 1").at(0));
    EXPECT_NE(alone.back().find("energy_J"), std::string::npos) << alone.back();
  }
  EXPECT_EQ(std::set<std::string>(alone.begin(), alone.end()).size(), missions.size()) << "none is another's";
  EXPECT_EQ(batch(missions, "--no-cache -j 1"), alone);
  EXPECT_EQ(batch(missions, "--no-cache -j 2"), alone);
  const std::string cache = "--cache " + scratch.at("cache");
  EXPECT_EQ(batch({missions.rbegin(), missions.rend()}, cache + " -j 2"),
            std::vector<std::string>(alone.rbegin(), alone.rend()));
  EXPECT_EQ(batch(missions, cache + " -j 1"), alone) << "from the disk";
  std::mt19937 random(7);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch.at("cache")))
    if (entry.is_regular_file() && random() % 2)
      std::filesystem::resize_file(entry.path(), random() % entry.file_size());
  EXPECT_EQ(batch(missions, cache + " -j 2"), alone) << "every second file damaged";
}

TEST(Batch, TheFirstExceptionStopsAllThreadsAndReachesTheCaller) {
  std::vector<std::size_t> indices(100);
  for (std::size_t k = 0; k < indices.size(); ++k) indices[k] = k;
  const auto work = [](std::size_t k) { return JobResult{.index = k}; };
  const auto done = [](const JobResult& result) {
    if (result.index == 3) throw std::runtime_error("disk full");
  };
  for (const unsigned threads : {1u, 4u})
    EXPECT_THROW(run_jobs(indices, threads, work, done, [] { return false; }), std::runtime_error);
}

TEST(Batch, AQuarantinedMissionHasItsReasonAndNoPlan) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  const std::string lines =
      scratch.write("m.jsonl", mission("a", 3) + "\n" + mission("b", 4) + "\n" + mission("c", 5) + "\n");
  const std::string run = "batch " + lines + " -j 1 -q --nodes 20 --out ";
  const std::string held = scratch.write("held.jsonl", R"({"index": 1, "reason": "killed by SIGKILL"})");
  ASSERT_EQ(run_program(scratch, run + scratch.at("all")).code, 0);
  const auto done = run_program(scratch, run + scratch.at("out") + " --quarantine " + held);
  ASSERT_EQ(done.code, 0) << done.err;
  const auto all = lines_of(scratch.at("all/results.jsonl")),
             kept = lines_of(scratch.at("out/results.jsonl"));
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[0], all[0]);
  EXPECT_EQ(kept[2], all[2]);
  EXPECT_EQ(
      kept[1],
      (Json{{"index", 1}, {"name", "line_2"}, {"status", "quarantined"}, {"message", "killed by SIGKILL"}}));
  for (const char* wrong : {"{}", "[1]", "x", R"({"index": -1, "reason": "x"})", R"({"index": 1})"}) {
    const auto refused =
        run_program(scratch, run + scratch.at("no") + " --quarantine " + scratch.write("wrong.jsonl", wrong));
    EXPECT_EQ(refused.code, 2) << wrong;
    EXPECT_NE(refused.err.find("wrong.jsonl:1"), std::string::npos) << refused.err;
  }
}

TEST(Batch, TheFingerprintCoversEveryFileThatTheMissionReads) {
  const ScratchDirectory scratch;
  const std::string good = JOULEPATH_SOURCE_DIR "/tests/data/broken/good/";
  for (const char* file : {"robot.yaml", "map.yaml", "map.pgm", "mission.yaml"})
    scratch.write(file, text_of(good + file));
  const std::string file = scratch.write(
      "m/m.yaml",
      "robot: ../robot.yaml\nmap: ../map.yaml\nkeepout: ../map.yaml\n"
      "stations: {a: {x_m: 0.5, y_m: 0.5}, b: {x_m: 1.5, y_m: 0.5}}\nstart: {station: a}\nlegs: [{to: b}]\n");
  const auto fingerprint = [&](std::size_t nodes = 50) {
    return MissionPlanner({.nodes = nodes}, {}).fingerprint({.name = "m", .file = file});
  };
  const std::string before = fingerprint();
  EXPECT_FALSE(before.empty());
  EXPECT_EQ(fingerprint(), before);
  EXPECT_NE(fingerprint(51), before);
  for (const char* changed : {"robot.yaml", "map.yaml", "map.pgm"}) {
    const std::string content = text_of(scratch.at(changed));
    scratch.write(changed, content + "\n");
    EXPECT_NE(fingerprint(), before) << changed;
    scratch.write(changed, content);
  }
  EXPECT_EQ(fingerprint(), before);
  std::filesystem::remove(scratch.at("robot.yaml"));
  EXPECT_EQ(fingerprint(), "");
}

TEST(Batch, ResumePlansChangedMissionsOnly) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  const std::string file = scratch.write("m.jsonl", mission("a", 3) + "\n" + mission("b", 4) + "\n"),
                    arguments = "batch " + file + " -q --nodes 20 --out " + scratch.at("out");
  ASSERT_EQ(run_program(scratch, arguments).code, 0);
  const std::string whole = text_of(scratch.at("out/results.jsonl"));
  const std::vector<MissionItem> items = mission_items(file);
  MissionPlanner planner({.solver = SolverChoice::fast, .nodes = 20, .baselines = false}, {});
  {
    JobJournal journal(scratch.at("out/results.partial.jsonl"), JobJournal::Use::anew);
    journal.add({.index = 0, .line = R"({"status": "optimal", "kept": true})"},
                planner.fingerprint(items[0]));
    journal.add({.index = 1, .line = R"({"status": "optimal", "kept": true})"}, "of another robot");
  }
  std::ofstream(scratch.at("out/results.partial.jsonl"), std::ios::app) << "{\"index\": 1, \"finger";
  const auto again = run_program(scratch, arguments + " --force");
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(text_of(scratch.at("out/results.jsonl")), whole);
  {
    JobJournal journal(scratch.at("out/results.partial.jsonl"), JobJournal::Use::anew);
    journal.add({.index = 0, .line = R"({"status": "optimal", "kept": true})"},
                planner.fingerprint(items[0]));
    journal.add({.index = 1, .line = R"({"status": "optimal", "kept": true})"}, "of another robot");
  }
  EXPECT_EQ(run_program(scratch, arguments + " --resume").code, 0);
  const auto results = lines_of(scratch.at("out/results.jsonl"));
  ASSERT_EQ(results.size(), 2u);
  EXPECT_TRUE(results[0].contains("kept"));
  EXPECT_FALSE(results[1].contains("kept"));
}

TEST(Batch, ANewRunDoesNotDeleteAnUnfinishedOne) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  const std::string file = scratch.write("m.jsonl", mission("a", 3) + "\n");
  const std::string partial = scratch.write("out/results.partial.jsonl", "{}\n");
  const auto result = run_program(scratch, "batch " + file + " -q --out " + scratch.at("out"));
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("--resume"), std::string::npos) << result.err;
  EXPECT_EQ(text_of(partial), "{}\n");
}

TEST(Batch, ResumeDoesNotReplaceAnotherRunsFinishedResults) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  const std::string one = scratch.write("one.jsonl", mission("a", 3) + "\n"),
                    other = scratch.write("other.jsonl", mission("b", 4) + "\n"),
                    options = " -q --nodes 20 --out " + scratch.at("out");
  ASSERT_EQ(run_program(scratch, "batch " + one + options).code, 0);
  const std::string whole = text_of(scratch.at("out/results.jsonl"));
  const auto result = run_program(scratch, "batch " + other + options + " --resume");
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("--force"), std::string::npos) << result.err;
  EXPECT_EQ(text_of(scratch.at("out/results.jsonl")), whole);
  EXPECT_FALSE(std::filesystem::exists(scratch.at("out/results.partial.jsonl")));
}

/// Of one file: what --resume may continue is decided by the list, then by the results that hold.
TEST(Batch, ResumeDoesNotTakeOverAnotherUnfinishedRun) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  const std::string file = scratch.write("m.jsonl", mission("a", 3) + "\n"),
                    partial = scratch.at("out/results.partial.jsonl"),
                    arguments = "batch " + file + " -q --nodes 20 --resume --out " + scratch.at("out");
  const std::string list = digest_of(mission_items(file));
  std::filesystem::create_directory(scratch.at("out"));
  const auto resumed = [&](const JournalRun& run) {
    {
      JobJournal journal(partial, JobJournal::Use::anew);
      journal.begin(run);
      journal.add({.index = 0, .line = R"({"status": "optimal"})"}, "of other inputs");
    }
    const std::string before = text_of(partial);
    const ProgramResult result = run_program(scratch, arguments);
    if (result.code != 0) {
      EXPECT_EQ(result.code, 2) << result.err;
      EXPECT_NE(result.err.find(run.text()), std::string::npos) << result.err;
      EXPECT_NE(result.err.find("--force"), std::string::npos) << result.err;
      EXPECT_EQ(text_of(partial), before);
    }
    std::filesystem::remove(scratch.at("out/results.jsonl"));
    return result.code == 0;
  };
  EXPECT_FALSE(resumed({"batch", "/elsewhere/n.jsonl", "", "of other missions"}));
  EXPECT_FALSE(resumed({"batch", file, "", "of other missions"})) << "the file was replaced";
  EXPECT_FALSE(resumed({"batch", file, "1/2", list}));
  EXPECT_FALSE(resumed({"sweep", file, "", list}));
  for (const char* name : {"timings.jsonl", "report.html"})
    EXPECT_FALSE(std::filesystem::exists(scratch.at(std::string("out/") + name)));
  EXPECT_TRUE(resumed({"batch", "/moved/m.jsonl", "", list})) << "the same missions";
}

TEST(Batch, OneMissionIsNotCalledMissions) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kGoodRobot));
  const std::string file = scratch.write("m.jsonl", mission("a", 3) + "\n");
  const auto result = run_program(scratch, "batch " + file + " --nodes 20 --out " + scratch.at("out"));
  EXPECT_EQ(result.out.rfind("1 mission: 1 ", 0), 0u) << result.out;
}

TEST(Progress, CountsEarlierStepsAndTellsTheRateOfThisRun) {
  EXPECT_EQ(progress_text("plans of shard 2/8", 8, 36, 0, 4.0), "plans of shard 2/8 8/36, 2/s, 14 s left");
  EXPECT_EQ(progress_text("missions", 30, 36, 28, 4.0), "missions 30/36, 0.5/s, 12 s left");
  EXPECT_EQ(progress_text("missions", 28, 36, 28, 4.0), "missions 28/36, 0/s, 0 s left");
}

TEST(JobJournal, ExistingLinesNeverChangeAndATruncatedLineAffectsNoOther) {
  const ScratchDirectory scratch;
  const std::string file = scratch.at("j.jsonl");
  { JobJournal(file, JobJournal::Use::anew).add({.index = 0, .line = R"({"status": "a"})"}, "x"); }
  std::ofstream(file, std::ios::app) << "{\"index\": 1, \"fing";
  const std::string before = text_of(file);
  {
    JobJournal journal(file, JobJournal::Use::resume);
    ASSERT_NE(journal.find(0, "x"), nullptr);
    EXPECT_EQ(journal.find(0, "y"), nullptr);
    EXPECT_EQ(journal.find(0, ""), nullptr);
    EXPECT_EQ(journal.find(1, "x"), nullptr);
    journal.add({.index = 2, .line = R"({"status": "b"})"}, "z");
    EXPECT_ANY_THROW(JobJournal(file, JobJournal::Use::resume));  // only one writer at a time
  }
  EXPECT_EQ(text_of(file).substr(0, before.size()), before);
  const JobJournal again(file, JobJournal::Use::resume);
  ASSERT_NE(again.find(0, "x"), nullptr);
  ASSERT_NE(again.find(2, "z"), nullptr);
  EXPECT_EQ(again.find(2, "z")->status, "b");
}

}  // namespace
}  // namespace joulepath
