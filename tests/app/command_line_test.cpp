#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scenarios/any_file.hpp"
#include "tests/app/program_result.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const std::string kBroken = JOULEPATH_SOURCE_DIR "/tests/data/broken/";

TEST(CommandLine, HelpAndVersionGoToStandardOutput) {
  const ScratchDirectory scratch;
  for (const char* arguments : {"--help", "--version", "check --help", "plan --help"}) {
    const auto result = run_program(scratch, arguments);
    EXPECT_EQ(result.code, 0) << arguments;
    EXPECT_FALSE(result.out.empty()) << arguments;
    EXPECT_EQ(result.err, "") << arguments;
  }
  EXPECT_NE(run_program(scratch, "plan --help").out.find("Examples:"), std::string::npos);
}

TEST(CommandLine, UsageErrorsEndWithTwoAndOneHint) {
  const ScratchDirectory scratch;
  for (const char* arguments : {"", "chek", "check", "check --no-such-flag x", "schema robt",
                                "completion tcsh", "check --kind robott x.yaml"}) {
    const auto result = run_program(scratch, arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_FALSE(result.err.empty()) << arguments;
  }
  EXPECT_NE(run_program(scratch, "chek").err.find("did you mean check?"), std::string::npos);
  EXPECT_NE(run_program(scratch, "schema robt").err.find("did you mean robot?"), std::string::npos);
}

TEST(CommandLine, ANumberOfAnOptionIsFinite) {
  const ScratchDirectory scratch;
  for (const std::string value : {"nan", "-nan", "inf", "-inf"})
    for (const char* option : {"simulate m.yaml --sample-rate-Hz=", "simulate m.yaml --time-of-day-s=",
                               "export m.yaml --to nav2_path --rate=", "plan m.yaml --accuracy=",
                               "plan m.yaml --time=", "monitor x --robot r --false-alarm-hours="}) {
      const auto result = run_program(scratch, option + value);
      EXPECT_EQ(result.code, 2) << option << value;
      EXPECT_NE(result.err.find("found " + value + ", accepted: a finite number"), std::string::npos)
          << option << value << result.err;
    }
}

/// A name cannot forge a line: what is printed of a file stands in the lines of the program.
TEST(CommandLine, ANameOfSeveralLinesIsPrintedInOne) {
  const ScratchDirectory scratch;
  const std::string robot = text_of(kBroken + "good/robot.yaml");
  for (const std::string mark : {"\\r", "\\n", "\\t", "\\u2028", "\\u202e"}) {
    const std::string name = "name: \"x" + mark + "robot.yaml: ok (checked by the maker)\"\n";
    std::string text = robot;
    const auto at = text.find("name:");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, text.find('\n', at) + 1 - at, name);
    const auto result = run_program(scratch, "check " + scratch.write("robot.yaml", text));
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(std::ranges::count(result.out, '\n'), 1) << result.out;
    for (const char* raw : {"\r", "\t", "\u2028", "\u202e"})
      EXPECT_EQ(result.out.find(raw), std::string::npos) << result.out;
  }
}

/// A file's name on the command line cannot either: every command that takes one refuses it, in one line.
TEST(CommandLine, ATextThatMovesTheTerminalIsRefused) {
  const ScratchDirectory scratch;
  for (const std::string mark : {"\r", "\n", "\t", "\x1b[2J", "\u2028", "\u202e", "\u0085"}) {
    const std::string name = "'" + scratch.at("x" + mark + "forged: ok") + "'";
    for (const std::string& command :
         {"estimate " + name + " --robot r.yaml", "plan m.yaml --out " + name,
          "diagnose d.yaml --out " + name, "simulate p --robot r.yaml --out " + name, "check " + name,
          "batch " + name + " --out o", "diagnose d.yaml --out o --without " + name}) {
      const auto refused = run_program(scratch, command);
      EXPECT_EQ(refused.code, 2) << command;
      EXPECT_EQ(refused.out, "") << command;
      EXPECT_NE(refused.err.find("accepted: no control characters"), std::string::npos) << refused.err;
      EXPECT_EQ(refused.err.find("\nforged"), std::string::npos) << refused.err;
      EXPECT_TRUE(mark == "\n" || refused.err.find(mark) == std::string::npos) << refused.err;
    }
  }
}

