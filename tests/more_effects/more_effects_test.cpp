#include <gtest/gtest.h>

#include <algorithm>

#include "diagnosis/values/diagnosis.hpp"
#include "model/effects/catalog.hpp"
#include "model/effects/effects_document.hpp"
#include "model/simulation/simulate.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/profile/profile_solver.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"
#include "scenarios/robot_files/effect_list.hpp"
#include "tests/support/nomad.hpp"

/// The product with the three effects of more_effects.hpp; every part must use them without a change.
namespace joulepath {
namespace {

EffectSetting curve_drag() { return {.name = "curve_drag", .parameters = {{"coefficient_N_s_rad", 10.0}}}; }

EffectSetting wet_floor() {
  return {.name = "wet_floor",
          .parameters = {
              {"coefficient_N_s_m", 20.0}, {"x_min_m", 1}, {"x_max_m", 3}, {"y_min_m", -9}, {"y_max_m", 9}}};
}

EffectSetting gear_resonance() {
  return {.name = "gear_resonance", .parameters = {{"torque_Nm", 0.4}, {"speed_rad_s", 4.5}}};
}

class MoreEffects : public ::testing::TestWithParam<EffectSetting (*)()> {
 protected:
  EffectSetting setting = GetParam()();
};

INSTANTIATE_TEST_SUITE_P(Added, MoreEffects, ::testing::Values(curve_drag, wet_floor, gear_resonance),
                         [](const auto& added) { return added.param().name; });

PrescribedMotion lane(double speed_m_s, bool reverse) {
  return {.acceleration_m_s2 = 0.3, .speed_m_s = speed_m_s, .distance_m = 4, .reverse = reverse};
}

PrescribedMotion bend(double speed_m_s, double radius_m, double angle_rad) {
  return {.profile = MotionProfile::arc,
          .acceleration_m_s2 = 0.3,
          .speed_m_s = speed_m_s,
          .radius_m = radius_m,
          .angle_rad = angle_rad};
}

SimulationResult drive(const std::vector<EffectSetting>& effects, double speed_m_s, double payload_kg,
                       std::uint64_t seed) {
  SimulationRequest request{
      .robot = testing::nomad(), .effects = effects, .payload_kg = payload_kg, .seed = seed};
  request.reference =
      timed_motion(request.robot,
                   {lane(speed_m_s, false), bend(0.6 * speed_m_s, 0.4, 3.1), lane(0.5 * speed_m_s, false),
                    bend(speed_m_s, 1.2, -3.1), lane(0.4, true)},
                   {.payload_kg = payload_kg})
          .trajectory;
  return simulate(request);
}

Dataset day_with(const EffectSetting& effect) {
  Dataset dataset{.file = "day.yaml", .robot = testing::nomad()};
  std::uint64_t seed = 0;
  for (double payload_kg : {0.0, 8.0})
    for (double speed_m_s : {0.3, 0.45, 0.6, 0.9}) {
      Run run{.name = "run_" + std::to_string(++seed), .payload_known = true};
      run.log = drive({effect}, speed_m_s, payload_kg, seed).log;
      run.log.payload_kg.assign(run.log.size(), payload_kg);
      dataset.runs.push_back(std::move(run));
    }
  return dataset;
}

TEST_P(MoreEffects, AreInTheCatalogTheDocumentAndTheSchema) {
  ASSERT_NE(find_effect(setting.name), nullptr);
  EXPECT_NE(effects_markdown().find("\n### " + setting.name + "\n"), std::string::npos);
  const Schema schema = effect_list_schema();
  const Schema& entry = schema.parts.front();
  const auto key = std::ranges::find(entry.keys, setting.name, &Schema::Key::name);
  ASSERT_NE(key, entry.keys.end());
  EXPECT_EQ(key->schema.keys.size(), setting.parameters.size() + 1);  // and its probability
  const Document robot = Document::parse(
      "effects: [{curve_drag: {coefficient_N_s_rad: 10}}, {gear_resonance: {torque_Nm: 1, speed_rad_s: 2}}]",
      "robot.yaml");
  EXPECT_EQ(read_effect_list(robot.root()["effects"]).size(), 2u);
}

TEST_P(MoreEffects, CostEnergyInTheSimulator) {
  const SimulationResult with = drive({setting}, 0.5, 0, 1), without = drive({}, 0.5, 0, 1);
  EXPECT_GT(with.energy_J, 1.01 * without.energy_J);
}

TEST_P(MoreEffects, CostEnergyInThePlan) {
  const Curve bend({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})});
  Robot robot = testing::nomad();
  robot.effects = {setting};
  const ProfileRequest request{.piece = bend,
                               .plant = make_plant(robot),
                               .limits = *robot.limits,
                               .nodes = 60,
                               .solver = SolverChoice::fast,
                               .draft = true};
  const ProfileResult result = solve_profile(request);
  ASSERT_TRUE(result.profile.has_value()) << result.summary.message;
  EXPECT_GT(energy_by_cause(path_motion(request), *result.profile).effects_J.at(setting.name), 0.1);
}

TEST_P(MoreEffects, AreNamedByTheDiagnosisAndItsReport) {
  const Diagnosis found = diagnose(day_with(setting), {.bootstrap = 20});
  ASSERT_FALSE(found.causes.empty()) << verdict_name(found.verdict) << ": "
                                     << ::testing::PrintToString(found.notes);
  const EffectSetting& named = found.causes.front().effect;
  EXPECT_EQ(named.name, setting.name);
  const std::string strength = find_effect(setting.name)->strength().name;
  EXPECT_NEAR(named.parameters.at(strength), setting.parameters.at(strength),
              0.2 * setting.parameters.at(strength));
  EXPECT_NE(diagnosis_json(found).find('"' + setting.name + '"'), std::string::npos);
}

}  // namespace
}  // namespace joulepath
