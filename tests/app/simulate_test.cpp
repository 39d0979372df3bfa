#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program_result.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

const std::string kNomadFile = JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml";

std::string mission(const ScratchDirectory& scratch) {
  const std::string file = scratch.at("mission.yaml");
  std::ofstream(file)
      << "schema: joulepath/mission/1\nrobot: " << kNomadFile
      << "\nstart: {x_m: 1, y_m: 2, heading_rad: 0.5}\nlegs:\n"
         "  - {motion: {profile: constant_ramp, acceleration_m_s2: 0.2, ramp_s: 3, distance_m: 4}, "
         "payload_kg: 5, dwell_s: 1}\n"
         "  - {motion: {profile: spin, angle_rad: 1.5, yaw_rate_rad_s: 0.8}, payload_kg: 2}\n";
  return file;
}

nlohmann::json parsed(const std::string& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

TEST(SimulateCommand, ItsLogsReadBackAndTheirEnergyIsEstimated) {
  const ScratchDirectory scratch;
  const std::string out = scratch.at("sim");
  const auto simulated = run_program(scratch, "simulate " + mission(scratch) + " --repeat 3 --out " + out);
  ASSERT_EQ(simulated.code, 0) << simulated.err;
  EXPECT_EQ(run_program(scratch, "check " + out + "/dataset.yaml " + out + "/robot.yaml").code, 0);
  const auto estimated = run_program(scratch, "estimate --json " + out + "/dataset.yaml");
  ASSERT_EQ(estimated.code, 0) << estimated.err;
  const auto report = nlohmann::json::parse(estimated.out);
  EXPECT_EQ(report["compared_runs"], 3);
  EXPECT_EQ(report["fitness_percent"], 100.0);
  EXPECT_LT(std::abs(report["mean_error_percent"].get<double>()), 1.5);
}

TEST(SimulateCommand, PlannedAndExecutedAgreeWithoutEffectsAndPartWithThem) {
  const ScratchDirectory scratch;
  const std::string file = mission(scratch);
  ASSERT_EQ(run_program(scratch, "simulate " + file + " --ideal-sensors --out " + scratch.at("a")).code, 0);
  ASSERT_EQ(run_program(scratch, "simulate " + file +
                                     " --effect rolling_resistance:coefficient=0.02 "
                                     "--effect dragging_wheel:side=left,torque_Nm=0.1 --out " +
                                     scratch.at("b"))
                .code,
            0);
  const auto plain = parsed(scratch.at("a") + "/simulation.json")["runs"][0];
  const auto heavy = parsed(scratch.at("b") + "/simulation.json");
  EXPECT_NEAR(plain["difference"]["motion_energy_percent"].get<double>(), 0.0, 1.0);
  EXPECT_LT(plain["difference"]["position_m"].get<double>(), 0.01);
  EXPECT_GT(heavy["runs"][0]["difference"]["motion_energy_percent"].get<double>(), 20.0);
  EXPECT_EQ(heavy["effects"][1]["dragging_wheel"]["side"], "left");
}

TEST(SimulateCommand, APlansDirectoryIsDriven) {
  const ScratchDirectory scratch;
  const std::string plan = scratch.at("plan");
  ASSERT_EQ(run_program(scratch, "plan " + mission(scratch) + " --out " + plan).code, 0);
  const auto result = run_program(
      scratch, "simulate " + plan + " --robot " + kNomadFile + " --json --out " + scratch.at("sim"));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto run = nlohmann::json::parse(result.out)["runs"][0];
  EXPECT_EQ(run["planned"]["energy_J"], parsed(plan + "/plan.json")["energy_J"]);
  EXPECT_NEAR(run["difference"]["energy_percent"].get<double>(), 0.0, 1.0);
  EXPECT_EQ(run_program(scratch, "simulate " + plan + " --out " + scratch.at("other")).code, 2);
}

TEST(SimulateCommand, TheSameSeedGivesTheSameBytes) {
  const ScratchDirectory scratch;
  const auto log = [&](const std::string& name, int seed) {
    const std::string out = scratch.at(name);
    EXPECT_EQ(run_program(scratch, "simulate " + mission(scratch) + " --seed " + std::to_string(seed) +
                                       " --out " + out)
                  .code,
              0);
    std::ifstream stream(out + "/run_01.csv");
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  const std::string a = log("a", 5);
  EXPECT_EQ(a, log("b", 5));
  EXPECT_NE(a, log("c", 6));
}

/// Days of neighboring seeds share no run, and each run's own seed is stated.
TEST(SimulateCommand, NeighboringSeedsShareNoRun) {
  const ScratchDirectory scratch;
  std::set<std::string> logs;
  std::set<std::uint64_t> seeds;
  for (const int seed : {1, 2, 3}) {
    const std::string out = scratch.at("day_" + std::to_string(seed));
    ASSERT_EQ(run_program(scratch, "simulate " + mission(scratch) + " --repeat 4 --seed " +
                                       std::to_string(seed) + " --out " + out)
                  .code,
              0);
    const nlohmann::json simulation = parsed(out + "/simulation.json");
    for (const auto& run : simulation["runs"]) {
      std::ifstream stream(out + "/" + run["file"].get<std::string>());
      logs.insert({std::istreambuf_iterator<char>(stream), {}});
      seeds.insert(run["seed"].get<std::uint64_t>());
    }
    EXPECT_EQ(simulation["runs"][0]["seed"], seed);
  }
  EXPECT_EQ(logs.size(), 12u);
  EXPECT_EQ(seeds.size(), 12u);
}

TEST(SimulateCommand, WrongInputsAreToldInOneLine) {
  const ScratchDirectory scratch;
  const std::string file = mission(scratch);
  for (const std::string& arguments :
       {std::string("simulate /no/such/file --out ") + scratch.at("x"),
        "simulate " + file + " --effect no_such_effect:x=1 --out " + scratch.at("x"),
        "simulate " + file + " --effect rolling_resistance:coefficient=much --out " + scratch.at("x"),
        "simulate " + file + " --effect dragging_wheel:torque_Nm=0.1 --out " + scratch.at("x"),
        "simulate " + file + " --repeat 0 --out " + scratch.at("x"), std::string("estimate run.csv"),
        std::string("effects --json --markdown")}) {
    const auto result = run_program(scratch, arguments);
    EXPECT_EQ(result.code, 2) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_FALSE(result.err.empty()) << arguments;
  }
}

TEST(SimulateCommand, AMisspelledEffectOrParameterIsNamedWithTheNearestOne) {
  const ScratchDirectory scratch;
  const auto told = [&](const std::string& effect) {
    return run_program(scratch,
                       "simulate " + mission(scratch) + " --effect " + effect + " --out " + scratch.at("x"))
        .err;
  };
  const std::string parameter = told("dragging_wheel:side=left,torque=0.15"),
                    effect = told("draging_wheel:side=left,torque_Nm=0.15");
  EXPECT_NE(parameter.find("--effect: dragging_wheel.torque: found an unknown key"), std::string::npos)
      << parameter;
  EXPECT_NE(parameter.find("did you mean torque_Nm?"), std::string::npos) << parameter;
  EXPECT_NE(effect.find("--effect: draging_wheel: found an unknown key"), std::string::npos) << effect;
  EXPECT_NE(effect.find("did you mean dragging_wheel?"), std::string::npos) << effect;
}

TEST(EffectsCommand, ListsEveryEffectWithUnitsAndRange) {
  const ScratchDirectory scratch;
  const auto json = nlohmann::json::parse(run_program(scratch, "effects --json").out);
  EXPECT_GE(json["effects"].size(), 29u);
  for (const auto& effect : json["effects"])
    for (const auto& parameter : effect["parameters"]) {
      EXPECT_FALSE(parameter["unit"].get<std::string>().empty()) << effect["name"];
      EXPECT_LT(parameter["min"].get<double>(), parameter["max"].get<double>()) << effect["name"];
    }
}

}  // namespace
}  // namespace joulepath