/// Logs too short for the smoothing: named, and an error where there are no others.
TEST(CommandLine, AShortLogIsLeftOutOrAnError) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(kBroken + "good/robot.yaml"));
  const auto log = [&](const std::string& name, double period_s, int samples, double clock) {
    std::string text =
        "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,motor_current_left_A,motor_current_right_A\n";
    for (int k = 0; k < samples; ++k) {
      const double t = k * period_s, speed = 2 - 2 * std::cos(t), current = 0.3 + 0.14 * std::sin(t);
      for (const double value : {clock * t, speed, speed, current + 1e-3 * (k % 7), current + 1e-3 * (k % 5)})
        text += std::to_string(value) + ",";
      text.back() = '\n';
    }
    scratch.write(name, text);
  };
  log("short.csv", 0.005, 74, 1);
  log("good.csv", 0.02, 400, 1);
  log("micro.csv", 0.02, 400, 1e-4);
  const std::string alone =
      scratch.write("a.yaml", "robot: robot.yaml\nruns: [{file: short.csv, payload_kg: 0}]\n");
  const std::string both = scratch.write(
      "b.yaml",
      "robot: robot.yaml\nruns: [{file: good.csv, payload_kg: 0}, {file: short.csv, payload_kg: 0}]\n");
  const std::string micro =
      scratch.write("c.yaml", "robot: robot.yaml\nruns: [{file: micro.csv, payload_kg: 0}]\n");
  for (const std::string& command :
       {std::string("check "), "diagnose --force --out " + scratch.at("out") + " "}) {
    const auto refused = run_program(scratch, command + alone);
    EXPECT_EQ(refused.code, 2) << refused.out;
    EXPECT_NE(refused.err.find("74 samples in 0.365 s"), std::string::npos) << refused.err;
    const auto clock = run_program(scratch, command + micro);
    EXPECT_EQ(clock.code, 2);
    EXPECT_NE(clock.err.find("is the stamp in ms (scale 1.0e-3)"), std::string::npos) << clock.err;
    const auto told = run_program(scratch, command + both);
    EXPECT_EQ(told.code, 0) << told.out << told.err;
    EXPECT_NE((told.out + told.err).find("short.csv: too short, left out"), std::string::npos) << told.err;
  }
}

TEST(CommandLine, AnEmptyTextIsNoValue) {
  const ScratchDirectory scratch;
  for (const char* option : {"--robot", "--map", "--out", "--cache"}) {
    const auto result = run_program(scratch, std::string("plan m.yaml ") + option + " ''");
    EXPECT_EQ(result.code, 2) << option;
    EXPECT_NE(result.err.find("found an empty text"), std::string::npos) << option << result.err;
  }
}

TEST(CommandLine, AFileOfAnOptionIsAMistakeOfTheOption) {
  const ScratchDirectory scratch;
  for (const std::string option : {"--robot", "--map"}) {
    const std::string said = "joulepath: " + option + ": found nosuch.yaml, no readable file";
    const auto result = run_program(scratch, "plan " + kBroken + "good/mission.yaml " + option +
                                                 " nosuch.yaml --out " + scratch.at("out"));
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.err.rfind(said, 0), 0u) << result.err;
  }
}

TEST(CommandLine, AnOptionBeforeTheCommandIsReportedAsSuch) {
  const ScratchDirectory scratch;
  const auto result = run_program(scratch, "--out x plan m.yaml");
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("--out before the command"), std::string::npos) << result.err;
}

TEST(CommandLine, ForceDoesNotReplaceAnInput) {
  const ScratchDirectory scratch;
  ASSERT_EQ(run_program(scratch, "init -q " + scratch.at("start")).code, 0);
  const std::string mission = scratch.at("start/mission.yaml"), text = text_of(mission);
  for (const std::string out : {"mission.yaml", "../start/mission.yaml"}) {
    const auto result =
        run_program(scratch, "studio " + mission + " --force --out " + scratch.at("start/" + out));
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find("found an input of this command"), std::string::npos) << result.err;
  }
  const auto folder = run_program(scratch, "simulate " + mission + " --force --out " + scratch.at("start"));
  EXPECT_EQ(folder.code, 2) << "its robot.yaml is an input";
  EXPECT_FALSE(std::filesystem::exists(scratch.at("start/simulation.json")));
  EXPECT_EQ(text_of(mission), text);
}

TEST(CommandLine, AnUnknownEffectOfWithoutIsReportedWithSimilarNames) {
  const ScratchDirectory scratch;
  const auto slip =
      run_program(scratch, "diagnose none.yaml --out " + scratch.at("out") + " --without rolling_resistanc");
  EXPECT_EQ(slip.code, 2);
  EXPECT_NE(slip.err.find("did you mean rolling_resistance"), std::string::npos) << slip.err;
  const auto word = run_program(
      scratch, "diagnose none.yaml --out " + scratch.at("out") + " --without wheel_slip,friction");
  EXPECT_EQ(word.code, 2);
  EXPECT_NE(word.err.find("no effect 'friction'"), std::string::npos) << word.err;
  EXPECT_NE(word.err.find("coulomb_friction"), std::string::npos) << word.err;
  EXPECT_FALSE(std::filesystem::exists(scratch.at("out")));
}

TEST(CommandLine, AStepToLeaveOutBeforeTheMissionIsNotTheMission) {
  const ScratchDirectory scratch;
  const auto result =
      run_program(scratch, "plan --without baselines,stops none.yaml --out " + scratch.at("out"));
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("none.yaml: found no readable file"), std::string::npos) << result.err;
}

