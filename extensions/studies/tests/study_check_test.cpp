// A study file with a mistake is refused before the first plan.
#include <gtest/gtest.h>

#include <filesystem>

#include "extensions/studies/tests/sweep_fixture.hpp"

namespace joulepath {
namespace {

TEST_F(Sweep, AMistakeInTheStudyIsToldAtItsPlace) {
  const auto refused = [&](const std::string& parameters, const std::string& place, const std::string& word) {
    const auto done = sweep("missions: mission.yaml\nparameters:\n" + parameters);
    EXPECT_EQ(done.code, 2) << done.err;
    EXPECT_NE(done.err.find(place), std::string::npos) << done.err;
    EXPECT_NE(done.err.find(word), std::string::npos) << done.err;
    EXPECT_FALSE(std::filesystem::exists(scratch.at("out")));
  };
  refused("  a: {key: robot.motor.gear_ration, values: [1]}\n", "study.yaml:3", "gear_ratio");
  refused("  a: {key: robot.motor.gear_ratio, values: [-3, 10]}\n", "study.yaml:3", "-3");
  refused("  a: {key: 'mission.legs[7].payload_kg', values: [1]}\n", "study.yaml:3", "counted from 0");
  refused("  a: {key: limits.speed_m_s, values: [1]}\n", "study.yaml:3", "robot.limits.speed_m_s");
  refused("  a: {key: robot., values: [1]}\n", "study.yaml:3", "robot.KEY or mission.KEY");
  refused("  a: {key: robot..motor.gear_ratio, values: [1]}\n", "study.yaml:3",
          "keys with a point between them");
  refused("  a: {key: robot.limits.speed_m_s, from: 2, to: 1}\n", "study.yaml:3", "> from");
  for (const std::string column : {"energy_J", "design", "mission", "status", "meets_constraints", "reason"})
    refused("  " + column + ": {key: robot.limits.speed_m_s, values: [1]}\n", "study.yaml:3", column);
  const std::string payload = "  a: {key: 'mission.legs[*].payload_kg', values: [1]}\n";
  refused(payload + "  b: {key: 'mission.legs[0].payload_kg', values: [2]}\n", "study.yaml:4", "parameter a");
  refused(payload + "  b: {key: 'mission.legs[*].payload_kg', values: [2]}\n", "study.yaml:4", "parameter a");
  refused("  a: {key: robot.motor.gear_ratio, values: [1, 2], to: 3}\n", "study.yaml:3", "a.to");
  refused("  a: {key: robot.motor.gear_ratio, values: [1, 2], scale: log}\n", "study.yaml:3", "a.scale");
  const std::string mass = "  a: {key: robot.inertia.chassis_mass_kg, ";
  refused(mass + "values: [20, -3, 30]}\n", "study.yaml:3", "-3");
  refused(mass + "values: [20, 25, 30], from: 3}\n", "study.yaml:3", "values");
  const std::string range = mass + "from: -1, to: 90}\n";
  refused(range + "sampling: {method: latin_hypercube, designs: 9}\n", "study.yaml:3", "-1 for inertia");
  const std::string good = mass + "from: 10, to: 90, count: 2}\n";
  refused(good + "sampling: {method: grid, designs: 9}\n", "study.yaml:4", "latin_hypercube");
  refused(good + "constraints: {duration_s: {min: 9, max: 8}}\n", "study.yaml:4", "<= max");
  refused("  kind: {key: mission.objective.minimize, values: [time, energy]}\nobjectives: {kind: minimize}\n",
          "study.yaml:4", "a parameter with the value time");
}

TEST_F(Sweep, DesignsThatWouldBePlannedTwiceAreRefused) {
  const auto refused = [&](const std::string& study, const std::string& place, const std::string& word) {
    const auto done = sweep(study);
    EXPECT_EQ(done.code, 2) << done.err;
    EXPECT_NE(done.err.find(place), std::string::npos) << done.err;
    EXPECT_NE(done.err.find(word), std::string::npos) << done.err;
    EXPECT_EQ(run_program(scratch, "check " + scratch.at("study.yaml")).code, 2);
  };
  const std::string gear = "parameters:\n  a: {key: robot.motor.gear_ratio, ";
  refused("missions: mission.yaml\n" + gear + "values: [10, 20, 10.0]}\n", "study.yaml:3", "each value once");
  refused("missions: mission.yaml\n" + gear + "from: 10, to: 10.000000000000002}\n", "study.yaml:3",
          "more than rounding");
  refused("missions: mission.yaml\nsampling: {method: latin_hypercube, designs: 3}\n" + gear +
              "from: 10, to: 20, count: 3}\n",
          "study.yaml:4", "on a grid");
  refused("missions: mission.yaml\nparameters:\n  '': {key: robot.motor.gear_ratio, values: [10]}\n",
          "study.yaml:3", "an empty name");
  std::filesystem::create_directory(scratch.at("folder"));
  std::filesystem::create_symlink(scratch.at("mission.yaml"), scratch.at("folder/again.yaml"));
  refused("missions: [mission.yaml, mission.yaml]\n" + gear + "values: [10]}\n", "missions[1]", "already");
  refused("missions: [mission.yaml, folder]\n" + gear + "values: [10]}\n", "missions[1]", "already");
}

TEST_F(Sweep, MissionsThatDoNotExistAreToldAtTheStudy) {
  std::filesystem::create_directory(scratch.at("empty"));
  for (const std::string source : {"nowhere", "nowhere.yaml", "nowhere.jsonl", "empty"}) {
    const std::string file =
        scratch.write("study.yaml", "missions: [mission.yaml, " + source +
                                        "]\nparameters: {a: {key: robot.motor.gear_ratio, values: [10]}}\n");
    for (const std::string& command : {"check " + file, "sweep " + file + " --out " + scratch.at("out")}) {
      const auto done = run_program(scratch, command);
      EXPECT_EQ(done.code, 2) << command;
      EXPECT_NE(done.err.find("study.yaml:1:"), std::string::npos) << done.err;
      EXPECT_NE(done.err.find(source), std::string::npos) << done.err;
    }
    EXPECT_FALSE(std::filesystem::exists(scratch.at("out")));
  }
}

TEST_F(Sweep, CheckReadsEveryMission) {
  scratch.write("other.yaml", "robot: robot.yaml\nlegs:\n  - {pth: 3}\n");
  const std::string file = scratch.write("study.yaml",
                                         "missions: [mission.yaml, other.yaml]\n"
                                         "parameters: {a: {key: robot.motor.gear_ratio, values: [10]}}\n");
  const auto done = run_program(scratch, "check " + file);
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("other.yaml:3"), std::string::npos) << done.err;
}

TEST_F(Sweep, OptimizeWithoutARangeIsRefusedBeforeTheSweep) {
  const auto done =
      sweep("missions: mission.yaml\nparameters: {a: {key: robot.motor.gear_ratio, values: [10, 20]}}\n",
            "--optimize 5");
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("from and to"), std::string::npos) << done.err;
  EXPECT_FALSE(std::filesystem::exists(scratch.at("out")));
}

TEST_F(Sweep, CheckFindsTheMistakesOfTheDesigns) {
  const std::string file = scratch.write(
      "study.yaml", "missions: mission.yaml\nparameters: {a: {key: robot.motor.gear_ration, values: [1]}}\n");
  const auto done = run_program(scratch, "check " + file);
  EXPECT_EQ(done.code, 2) << done.err;
  EXPECT_NE(done.err.find("gear_ratio"), std::string::npos) << done.err;
}

}  // namespace
}  // namespace joulepath
