#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/build_id.hpp"
#include "app/jobs/sweep_jobs.hpp"
#include "model/number_text.hpp"
#include "tests/app/program_result.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

/// A robot with closed forms for everything: Coulomb friction only, all braking power is recovered.
constexpr double kResistance_ohm = 1.5, kTorqueConstant_Nm_A = 0.05, kMass_kg = 30.0, kRadius_m = 0.1,
                 kFriction_Nm = 0.4, kGear = 20.0, kDistance_m = 6.0, kTime_s = 8.0;
const std::string kSimpleRobot = R"(
geometry: {wheel_radius_m: 0.1, half_track_m: 0.2}
inertia: {chassis_mass_kg: 30, wheel_mass_kg: 0, chassis_yaw_inertia_kg_m2: 1, payload_yaw_inertia_m2: 0,
          wheel_axle_inertia_kg_m2: 0, wheel_diameter_inertia_kg_m2: 0}
motor: {gear_ratio: 20, resistance_ohm: 1.5, torque_constant_Nm_A: 0.05, voltage_constant_V_s_rad: 0.05,
        viscous_friction_Nm_s_rad: 0, friction_torque_Nm: 0.4}
limits: {speed_m_s: 3, acceleration_m_s2: 2, max_payload_kg: 20}
power: {standby_W: 0, regeneration_efficiency: 1, sharing: bus}
battery: {capacity_Wh: 100}
)";
const std::string kMission =
    "robot: robot.yaml\nlegs:\n  - {path: {bezier_m: [[[0, 0], [2, 0], [4, 0], [6, 0]]]}, duration_s: 8}\n";

class Sweep : public testing::Test {
 protected:
  Sweep() {
    scratch.write("robot.yaml", kSimpleRobot);
    scratch.write("mission.yaml", kMission);
  }

  ProgramResult sweep(const std::string& study, const std::string& more = "") {
    const std::string file = scratch.write("study.yaml", study);
    return run_program(scratch,
                       "sweep " + file + " -q --nodes 100 --force --out " + scratch.at("out") + " " + more);
  }
  Json result() const { return Json::parse(text_of(scratch.at("out/sweep.json"))); }

  ScratchDirectory scratch;
};

/// Rest to rest with minimal copper heat, v(t) is a parabola: the integral of a² is 12 D²/T³. With friction
/// held at the motor's shaft (T_s = T/n0), E(n) = const + 2 (R/Kt²) (m r/2)² 12 D²/T³ / n² + 2 n T_s D/r.
TEST_F(Sweep, OptimizedGearRatioIsThatOfTheClosedForm) {
  const double heat = kResistance_ohm / std::pow(kTorqueConstant_Nm_A, 2) *
                      std::pow(kMass_kg * kRadius_m / 2, 2) * 12 * std::pow(kDistance_m, 2) /
                      std::pow(kTime_s, 3);
  const double best = std::cbrt(2 * heat / (kFriction_Nm / kGear * kDistance_m / kRadius_m));
  const auto done = sweep(
      "missions: mission.yaml\nhold_friction: motor\n"
      "parameters: {gear: {key: robot.motor.gear_ratio, from: 4, to: 60, count: 6, scale: log}}\n",
      "--optimize 60");
  ASSERT_EQ(done.code, 0) << done.err;
  const Json found = result()["optimized"];
  EXPECT_NEAR(found["parameters"]["gear"].get<double>(), best, 0.01 * best) << found;
  EXPECT_LE(found["energy_J"].get<double>(), result()["best"]["energy_J"].get<double>());
  EXPECT_NE(text_of(scratch.at("out/sweep.json")).find("motor's shaft"), std::string::npos);
}

TEST_F(Sweep, ASearchWithoutABetterDesignKeepsTheBestOne) {
  ASSERT_EQ(
      sweep("missions: mission.yaml\nhold_friction: motor\nsampling: {method: latin_hypercube, designs: 9}\n"
            "parameters: {gear: {key: robot.motor.gear_ratio, from: 7, to: 61, scale: log}}\n",
            "--optimize 1")
          .code,
      0);
  EXPECT_EQ(result()["optimized"]["parameters"], result()["best"]["parameters"]);
  EXPECT_EQ(result()["optimized"]["energy_J"], result()["best"]["energy_J"]);
}