TEST(CommandLine, AStopWhereTheRobotDoesNotFitIsNamedByFileAndLine) {
  const ScratchDirectory scratch;
  const std::string good = kBroken + "good/";
  const std::string mission =
      scratch.write("m.yaml", "robot: " + good + "robot.yaml\nmap: " + good +
                                  "map.yaml\nstations: {a: {x_m: 0.5, y_m: 0.5}, wall: {x_m: 0, y_m: 0.5}}\n"
                                  "start: {station: a}\nlegs:\n  - {to: wall}\n");
  const auto result = run_program(scratch, "plan " + mission + " -q --out " + scratch.at("out"));
  EXPECT_EQ(result.code, 1);
  EXPECT_NE(result.err.find("m.yaml:6:10: legs[0].to"), std::string::npos) << result.err;
}

/// Without `start:` the robot begins at the map's origin of coordinates, which is mostly a corner of the map.
TEST(CommandLine, AMissionWithoutAStartIsNamedByFileAndLine) {
  const ScratchDirectory scratch;
  const std::string good = kBroken + "good/";
  const std::string head = "robot: " + good + "robot.yaml\nmap: " + good +
                           "map.yaml\nstations: {a: {x_m: 0.5, y_m: 0.5}, b: {x_m: 0.6, y_m: 0.5}}\n";
  for (const std::string stops : {"legs:\n  - {to: a}\n", "visit:\n  - {go: a}\n  - {go: b}\n"}) {
    const std::string mission = scratch.write("m.yaml", head + stops);
    for (const std::string& command :
         {"check " + mission, "plan " + mission + " --out " + scratch.at("out")}) {
      const auto result = run_program(scratch, command);
      EXPECT_EQ(result.code, 2) << command << stops;
      for (const char* says :
           {"m.yaml:5:3: start: found nothing, ", "accepted: station, or x_m and y_m, of a free place"})
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
    }
  }
}

TEST(CommandLine, DiagnosisOfABadDatasetEndsWithTwoAndWritesNothing) {
  const ScratchDirectory scratch;
  for (const auto& entry : std::filesystem::directory_iterator(kBroken + "dataset")) {
    if (entry.path().extension() != ".yaml") continue;
    const auto result =
        run_program(scratch, "diagnose " + entry.path().string() + " --out " + scratch.at("out"));
    EXPECT_EQ(result.code, 2) << entry.path();
    EXPECT_EQ(result.out, "") << entry.path();
    EXPECT_NE(result.err.find("accepted: "), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.at("out"))) << entry.path();
  }
}

TEST(CommandLine, AnUnknownArgumentIsReportedBeforeAMissingOne) {
  const ScratchDirectory scratch;
  const auto result = run_program(scratch, "plan mission.yaml --ouut " + scratch.at("out"));
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("unknown argument --ouut (did you mean --out?)"), std::string::npos)
      << result.err;
  EXPECT_NE(run_program(scratch, "plan mission.yaml").err.find("--out is required"), std::string::npos);
  EXPECT_NE(run_program(scratch, "diagnose run_01.csv '" + kBroken + "good/robot.yaml'")
                .err.find("robot.yaml, one file too many"),
            std::string::npos);
}

TEST(CommandLine, AShortenedWordIsToldInFull) {
  const ScratchDirectory scratch;
  const auto told = [&](const std::string& arguments) {
    const auto result = run_program(scratch, arguments + " --out " + scratch.at("out"));
    EXPECT_EQ(result.code, 2) << arguments;
    return result.err;
  };
  const std::string price = told("plan m.yaml --price 0.3"), format = told("export m.yaml --to traj"),
                    slip = told("export m.yaml --to edgs");
  EXPECT_NE(price.find("unknown argument --price (did you mean --price-per-kWh?)"), std::string::npos)
      << price;
  EXPECT_NE(format.find("(did you mean trajectory?)"), std::string::npos) << format;
  EXPECT_NE(slip.find("(did you mean edges?)"), std::string::npos) << slip;
  EXPECT_NE(run_program(scratch, "comp").err.find("did you mean compare or completion?"), std::string::npos);
}

TEST(CommandLine, ExportWritesAllItsFilesOrNone) {
  const ScratchDirectory scratch;
  scratch.write("m.yaml", "robot: " JOULEPATH_SOURCE_DIR
                          "/scenarios/robots/nomad_super_scout.yaml\n"
                          "legs: [{path: {bezier_m: [[[0, 0], [1, 0], [2, 0], [3, 0]]]}}]\n");
  const std::string command =
      "export " + scratch.at("m.yaml") + " --nodes 40 --to speed_mask --out " + scratch.at("mask.yaml");
  scratch.write("mask.pgm", "mine");
  EXPECT_EQ(run_program(scratch, command).code, 2);
  EXPECT_FALSE(std::filesystem::exists(scratch.at("mask.yaml")));
  const auto forced = run_program(scratch, command + " --force --json");
  EXPECT_EQ(forced.code, 0) << forced.err;
  EXPECT_GT(nlohmann::json::parse(forced.out)["own_time"]["energy_J"].get<double>(), 0);
  for (const char* name : {"mask.yaml", "mask.pgm", "mask.loss.json"})
    EXPECT_TRUE(std::filesystem::exists(scratch.at(name))) << name;
}

