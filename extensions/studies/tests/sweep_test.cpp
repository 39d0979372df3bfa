#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "extensions/studies/commands/sweep_jobs.hpp"
#include "extensions/studies/tests/sweep_fixture.hpp"
#include "model/number_text.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::json;

/// Of kSimpleRobot and kMission.
constexpr double kResistance_ohm = 1.5, kTorqueConstant_Nm_A = 0.05, kMass_kg = 30.0, kRadius_m = 0.1,
                 kFriction_Nm = 0.4, kGear = 20.0, kDistance_m = 6.0, kTime_s = 8.0;

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

TEST_F(Sweep, ABoundOverAllPathsHasItsColumn) {
  const std::string study =
      "missions: mission.yaml\nparameters: {path_gear: {key: robot.motor.gear_ratio, values: [20]}}\n";
  for (const char* option : {"", "--path-bound"}) {
    ASSERT_EQ(sweep(study, option).code, 0);
    std::istringstream rows(text_of(scratch.at("out/sweep.csv")));
    std::string header;
    std::getline(rows, header);
    EXPECT_EQ(header.ends_with(",path_lower_bound_J"), *option != 0) << header;
  }
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

TEST_F(Sweep, NoDesignWithAPlanHasNoTableOfEffects) {
  const std::string file = scratch.write(
      "study.yaml",
      "missions: mission.yaml\nparameters: {v: {key: robot.limits.speed_m_s, values: [0.1]}}\n");
  const auto done = run_program(scratch, "sweep " + file + " --nodes 20 --out " + scratch.at("out"));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out.rfind("1 design: 0 planned", 0), 0u) << done.out;
  EXPECT_EQ(done.out.find("share of the variance"), std::string::npos) << done.out;
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

}  // namespace
}  // namespace joulepath