/// With friction held at the wheel, only the copper heat of acceleration depends on the ratio, as 1/n².
TEST_F(Sweep, FrictionHeldAtTheWheelLeavesTheHeatOfAcceleration) {
  ASSERT_EQ(
      sweep(
          "missions: mission.yaml\nparameters: {gear: {key: robot.motor.gear_ratio, values: [10, 20, 40]}}\n")
          .code,
      0);
  std::istringstream rows(text_of(scratch.at("out/sweep.csv")));
  std::vector<double> energy_J;
  std::string line;
  std::getline(rows, line);
  EXPECT_EQ(line.rfind("design,mission,gear,status,meets_constraints,reason,energy_J,", 0), 0u);
  while (std::getline(rows, line)) {
    std::vector<std::string> fields;
    std::istringstream row(line);
    for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
    energy_J.push_back(std::stod(fields[6]));
  }
  ASSERT_EQ(energy_J.size(), 3u);
  const double inertia_heat_J = 2 * kResistance_ohm / std::pow(kTorqueConstant_Nm_A, 2) *
                                std::pow(kMass_kg * kRadius_m / 2, 2) * 12 * std::pow(kDistance_m, 2) /
                                std::pow(kTime_s, 3);
  const double friction_heat =
      2 * kResistance_ohm / std::pow(kTorqueConstant_Nm_A, 2) * std::pow(kFriction_Nm, 2) * kTime_s;
  const double full = inertia_heat_J + friction_heat;
  EXPECT_NEAR((energy_J[0] - energy_J[1]) / (full / 100 - full / 400), 1.0, 2e-3);
  EXPECT_NEAR((energy_J[1] - energy_J[2]) / (full / 400 - full / 1600), 1.0, 2e-3);
}

TEST_F(Sweep, DesignsThatFailHaveTheirReason) {
  ASSERT_EQ(sweep("missions: mission.yaml\nconstraints: {energy_J: {max: 60}}\n"
                  "objectives: {energy_J: minimize, payload: maximize}\n"
                  "parameters:\n  payload: {key: 'mission.legs[*].payload_kg', values: [0, 15, 30]}\n"
                  "  speed: {key: robot.limits.speed_m_s, values: [0.5, 2]}\n")
                .code,
            0);
  const Json json = result();
  EXPECT_EQ(json["designs"], 6);
  const std::string csv = text_of(scratch.at("out/sweep.csv"));
  EXPECT_NE(csv.find("infeasible,no,"), std::string::npos) << csv;  // 6 m in 8 s at 0.5 m/s
  EXPECT_EQ(csv.find("bad_input"), std::string::npos) << csv;
  EXPECT_NE(csv.find("the payload exceeds"), std::string::npos) << csv;  // 30 kg
  EXPECT_NE(json["not_counted"].dump().find("infeasible"), std::string::npos) << json["not_counted"];
  for (const auto& design : json["pareto"]) EXPECT_LE(design["energy_J"], 60.0);
}

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

TEST_F(Sweep, ABoundHoldsUpToRounding) {
  const std::string study =
      "missions: mission.yaml\nparameters: {a: {key: robot.motor.gear_ratio, values: [20]}}\n";
  ASSERT_EQ(sweep(study).code, 0);
  const double energy_J = result()["best"]["energy_J"];
  for (const auto& [relative, within] : {std::pair{1e-12, 1}, {1e-6, 0}}) {
    ASSERT_EQ(
        sweep(study + "constraints: {energy_J: {max: " + number_text(energy_J * (1 - relative)) + "}}\n")
            .code,
        0);
    EXPECT_EQ(result()["within_constraints"], within) << relative;
    EXPECT_EQ(text_of(scratch.at("out/sweep.csv")).find(",yes,,") != std::string::npos, within == 1);
    ASSERT_EQ(
        sweep(study + "constraints: {energy_J: {min: " + number_text(energy_J * (1 + relative)) + "}}\n")
            .code,
        0);
    EXPECT_EQ(result()["within_constraints"], within) << relative;
  }
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

/// Rows of two missions of one name could not be told apart.
TEST_F(Sweep, MissionsOfOneNameAreNamedByTheirFiles) {
  for (const char* folder : {"a", "b"}) {
    std::filesystem::create_directory(scratch.at(folder));
    scratch.write(std::string(folder) + "/pick.yaml", "robot: ../" + kMission.substr(7));
  }
  ASSERT_EQ(sweep("missions: [a, b, mission.yaml]\n"
                  "parameters: {a: {key: robot.motor.gear_ratio, values: [10]}}\n")
                .code,
            0);
  const std::string csv = text_of(scratch.at("out/sweep.csv"));
  for (const std::string& name :
       {scratch.at("a/pick.yaml"), scratch.at("b/pick.yaml"), std::string("mission")})
    EXPECT_NE(csv.find("\n0," + name + ",10,optimal,"), std::string::npos) << csv;
}

TEST_F(Sweep, OptimizeWithoutARangeIsRefusedBeforeTheSweep) {
  const auto done =
      sweep("missions: mission.yaml\nparameters: {a: {key: robot.motor.gear_ratio, values: [10, 20]}}\n",
            "--optimize 5");
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("from and to"), std::string::npos) << done.err;
  EXPECT_FALSE(std::filesystem::exists(scratch.at("out")));
}