const std::string kRobot = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";

TEST(CommandLine, APathIsComparedAtItsTimeWithItsPayload) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("path.csv", "x_m,y_m\n0,0\n2,0.5\n4,0\n");
  const auto compared = [&](const std::string& options) {
    const auto result =
        run_program(scratch, "compare " + path + " --nodes 40 --json --robot " + kRobot + options);
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out)["profiles"];
  };
  const auto profiles = compared(" --time 12 --payload 5");
  const auto& plan = profiles[0];
  EXPECT_EQ(plan["name"], "plan");
  std::size_t counted = 0;
  for (const auto& profile : profiles) {
    if (!profile["feasible"].get<bool>()) continue;
    ++counted;
    EXPECT_NEAR(profile["duration_s"].get<double>(), 12.0, 1e-6) << profile["name"];
    EXPECT_NEAR(profile["energy_J"].get<double>() - profile["motion_energy_J"].get<double>(), 12.0 * 10.0,
                1e-3)
        << "standby of this robot: 10 W";
    EXPECT_GE(profile["energy_J"].get<double>(), plan["energy_J"].get<double>() * (1 - 1e-4))
        << profile["name"];
  }
  EXPECT_GE(counted, 8u);
  EXPECT_LT(compared(" --time 12")[0]["energy_J"].get<double>(), plan["energy_J"].get<double>());
  EXPECT_LE(compared(" --payload 5")[0]["energy_J"].get<double>(), plan["energy_J"].get<double>());
}

/// A sum over the stretches that it can drive, or the dwell alone, is no energy of this mission.
TEST(CommandLine, AProfileThatCannotBeDrivenHasNoFigures) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("path.csv", "x_m,y_m,corner_radius_m\n0,0,\n2,0,0.4\n2,2,\n");
  std::size_t not_driven = 0;
  for (const auto& [command, list] :
       {std::pair{"compare ", "profiles"}, {"front --points 3 ", "baselines"}}) {
    const auto result = run_program(scratch, command + path + " --nodes 40 --json --robot " + kRobot);
    ASSERT_EQ(result.code, 0) << result.err;
    const auto answer = nlohmann::json::parse(result.out);
    for (const auto& profile : answer[list]) {
      const bool feasible = profile["feasible"];
      not_driven += feasible ? 0 : 1;
      for (const char* key : {"energy_J", "motion_energy_J", "duration_s", "optimum_J", "optimum_motion_J"})
        EXPECT_EQ(profile[key].is_null(), !feasible) << key << profile;
      EXPECT_EQ(profile["reason"].get<std::string>().empty(), feasible) << profile;
    }
  }
  EXPECT_GT(not_driven, 0u);
}

TEST(CommandLine, AMissionOfTheSamePathHasTheSamePlan) {
  const ScratchDirectory scratch;
  const std::string curve = "bezier_m: [[[0, 0], [2.7, 0], [2.7, 0], [2.7, 2.7]]]";
  const std::string path = scratch.write("path.yaml", curve + "\n");
  const std::string mission = scratch.write("mission.yaml", "robot: " + kRobot + "\nlegs: [{path: {" + curve +
                                                                "}, payload_kg: 3, duration_s: 15}]\n");
  const auto energy_J = [&](const std::string& arguments) {
    const auto result = run_program(scratch, arguments + " --nodes 40 --json");
    EXPECT_EQ(result.code, 0) << result.err;
    return nlohmann::json::parse(result.out)["profiles"][0]["energy_J"].get<double>();
  };
  EXPECT_DOUBLE_EQ(energy_J("compare " + path + " --robot " + kRobot + " --payload 3 --time 15"),
                   energy_J("compare " + mission));
}

TEST(CommandLine, OptionsThatAPathOrAMissionDoesNotTakeAreReportedInOneLine) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("path.csv", "x_m,y_m\n0,0\n2,0.5\n4,0\n"),
                    mission = kBroken + "good/mission.yaml", out = " --out " + scratch.at("out");
  const auto refused = [&](const std::string& arguments, const std::string& says, int code = 2) {
    const auto result = run_program(scratch, arguments + out);
    EXPECT_EQ(result.code, code) << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.at("out"))) << arguments;
  };
  refused("compare " + path, "path.csv:1:1: found a path, which names no robot, accepted: --robot");
  refused("front " + path, "--robot");
  refused("compare " + path + " --robot " + kRobot + " --payload 50", "at most 12");
  refused("compare " + mission + " --payload 5", "--payload: found a value together with a mission");
  refused("compare " + mission + " --time 5", "--time: found a value together with a mission");
  refused("front " + kBroken + "path/empty_cell.csv --robot " + kRobot,
          "empty_cell.csv:3:1: y_m: found an empty cell");
  refused("compare " + kBroken + "good/run.csv --robot " + kRobot, "no column x_m");
  refused("compare " + path + " --time 1 --robot " + kRobot, "the fastest drive takes", 1);
}

