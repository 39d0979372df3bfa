#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

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
  EXPECT_NE(csv.find("infeasible,no,"), std::string::npos) << csv;       // 6 m in 8 s at 0.5 m/s
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
  refused("  a: {key: robot.limits.speed_m_s, from: 2, to: 1}\n", "study.yaml:3", "> from");
  refused("  energy_J: {key: robot.limits.speed_m_s, values: [1]}\n", "study.yaml:3", "energy_J");
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
  refused("s1 other s3", "list");
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

TEST_F(Shards, ACutShardIsRefused) {
  for (const char* k : {"1", "2"})
    ASSERT_EQ(batch(std::string("s") + k, std::string("--shard ") + k + "/2").code, 0);
  const std::string lines = text_of(scratch.at("s1/results.jsonl"));
  scratch.write("s1/results.jsonl", lines.substr(0, lines.size() / 2));
  EXPECT_EQ(merge("s1 s2", "all").code, 2);
  scratch.write("s1/results.jsonl", lines + lines);
  EXPECT_EQ(merge("s1 s2", "all").code, 2);
}

}  // namespace
}  // namespace joulepath