TEST_F(Sweep, NoDesignWithAPlanHasNoTableOfEffects) {
  const std::string file = scratch.write(
      "study.yaml",
      "missions: mission.yaml\nparameters: {v: {key: robot.limits.speed_m_s, values: [0.1]}}\n");
  const auto done = run_program(scratch, "sweep " + file + " --nodes 20 --out " + scratch.at("out"));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out.rfind("1 design: 0 planned", 0), 0u) << done.out;
  EXPECT_EQ(done.out.find("share of the variance"), std::string::npos) << done.out;
}

TEST_F(Sweep, CheckFindsTheMistakesOfTheDesigns) {
  const std::string file = scratch.write(
      "study.yaml", "missions: mission.yaml\nparameters: {a: {key: robot.motor.gear_ration, values: [1]}}\n");
  const auto done = run_program(scratch, "check " + file);
  EXPECT_EQ(done.code, 2) << done.err;
  EXPECT_NE(done.err.find("gear_ratio"), std::string::npos) << done.err;
}

TEST_F(Sweep, AResultThatIsUnknownIsTheReason) {
  scratch.write("robot.yaml", kSimpleRobot.substr(0, kSimpleRobot.find("battery:")));
  const std::string study =
      "missions: mission.yaml\nparameters: {gear: {key: robot.motor.gear_ratio, values: [10, 20]}}\n";
  for (const std::string use : {"constraints: {battery_end_fraction: {min: 0.1}}\n",
                                "objectives: {battery_end_fraction: maximize}\n"}) {
    const auto done = sweep(study + use);
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(result()["not_counted"].dump(),
              R"({"battery_end_fraction is unknown: the robot file lacks its source":2})");
    EXPECT_FALSE(result().contains("best"));
  }
}

/// The robot of a design decides what it may carry, whatever is planned first.
TEST_F(Sweep, APayloadIsHeldAgainstTheDesignsRobot) {
  const std::string study =
      "missions: mission.yaml\nparameters:\n"
      "  payload: {key: 'mission.legs[*].payload_kg', values: [30, 0]}\n"
      "  most: {key: robot.limits.max_payload_kg, values: [10, 40]}\n";
  ASSERT_EQ(sweep(study).code, 0);
  const std::string csv = text_of(scratch.at("out/sweep.csv"));
  EXPECT_NE(csv.find("\n0,mission,30,10,infeasible,no,the payload exceeds"), std::string::npos) << csv;
  for (const char* row : {"\n1,mission,30,40,", "\n2,mission,0,10,", "\n3,mission,0,40,"}) {
    const auto at = csv.find(row);
    ASSERT_NE(at, std::string::npos) << csv;
    EXPECT_EQ(csv.substr(at, csv.find('\n', at + 1) - at).find(",no,"), std::string::npos) << csv;
  }
}

/// --resume keeps the plans of a study whose constraints, objectives or name changed.
TEST_F(Sweep, AFingerprintCoversWhatThePlanDependsOn) {
  const auto fingerprint = [&](const std::string& parameters, const std::string& more = "") {
    const Study study = read_study(scratch.write(
        "study.yaml", "missions: mission.yaml\nparameters: {a: {key: " + parameters + "}}\n" + more));
    return SweepJobs(study, {.nodes = 20}, {}).fingerprint(0);
  };
  const std::string gear = "robot.motor.gear_ratio, values: [10, 20]", before = fingerprint(gear);
  EXPECT_FALSE(before.empty());
  EXPECT_EQ(fingerprint(gear, "constraints: {energy_J: {max: 60}}\nobjectives: {a: maximize}\nname: x\n"),
            before);
  EXPECT_EQ(fingerprint("robot.motor.gear_ratio, values: [10, 30]"), before)
      << "the first design is the same";
  for (const char* other :
       {"robot.motor.gear_ratio, values: [11, 20]", "robot.limits.speed_m_s, values: [10, 20]"})
    EXPECT_NE(fingerprint(other), before) << other;
  EXPECT_NE(fingerprint(gear, "hold_friction: motor\n"), before);
  scratch.write("robot.yaml", kSimpleRobot + "# changed\n");
  EXPECT_NE(fingerprint(gear), before);
}

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
  EXPECT_EQ(merge("s1 s2", "all").code, 0);
}

}  // namespace
}  // namespace joulepath