TEST(CommandLine, ANumberThatIsNoneOrNegativeIsNamedWithWhatIsAccepted) {
  const ScratchDirectory scratch;
  for (const std::string bad : {"abc", "-1", "nan", "inf", "1e"}) {
    const auto result = run_program(scratch, "compare " + kRobot + " --payload=" + bad);
    EXPECT_EQ(result.code, 2) << bad;
    EXPECT_NE(result.err.find("--payload: found " + bad + ", accepted: a finite number of at least 0"),
              std::string::npos)
        << result.err;
  }
}

TEST(CommandLine, TheFrontOfAPathFallsFromTheFastestToTheMostEconomical) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("path.csv", "x_m,y_m,corner_radius_m\n0,0,\n2,0,0.4\n2,2,\n");
  const auto result = run_program(
      scratch, "front " + path + " --nodes 40 --points 4 --json --robot " + kRobot + " --payload 5");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto front = nlohmann::json::parse(result.out);
  const auto& points = front["points"];
  ASSERT_EQ(points.size(), 4u);
  for (std::size_t k = 1; k < points.size(); ++k) {
    EXPECT_GT(points[k]["duration_s"], points[k - 1]["duration_s"]);
    EXPECT_LT(points[k]["energy_J"], points[k - 1]["energy_J"]);
  }
  std::size_t beside = 0;
  for (const auto& profile : front["baselines"]) {
    if (!profile["feasible"].get<bool>()) continue;
    ++beside;
    const double optimum_J = profile["optimum_J"], energy_J = profile["energy_J"];
    EXPECT_GE(energy_J, optimum_J * (1 - 1e-4)) << profile;
    EXPECT_GE(profile["duration_s"].get<double>(), points[0]["duration_s"].get<double>() * (1 - 1e-6));
  }
  EXPECT_GE(beside, 3 * 8u) << "three points, most of the ten profiles";
}

TEST(CommandLine, APlanSaysWhyAClassicProfileIsInfeasible) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("path.csv", "x_m,y_m,corner_radius_m\n0,0,\n2,0,0.4\n2,2,\n");
  std::string robot = text_of(kRobot);
  const std::string current = "max_current_A: 8.0";
  robot.replace(robot.find(current), current.size(), "max_current_A: 0.55");
  const auto result = run_program(scratch, "plan " + path + " --robot " + scratch.write("robot.yaml", robot) +
                                               " --confidence 0.9 --out " + scratch.at("out"));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("trapezoid_max_acceleration: cannot meet the time"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find(" >0.999"), std::string::npos) << "no blank where a line can be folded";
}

/// The second curve leaves margins, of the battery too: its fastest drive is later.
TEST(CommandLine, AFrontWithAConfidenceIsLaterByItsMargins) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("path.csv", "x_m,y_m,corner_radius_m\n0,0,\n2,0,0.4\n2,2,\n");
  std::string robot = text_of(kRobot);
  const std::string current = "max_current_A: 8.0";
  robot.replace(robot.find(current), current.size(), "max_current_A: 0.55");
  const auto result =
      run_program(scratch, "front " + path + " --robot " + scratch.write("robot.yaml", robot) +
                               " --nodes 40 --points 3 --baselines 0 --confidence 0.9 --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto front = nlohmann::json::parse(result.out);
  const auto& sure = front["confidence"];
  EXPECT_EQ(sure["asked"], 0.9);
  EXPECT_LT(sure["limit_shares"]["motor_current"], 1.0);
  EXPECT_GT(sure["reserve_margin_fraction"], 0.0);
  EXPECT_GT(sure["points"][0]["duration_s"], front["points"][0]["duration_s"]);
  std::size_t judged = 0;
  for (const auto& point : sure["points"]) {
    if (!point.contains("kept_at_least")) continue;
    ++judged;
    EXPECT_GE(point["kept_at_least"], 0.9) << point;
    EXPECT_LT(point["kept"], 1.0) << point;
  }
  EXPECT_EQ(judged, 3u);
}

