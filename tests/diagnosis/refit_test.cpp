// A fit ends where a further one begins, and names no companion below the materiality floor.
#include "diagnosis/evidence/refit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnosis/checks/survey.hpp"
#include "diagnosis/correction/validation.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "model/simulation/simulate.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/typical_effect.hpp"

namespace joulepath {
namespace {

/// Speeds (m/s, rad/s) of a course of 12 s: ahead, a half turn on the spot, back with a bend.
Twist<double> course_at(double time_s, double turn) {
  const auto swell_of = [](double share) { return 0.5 * (1 - std::cos(2 * std::numbers::pi * share)); };
  if (time_s < 4) return {0.9 * swell_of(time_s / 4), 0.0};
  if (time_s < 7) return {0.0, turn * std::numbers::pi * 2 / 3 * swell_of((time_s - 4) / 3)};
  return {0.8 * swell_of((time_s - 7) / 5), turn * 0.3 * swell_of((time_s - 7) / 5)};
}

/// A day of such courses, left and right, empty and loaded.
Dataset course_day(const std::vector<EffectSetting>& effects, std::size_t runs = 12) {
  Dataset day{.robot = testing::nomad()};
  for (std::size_t r = 0; r < runs; ++r) {
    SimulationRequest request{.robot = day.robot,
                              .effects = effects,
                              .payload_kg = r % 4 < 2 ? 0.0 : 8.0,
                              .sensors = typical_sensors(),
                              .seed = seed_of_run(77, r)};
    for (int k = 0; k <= 1200; ++k) {
      const Twist<double> twist = course_at(0.01 * k, r % 2 == 0 ? 1 : -1);
      request.reference.time_s.push_back(0.01 * k);
      request.reference.linear_speed_m_s.push_back(twist.speed_m_s);
      request.reference.angular_speed_rad_s.push_back(twist.yaw_rate_rad_s);
    }
    day.runs.push_back({.name = "run_" + std::to_string(r),
                        .log = simulate(request).log,
                        .payload = {{0, request.payload_kg}},
                        .payload_known = true});
  }
  return day;
}

ActiveEffect active(const EffectSetting& setting, const Robot& robot) {
  for (const Candidate& candidate : catalog_candidates(robot, {}))
    if (candidate.shape.name == setting.name && candidate.shape.side == setting.side) {
      ActiveEffect effect{candidate, amplitudes_of(setting, robot)};
      for (auto& [name, value] : effect.candidate.shape.parameters)
        if (setting.parameters.contains(name)) value = setting.parameters.at(name);
      return effect;
    }
  ActiveEffect effect{bare_candidate(*find_effect(setting.name), robot), amplitudes_of(setting, robot)};
  effect.candidate.shape.parameters = setting.parameters;
  effect.candidate.shape.parameters.erase(effect.candidate.amplitude[0]);
  return effect;
}

/// Fits a state that is far from the truth, and the state that this fit gives once more.
void expect_an_end(const EffectSetting& truth, const EffectSetting& start) {
  const Dataset day = course_day({truth});
  const RunsByUse runs = sort_runs(day);
  const std::vector<Nuisance> nuisances = calibration_nuisances(day.robot);
  const auto state_of = [&](const EffectSetting& setting) {
    return ModelState{.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0),
                      .effects = {active(setting, day.robot)}};
  };
  const Equations about_truth =
      build_equations(read_signals(runs.diagnosis, 0.0), day.robot, nuisances, state_of(truth), {},
                      {.whole_catalog = false, .dictionary = false});
  const auto fit = [&](const ModelState& state) {
    return refit(runs.diagnosis, every(runs.diagnosis.runs.size()), nuisances, state, about_truth.noise,
                 about_truth.run_variance, 1.0);
  };
  const Refit first = fit(state_of(start)), again = fit(first.state);
  for (std::size_t i = 0; i < first.columns.size(); ++i) {
    const Column& column = first.equations.columns[static_cast<std::size_t>(first.columns[i])];
    if (column.kind != Column::Kind::amplitude) continue;
    const auto part = static_cast<std::size_t>(column.part);
    const auto at = static_cast<Eigen::Index>(i);
    EXPECT_NEAR(first.state.effects[0].amplitude[part], again.state.effects[0].amplitude[part],
                1.0 * std::sqrt(first.covariance(at, at)))
        << truth.name;
  }
}

TEST(Refit, EndsWhereAFurtherFitBegins) {
  const EffectSetting patch{
      .name = "floor_patch",
      .parameters = {
          {"coefficient", 0.02}, {"x_min_m", 0.5}, {"x_max_m", 1.5}, {"y_min_m", -2.0}, {"y_max_m", 2.0}}};
  EffectSetting off = patch;
  off.parameters["coefficient"] = 0.002, off.parameters["x_min_m"] = 0.1, off.parameters["x_max_m"] = 1.2;
  expect_an_end(patch, off);
  for (const char* name : {"stribeck_friction", "wheel_slip", "turning_scrub", "time_misalignment"}) {
    const EffectSetting truth = testing::typical_effect(*find_effect(name));
    EffectSetting small = truth;
    for (auto& [parameter, value] : small.parameters)
      value *= find_effect(name)->find(parameter)->role == ParameterRole::inverse_strength ? 5.0 : 0.2;
    expect_an_end(truth, small);
  }
}

/// The effect at a share of what is material on these courses.
EffectSetting share_of_floor(const char* name, double share) {
  const Dataset day = course_day({}, 4);
  const std::vector<Nuisance> nuisances = calibration_nuisances(day.robot);
  const Candidate candidate = active(testing::typical_effect(*find_effect(name)), day.robot).candidate;
  std::map<std::string, double> known;
  const double least = least_amplitudes(sort_runs(day).signals, day.robot, nuisances,
                                        {.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0)},
                                        {candidate}, known)[0];
  return setting_of(candidate, {share * least}, day.robot);
}

/// A scrubbing turn beside an effect below the materiality floor, however well the runs tell it from 0.
TEST(Names, HaveNoCompanionBelowTheFloor) {
  EffectSetting scrub = testing::typical_effect(*find_effect("turning_scrub"));
  scrub.parameters["moment_Nm"] *= 2;
  for (const char* companion : {"current_sensor_gain", "center_of_mass_offset"}) {
    const EffectSetting small = share_of_floor(companion, 0.25);
    const Dataset day = course_day({scrub, small});
    const RunsByUse runs = sort_runs(day);
    const Identification id = identify(runs.diagnosis, survey_dataset(day, runs.signals).invisible_effects);
    const Validation v = validate({.dataset = day, .runs = runs, .id = id},
                                  {.verdict = Verdict::explained,
                                   .named = {active(scrub, day.robot), active(small, day.robot)},
                                   .sizes = {.greatest = 10, .of_names = {{companion, 0.97, 20, 0.25}}}});
    ASSERT_EQ(v.judgment.named.size(), 1u) << companion;
    EXPECT_EQ(v.judgment.named[0].candidate.label(), "turning_scrub");
    ASSERT_EQ(v.listed.size(), 1u) << companion;
    EXPECT_EQ(v.listed[0].effect, companion);
  }
}

}  // namespace
}  // namespace joulepath
