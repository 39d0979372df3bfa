// A turn that scrubs and is followed by a straight line: dry friction at rest holds any moment up to its
// bound, so what the contacts hold there neither supports nor contradicts the moment of the turn.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/simulation/simulate.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

/// Speed (m/s) and yaw rate (rad/s) at the end of a part of a drive, which they approach smoothly.
struct Part {
  double duration_s{};
  Twist<double> end{};
};

struct ScrubbedDay {
  const char* name{};
  const char* robot{};
  double share{};  ///< of the catalog's typical moment
  double payload_kg{};
  std::vector<Part> drive{};
};

void PrintTo(const ScrubbedDay& day, std::ostream* out) { *out << day.name; }

constexpr double kDriven_m_s = 0.5, kStep_s = 0.01;
const Part kGo{1.5, {kDriven_m_s, 0}}, kStop{1.5, {0, 0}}, kRest{1, {0, 0}};

Part driven_straight(double duration_s) { return {duration_s, {kDriven_m_s, 0}}; }

/// A bend between straight lines, to the left where the yaw rate is positive.
std::vector<Part> bend_between_lines(double yaw_rate_rad_s, double duration_s) {
  return {{0.6, {kDriven_m_s, yaw_rate_rad_s}},
          {duration_s, {kDriven_m_s, yaw_rate_rad_s}},
          {0.6, {kDriven_m_s, 0}}};
}

std::vector<Part> joined_parts(const std::vector<std::vector<Part>>& pieces) {
  std::vector<Part> all;
  for (const auto& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

std::vector<ScrubbedDay> scrubbed_days() {
  const auto once_left = joined_parts(
      {{kGo, driven_straight(2)}, bend_between_lines(0.8, 1), {driven_straight(3), kStop, kRest}});
  const auto to_and_fro = joined_parts({{kGo, driven_straight(2)},
                                        bend_between_lines(-0.8, 1),
                                        {driven_straight(3)},
                                        bend_between_lines(0.8, 1.3),
                                        {driven_straight(3)},
                                        bend_between_lines(-0.5, 0.8),
                                        {driven_straight(3), kStop, kRest}});
  const auto long_bends = joined_parts({{kGo},
                                        bend_between_lines(0.7, 4),
                                        {driven_straight(5)},
                                        bend_between_lines(-0.7, 3),
                                        {driven_straight(2), kStop, kRest}});
  return {{"one_bend_small", "nomad_super_scout", 1, 0, once_left},
          {"one_bend_large", "nomad_super_scout", 2, 6, once_left},
          {"bends_small", "nomad_super_scout", 1, 4, to_and_fro},
          {"bends_large", "nomad_super_scout", 2, 0, to_and_fro},
          {"long_bends", "nomad_super_scout", 1.5, 0, long_bends},
          {"husky", "husky_a200", 1.5, 10, to_and_fro}};
}

Trajectory reference_of_parts(const std::vector<Part>& drive) {
  Trajectory reference;
  Twist<double> from{};
  double begin_s = 0;
  for (const Part& part : drive) {
    for (double t = 0; t < part.duration_s - 1e-9; t += kStep_s) {
      const double share = 0.5 * (1 - std::cos(std::numbers::pi * t / part.duration_s));
      reference.time_s.push_back(begin_s + t);
      reference.linear_speed_m_s.push_back(std::lerp(from.speed_m_s, part.end.speed_m_s, share));
      reference.angular_speed_rad_s.push_back(std::lerp(from.yaw_rate_rad_s, part.end.yaw_rate_rad_s, share));
    }
    begin_s += part.duration_s, from = part.end;
  }
  return reference;
}

double scrub_moment_Nm(const ScrubbedDay& day, const Robot& robot) {
  return day.share * typical_size(find_effect("turning_scrub")->strength(), robot);
}

Dataset dataset_of(const ScrubbedDay& day) {
  constexpr std::size_t kRuns = 12;
  Dataset dataset{
      .robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/" + std::string(day.robot) + ".yaml"),
      .runs = std::vector<Run>(kRuns)};
  const EffectSetting scrub{.name = "turning_scrub",
                            .parameters = {{"moment_Nm", scrub_moment_Nm(day, dataset.robot)}}};
  parallel_for(kRuns, [&](std::size_t r) {
    const SimulationRequest request{.robot = dataset.robot,
                                    .effects = {scrub},
                                    .reference = reference_of_parts(day.drive),
                                    .payload_kg = day.payload_kg,
                                    .sensors = typical_sensors(),
                                    .seed = seed_of_run(1, r)};
    dataset.runs[r] = {.name = "run " + std::to_string(r),
                       .log = simulate(request).log,
                       .payload = {{0, day.payload_kg}},
                       .payload_known = true};
  });
  return dataset;
}

std::string words_of_diagnosis(const Diagnosis& d) {
  std::string words = std::string(verdict_name(d.verdict)) + ", left: " + d.leftover_description;
  for (const Cause& cause : d.causes) words += ", " + cause.effect.name;
  for (const UnknownCause& unknown : d.unknowns) words += ", unknown " + unknown.depends_on;
  return words;
}

class ScrubbingBend : public ::testing::TestWithParam<ScrubbedDay> {};

TEST_P(ScrubbingBend, LeavesTheMomentTheNameAndNothingElse) {
  Dataset dataset = dataset_of(GetParam());
  const Diagnosis found = diagnose(dataset, {.bootstrap = 50});
  EXPECT_EQ(found.verdict, Verdict::explained) << words_of_diagnosis(found);
  ASSERT_EQ(found.causes.size(), 1u) << words_of_diagnosis(found);
  EXPECT_EQ(found.causes.front().effect.name, "turning_scrub");
  const double truth_Nm = scrub_moment_Nm(GetParam(), dataset.robot);
  EXPECT_NEAR(found.causes.front().effect.parameters.at("moment_Nm"), truth_Nm, 0.06 * truth_Nm);
  ASSERT_TRUE(found.corrected_robot);
  dataset.robot = *found.corrected_robot;
  const Diagnosis again = diagnose(dataset, {.bootstrap = 50});
  EXPECT_EQ(again.verdict, Verdict::no_gap) << words_of_diagnosis(again);
}

INSTANTIATE_TEST_SUITE_P(Days, ScrubbingBend, ::testing::ValuesIn(scrubbed_days()),
                         [](const ::testing::TestParamInfo<ScrubbedDay>& day) { return day.param.name; });

}  // namespace
}  // namespace joulepath