TEST(CommandLine, AProofIsToldWithWhatItIsAbout) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("path.csv", "x_m,y_m\n0,0\n2,0.5\n4,0\n");
  const auto told = [&](const std::string& robot, const std::string& out) {
    const auto result = run_program(
        scratch, "plan " + path + " --nodes 40 --solver fast --robot " + robot + " --out " + scratch.at(out));
    EXPECT_EQ(result.code, 0) << result.err;
    return result.out;
  };
  EXPECT_NE(told(kRobot, "a").find("optimal on these paths, gap to the bound there <= "), std::string::npos);
  const std::string jerk = told(JOULEPATH_SOURCE_DIR "/scenarios/robots/amr_150kg.yaml", "b");
  EXPECT_NE(jerk.find(" on these paths"), std::string::npos) << jerk;
  EXPECT_NE(jerk.find("gap to the bound without the jerk limit <= "), std::string::npos) << jerk;
}

TEST(CommandLine, BadInputIsOneLineOnStandardError) {
  const ScratchDirectory scratch;
  for (const char* file :
       {"robot/not_a_number.yaml", "mission/map_file_missing.yaml", "log/time_backward.csv"}) {
    const auto result = run_program(scratch, "check " + kBroken + file);
    EXPECT_EQ(result.code, 2) << file;
    EXPECT_EQ(result.out, "") << file;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.err.rfind("joulepath: ", 0), 0u) << "colored though it is no terminal: " << result.err;
  }
}

TEST(CommandLine, AGraphForMoreThanTheRobotMayCarryIsRefused) {
  const ScratchDirectory scratch;
  const std::string maps = JOULEPATH_SOURCE_DIR "/scenarios/maps/",
                    robots = JOULEPATH_SOURCE_DIR "/scenarios/robots/";
  for (const char* payload : {"12.5", "1e9"}) {
    const auto result = run_program(scratch, "export " + maps + "depot_graph.geojson --robot " + robots +
                                                 "nomad_super_scout.yaml --to route_graph --out " +
                                                 scratch.at("g.geojson") + " --payload " + payload);
    EXPECT_EQ(result.code, 2) << payload;
    EXPECT_NE(result.err.find("at most"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.at("g.geojson")));
  }
}

/// Without the statement of what the runs tell apart, which takes most of the time.
TEST(CommandLine, ABriefCheckHoldsTheDataChecksAlone) {
  const ScratchDirectory scratch;
  const std::string dataset = kBroken + "good/dataset.yaml";
  const auto brief = nlohmann::json::parse(run_program(scratch, "check --json --brief " + dataset).out)[0];
  const auto whole = nlohmann::json::parse(run_program(scratch, "check --json " + dataset).out)[0];
  EXPECT_TRUE(brief.contains("data_checks"));
  EXPECT_FALSE(brief.contains("isolability"));
  EXPECT_TRUE(whole.contains("isolability"));
}

/// Eight times the mass: no fault of a channel. Another motor: faults of channels, after the question.
TEST(CommandLine, CheckAsksForTheRobotOfTheRunsFirst) {
  const ScratchDirectory scratch;
  ASSERT_EQ(run_program(scratch, "init -q " + scratch.at("start")).code, 0);
  const std::string day = text_of(scratch.at("start/dataset.yaml")),
                    robot = text_of(scratch.at("start/robot.yaml"));
  const auto replaced = [](std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    return at == std::string::npos ? text : text.replace(at, what.size(), by);
  };
  scratch.write("start/heavy.yaml", replaced(robot, "chassis_mass_kg: 21.2", "chassis_mass_kg: 169.6"));
  scratch.write("start/amr.yaml", text_of(JOULEPATH_SOURCE_DIR "/scenarios/robots/amr_150kg.yaml"));
  for (const std::string name : {"heavy.yaml", "amr.yaml"}) {
    const std::string dataset =
        scratch.write("start/other.yaml", replaced(day, "robot: robot.yaml", "robot: " + name));
    const auto told = run_program(scratch, "check --brief " + dataset);
    EXPECT_EQ(told.code, 1) << told.out;
    const auto asked = told.out.find(name + " the right robot file? ");
    EXPECT_NE(asked, std::string::npos) << told.out;
    EXPECT_LT(asked, told.out.find("scaled. ")) << told.out;
    const auto json = nlohmann::json::parse(run_program(scratch, "check --json --brief " + dataset).out)[0];
    EXPECT_FALSE(json.at("ok").get<bool>());
    EXPECT_TRUE(json.contains("question"));
  }
  const auto own = run_program(scratch, "check --brief " + scratch.at("start/dataset.yaml"));
  EXPECT_EQ(own.code, 0) << own.out;
  EXPECT_EQ(own.out.find("right robot file"), std::string::npos) << own.out;
}

