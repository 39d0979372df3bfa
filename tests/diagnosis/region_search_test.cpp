// The region of the floor that needs more power than the model says.
#include "diagnosis/evidence/region_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/materiality.hpp"
#include "model/robot.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::nomad;

constexpr double kCoefficient = 0.02, kFrom_m = 3.0, kTo_m = 5.0;

/// A lane of 9 m at y, at 0.5 m/s with a swing; between two places the floor resists with this coefficient
/// times the load on each wheel.
RunSignals straight_lane(double y_m, double coefficient) {
  const Robot robot = nomad();
  Run run = testing::synthetic_run(robot, "lane", 18, 0, testing::swinging(0.5, 0.1, 1.3));
  const double torque_Nm =
      coefficient * 0.5 * kGravity_m_s2 * robot.total_mass_kg(0) * robot.geometry.wheel_radius_m.left;
  for (std::size_t k = 0; k < run.log.size(); ++k) {
    const double t = run.log.time_s[k], x_m = 0.5 * t + 0.1 / 1.3 * (1 - std::cos(1.3 * t));
    run.log.position_x_m.push_back(x_m);
    run.log.position_y_m.push_back(y_m);
    run.log.heading_rad.push_back(0);
    if (x_m < kFrom_m || x_m > kTo_m) continue;
    for (Side side : kSides) {
      const double extra_A = torque_Nm / robot.motor[side].torque_per_ampere_Nm_A();
      run.log.motor_current_A[side][k] += extra_A;
      run.log.motor_voltage_V[side][k] += robot.motor[side].resistance_ohm * extra_A;
    }
  }
  return make_run_signals(run, 0, robot);
}

TEST(RegionSearch, FindsTheEdgesOfARoughPatch) {
  const std::vector<RunSignals> runs{straight_lane(0.0, kCoefficient), straight_lane(1.0, 0.0)};
  bool found = false;
  for (const Candidate& candidate : region_candidates(runs, nomad(), {}, {})) {
    if (candidate.shape.name != "floor_patch") continue;
    const auto& at = candidate.shape.parameters;
    found =
        found || (std::abs(at.at("x_min_m") - kFrom_m) < 0.15 && std::abs(at.at("x_max_m") - kTo_m) < 0.15 &&
                  at.at("y_min_m") <= 0.0 && at.at("y_max_m") < 1.0);
  }
  EXPECT_TRUE(found);
}

TEST(RegionSearch, FindsThePatchInTheBatterysPower) {
  std::vector<RunSignals> runs{straight_lane(0.0, kCoefficient), straight_lane(1.0, 0.0)};
  for (RunSignals& run : runs) {
    run.battery_power_W =
        (run.motor_power_W.left + run.motor_power_W.right).array() + nomad().power.standby_W;
    for (Side side : kSides)
      for (auto* motor : {&run.motor_current_A, &run.motor_voltage_V, &run.motor_power_W})
        (*motor)[side].resize(0);
  }
  const std::vector<Candidate> found = region_candidates(runs, nomad(), {}, {});
  EXPECT_TRUE(std::ranges::any_of(found, [](const Candidate& candidate) {
    const auto& at = candidate.shape.parameters;
    return std::abs(at.at("x_min_m") - kFrom_m) < 0.25 && std::abs(at.at("x_max_m") - kTo_m) < 0.25 &&
           at.at("y_max_m") < 1.0;
  }));
}

TEST(RegionSearch, NeedsPlacesAndWhatIsInTheCatalog) {
  std::vector<RunSignals> runs{straight_lane(0.0, kCoefficient)};
  for (const Candidate& candidate : region_candidates(runs, nomad(), {}, {}, {"floor_patch"}))
    EXPECT_NE(candidate.shape.name, "floor_patch");
  runs[0].x_m.resize(0);
  EXPECT_TRUE(region_candidates(runs, nomad(), {}, {}).empty());
}

/// Impact of a patch on 2 of 9 m: its work over the motors' work.
TEST(Materiality, OfAPatchIsItsShareOfTheEnergy) {
  const RunSignals run = straight_lane(0.0, 0.0);
  const ModelPoint nominal{.robot = nomad()};
  const EffectSetting patch{.name = "floor_patch",
                            .parameters = {{"coefficient", kCoefficient},
                                           {"x_min_m", kFrom_m},
                                           {"x_max_m", kTo_m},
                                           {"y_min_m", -1},
                                           {"y_max_m", 1}}};
  const Impact impact = impact_between({run}, {.robot = nomad(), .effects = {patch}}, nominal);
  const double work_J = kCoefficient * kGravity_m_s2 * nomad().total_mass_kg(0) * (kTo_m - kFrom_m);
  double motors_J = 0;
  for (Side side : kSides) motors_J += run.motor_power_W[side].cwiseAbs().sum() * run.period_s;
  EXPECT_GT(impact.motor_power, work_J / motors_J) << "copper loss comes on top";
  EXPECT_LT(impact.motor_power, 1.5 * work_J / motors_J);
  EXPECT_EQ(impact.heading_rad, 0.0);
  EXPECT_GT(materiality(impact), 1.0);
  EXPECT_EQ(materiality(impact_between({run}, nominal, nominal)), 0.0);
}

}  // namespace
}  // namespace joulepath