TEST(CommandLine, CheckContinuesAfterABadFileAndReportsAllAsJson) {
  const ScratchDirectory scratch;
  const auto result = run_program(
      scratch, "check --json " + kBroken + "robot/negative_mass.yaml " + kBroken + "good/robot.yaml");
  EXPECT_EQ(result.code, 2);
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json.size(), 2u);
  EXPECT_FALSE(json[0]["ok"].get<bool>());
  EXPECT_EQ(json[0]["error"]["line"], 5);
  EXPECT_EQ(json[0]["error"]["key"], "inertia.chassis_mass_kg");
  EXPECT_TRUE(json[1]["ok"].get<bool>());
  EXPECT_EQ(json[1]["kind"], "robot");
}

TEST(CommandLine, AWriteThatTheDiskRefusesIsAnEnvironmentError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const ScratchDirectory scratch;
  for (const char* arguments : {"schema robot", "--help", "plan --help"}) {
    const std::string command =
        std::string("'" JOULEPATH_PROGRAM "' ") + arguments + " > /dev/full 2>/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 4) << arguments;
  }
}

/// Three meters with a deadline, as m.yaml.
void write_drive(const ScratchDirectory& scratch, double deadline_s) {
  scratch.write("robot.yaml", text_of(JOULEPATH_SOURCE_DIR "/tests/data/broken/good/robot.yaml"));
  scratch.write(
      "m.yaml",
      "schema: joulepath/mission/1\nrobot: robot.yaml\nlegs:\n"
      "  - {path: {bezier_m: [[[0, 0], [1, 0], [2, 0], [3, 0]]]}, dwell_s: 3}\nobjective: {deadline_s: " +
          std::to_string(deadline_s) + "}\n");
}

/// Every help, and the summaries of plans, on a terminal of 110 columns.
TEST(CommandLine, NoLineIsWiderThanOneHundredAndTenColumns) {
  const ScratchDirectory scratch;
  const auto check = [](const std::string& text, const std::string& what) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << what << ": " << line;
  };
  const std::string help = run_program(scratch, "--help").out;
  check(help, "--help");
  std::istringstream lines(help.substr(help.find("Subcommands:")));
  for (std::string line; std::getline(lines, line);)
    if (line.size() > 3 && line.starts_with("  ") && line[2] != ' ') {
      const std::string command = line.substr(2, line.find(' ', 2) - 2);
      check(run_program(scratch, command + " --help").out, command);
    }
  write_drive(scratch, 20);
  const std::string mission = " " + scratch.at("m.yaml") + " --nodes 20 --out ";
  check(run_program(scratch, "plan" + mission + scratch.at("p")).out, "plan");
  check(run_program(scratch, "compare" + mission + scratch.at("c")).out, "compare");
  check(run_program(scratch, "front --points 4" + mission + scratch.at("f")).out, "front");
}

/// The text of a terminal with its folded lines put together again, as a pipe gets them.
std::string unfolded(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
  return text;
}

/// Errors, notes and summaries on a terminal; a pipe gets whole lines, as other programs read them by line.
TEST(CommandLine, NoLineOnATerminalIsWiderThanOneHundredAndTenColumns) {
  const ScratchDirectory scratch;
  if (shown_on_terminal("--version").empty()) GTEST_SKIP() << "no terminal here";
  write_drive(scratch, 1);
  ASSERT_EQ(run_program(scratch, "init -q " + scratch.at("start")).code, 0);
  const std::string broken = kBroken + "mission/unknown_leg_key.yaml", drive = scratch.at("m.yaml"),
                    start = scratch.at("start/"), out = " --force --out " + scratch.at("out");
  std::size_t long_lines = 0;
  for (const std::string& command :
       {"check " + broken + " " + drive,
        "check --brief " + start + "dataset.yaml " + kBroken + "robot/other_kind.yaml",
        "plan " + broken + out, "plan --no-such-option-of-this-command " + drive + out,
        "diagnose " + start + "dataset.yaml" + out, "diagnose " + broken + out,
        "calibrate " + start + "dataset.yaml --force --out " + scratch.at("calibrated.yaml"),
        "batch " + kBroken + "mission -q --nodes 20" + out, "export " + drive + " --to no_such_format" + out,
        "front " + drive + " --nodes 20" + out}) {
    const ProgramResult piped = run_program(scratch, command);
    const std::string shown = shown_on_terminal(command);
    EXPECT_FALSE(shown.empty()) << command;
    std::istringstream lines(shown);
    for (std::string line; std::getline(lines, line);) {
      const bool is_one_name = line.find_last_of(' ') + 1 == line.find_first_not_of(' ');
      EXPECT_TRUE(line.size() <= 110 || is_one_name) << command << ": " << line;
    }
    std::istringstream whole(piped.err);
    for (std::string line; std::getline(whole, line);) {
      long_lines += line.size() > 110 ? 1 : 0;
      EXPECT_NE(unfolded(shown).find(unfolded(line)), std::string::npos) << command << ": " << line << shown;
    }
  }
  EXPECT_GT(long_lines, 3u) << "in the pipe";
  const std::string command = "check --json " + broken;
  EXPECT_EQ(shown_on_terminal(command), run_program(scratch, command).out);
}

/// Check tries a mission: a deadline that no drive meets is a note, a stop in a wall an error of the file.
TEST(CommandLine, CheckTriesAMissionCoarsely) {
  const ScratchDirectory scratch;
  write_drive(scratch, 1);
  const auto notes = [&](const std::string& options) {
    return run_program(scratch, "check " + scratch.at("m.yaml") + options).err;
  };
  EXPECT_NE(notes("").find("tried coarsely: deadline on leg 1 (path)"), std::string::npos) << notes("");
  EXPECT_EQ(notes(" --brief"), "");
  write_drive(scratch, 30);
  EXPECT_EQ(notes(""), "");
  scratch.write(
      "hall.pgm", "P2\n40 20\n255\n" + [] {
        std::string cells;
        for (int k = 0; k < 800; ++k) cells += k % 40 > 25 ? "0 " : "254 ";
        return cells;
      }());
  scratch.write("map.yaml",
                "image: hall.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
                "occupied_thresh: 0.65\nfree_thresh: 0.2\n");
  scratch.write("m.yaml",
                "schema: joulepath/mission/1\nrobot: robot.yaml\nmap: map.yaml\nstations:\n"
                "  shelf: {x_m: 3.5, y_m: 1}\nstart: {x_m: 1, y_m: 1}\nlegs:\n  - {to: shelf}\n");
  const auto walled = run_program(scratch, "check " + scratch.at("m.yaml"));
  EXPECT_EQ(walled.code, 2);
  EXPECT_NE(walled.err.find("m.yaml:5:10: stations.shelf: found a goal where the robot does not fit"),
            std::string::npos)
      << walled.err;
}

/// A folder with a plan is safe from the next one; a folder with a verdict is free for it.
TEST(CommandLine, AnInfeasibleTryDoesNotBlockItsFolder) {
  const ScratchDirectory scratch;
  const auto plan = [&](double time_s) {
    write_drive(scratch, time_s);
    return run_program(scratch, "plan " + scratch.at("m.yaml") + " -q --nodes 20 --out " + scratch.at("out"));
  };
  EXPECT_EQ(plan(1).code, 1);
  EXPECT_EQ(plan(2).code, 1) << "the second try";
  EXPECT_EQ(plan(20).code, 0);
  const ProgramResult again = plan(20);
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("--force"), std::string::npos) << again.err;
}

TEST(CommandLine, InterruptedMeansOneHundredAndThirty) {
  const ScratchDirectory scratch;
  const std::string command = "timeout --preserve-status -s INT 0.3 '" JOULEPATH_PROGRAM
                              "' plan '" JOULEPATH_SOURCE_DIR
                              "/scenarios/missions/warehouse_pick.yaml' --out '" +
                              scratch.at("out") + "' >/dev/null 2>&1";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130);
}

TEST(CommandLine, CompletionListsEveryCommandAndIsValidBash) {
  const ScratchDirectory scratch;
  const std::string help = run_program(scratch, "--help").out,
                    bash = run_program(scratch, "completion bash").out;
  for (const char* command : {"check", "plan", "schema", "init", "completion"})
    EXPECT_NE(bash.find(std::string("    ") + command + ") words="), std::string::npos) << command;
  EXPECT_EQ(std::system(("bash -n '" + scratch.write("c.sh", bash) + "'").c_str()), 0);
  const auto completed = scratch.write(
      "t.sh",
      "source '" + scratch.at("c.sh") +
          "'; COMP_WORDS=(joulepath sch); COMP_CWORD=1; _joulepath; [ \"${COMPREPLY[*]}\" = schema ]");
  EXPECT_EQ(std::system(("bash '" + completed + "'").c_str()), 0);
}

TEST(Init, WritesAStarterThatIsRightAndPlansAtOnce) {
  const ScratchDirectory scratch;
  const std::string folder = scratch.at("starter");
  ASSERT_EQ(run_program(scratch, "init " + folder).code, 0);
  for (const char* file : {"robot.yaml", "map.yaml", "mission.yaml", "dataset.yaml"})
    EXPECT_NO_THROW(static_cast<void>(read_any_file(folder + "/" + file))) << file;
  const auto plan = run_program(scratch, "plan " + folder + "/mission.yaml --out " + folder + "/out");
  EXPECT_EQ(plan.code, 0) << plan.err;
  EXPECT_TRUE(std::filesystem::exists(folder + "/out/trajectory.csv"));
  EXPECT_EQ(run_program(scratch, "check " + folder + "/out/trajectory.csv " + folder + "/out/plan.json").err,
            "")
      << "nothing is odd about a plan";
  EXPECT_EQ(run_program(scratch, "init " + folder).code, 2) << "it must not overwrite";
  EXPECT_EQ(run_program(scratch, "init --force " + folder).code, 0);
}

}  // namespace
}  // namespace joulepath
