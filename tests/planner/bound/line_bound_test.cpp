// The bound over all paths against motions of any shape, which code that shares nothing with it makes and
// drives.
#include <gtest/gtest.h>

#include <cmath>

#include "benchmarks/path_bound/judge_robot.hpp"
#include "model/operating_point.hpp"
#include "model/power.hpp"
#include "planner/bound/line_price.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using path_bound::Driven;
using path_bound::JudgeRobot;
using path_bound::Motion;
using testing::nomad;

using path_bound::kVariants;
using path_bound::Variant;

Robot robot_of(const Variant& variant) { return path_bound::robot_of(nomad(), variant); }

PowerForm form_of(const Robot& robot, double payload_kg = 0) {
  return power_form(make_plant(robot), *robot.limits, payload_kg);
}

TEST(Judge, EnergyOfAMotionIsTheModelsOwn) {
  std::mt19937 random(11);
  for (const Variant& variant : kVariants) {
    const Robot robot = robot_of(variant);
    const Plant plant = make_plant(robot);
    const Motion motion =
        random_motion(path_bound::judge_robot(robot, *robot.limits, variant.payload_kg), 2.0, random);
    const Driven driven = drive(path_bound::judge_robot(robot, *robot.limits, variant.payload_kg), motion);
    double energy_J = 0;
    for (std::size_t k = 0; k + 1 < motion.time_s.size(); ++k) {
      const double dt = motion.time_s[k + 1] - motion.time_s[k];
      constexpr int kSteps = 20;
      for (int j = 0; j < kSteps; ++j) {
        const double share = (j + 0.5) / kSteps;
        const BodyMotion<double> at{std::lerp(motion.speed_m_s[k], motion.speed_m_s[k + 1], share),
                                    (motion.speed_m_s[k + 1] - motion.speed_m_s[k]) / dt,
                                    std::lerp(motion.yaw_rate_rad_s[k], motion.yaw_rate_rad_s[k + 1], share),
                                    (motion.yaw_rate_rad_s[k + 1] - motion.yaw_rate_rad_s[k]) / dt};
        const Site site = site_of(robot.geometry, {}, variant.payload_kg, at.speed_m_s, at.yaw_rate_rad_s);
        const Sided<WheelState<double>> wheels = operating_point(plant, at, site);
        energy_J += dt / kSteps *
                    (robot.power.standby_W +
                     supply_power_W(robot.power, {wheels.left.power_W, wheels.right.power_W}));
      }
    }
    EXPECT_NEAR(driven.energy_J, energy_J, 2e-3 * energy_J) << variant.name << " " << motion.kind;
  }
}

TEST(LineBound, NoMotionOfItsLengthOrMoreTakesLess) {
  std::mt19937 random(2026);
  int judged = 0;
  for (const Variant& variant : kVariants) {
    const Robot robot = robot_of(variant);
    const PowerForm form = form_of(robot, variant.payload_kg);
    ASSERT_EQ(form.not_covered, "") << variant.name;
    const JudgeRobot judge = path_bound::judge_robot(robot, *robot.limits, variant.payload_kg);
    for (const double way_m : {0.4, 1.5, 6.0}) {
      const LineBound bound = line_bound(form, way_m, 0.0);
      std::vector<Motion> motions = worst_motions(judge, way_m * 1.0005);
      for (int k = 0; k < 110; ++k) motions.push_back(random_motion(judge, way_m * 1.001, random));
      for (const Motion& motion : motions) {
        const Driven driven = drive(judge, motion);
        if (!driven.within_limits || driven.way_m < way_m) continue;
        if (variant.forward_only && drives_backward(motion)) continue;
        ++judged;
        EXPECT_GE(driven.energy_J, bound.at(driven.way_m))
            << variant.name << ", " << motion.kind << ", " << driven.way_m << " m";
      }
    }
  }
  EXPECT_GT(judged, 2000);
}

/// A price of a second raises the bound by no more than the time of any motion.
TEST(LineBound, TimeAtItsPriceIsContained) {
  const Robot robot = robot_of(kVariants[0]);
  const JudgeRobot judge = path_bound::judge_robot(robot, *robot.limits, 0);
  const LineBound bound = line_bound(form_of(robot), 2.0, 15.0);
  EXPECT_GT(bound.energy_J, line_bound(form_of(robot), 2.0, 0.0).energy_J + 20);
  std::mt19937 random(5);
  for (int k = 0; k < 200; ++k) {
    const Driven driven = drive(judge, random_motion(judge, 2.002, random));
    if (!driven.within_limits || driven.way_m < 2.0) continue;
    EXPECT_GE(driven.energy_J + 15 * driven.duration_s, bound.at(driven.way_m));
  }
}

/// The straight line itself shows how much the bound gives away.
TEST(LineBound, IsCloseToTheStraightLine) {
  const Robot robot = nomad();
  for (const double way_m : {1.0, 2.0, 4.0, 10.0}) {
    ProfileRequest request{
        .piece = straight_piece({}, way_m), .plant = make_plant(robot), .limits = *robot.limits};
    const ProfileResult line = solve_profile(request);
    ASSERT_TRUE(line.profile);
    const double bound_J = line_bound(form_of(robot), way_m, 0.0).energy_J;
    EXPECT_LE(bound_J, line.summary.lower_bound_J) << way_m;
    EXPECT_GE(bound_J, line.summary.lower_bound_J - 1.0) << way_m;
  }
}

TEST(LineBound, GrowsWithTheWay) {
  const PowerForm form = form_of(nomad());
  double before_J = 0;
  for (const double way_m : {0.1, 0.3, 0.8, 1.6, 2.9, 3.3, 7.0}) {
    const double energy_J = line_bound(form, way_m, 0.0).energy_J;
    EXPECT_GT(energy_J, before_J) << way_m;
    before_J = energy_J;
  }
}

/// A robot whose wheels change places takes the same.
TEST(LineBound, MirrorImageHasTheSameBound) {
  Robot robot = robot_of(kVariants[5]);
  const double one_J = line_bound(form_of(robot, 2), 1.2, 0.0).energy_J;
  std::swap(robot.motor.left, robot.motor.right);
  EXPECT_NEAR(line_bound(form_of(robot, 2), 1.2, 0.0).energy_J, one_J, 0.05);
}

/// Bounds with a mistake: motions must be found below each of them. A test that these pass would be blind.
TEST(MutantsOfTheBound, AreCaught) {
  const Robot robot = nomad();
  const JudgeRobot judge = path_bound::judge_robot(robot, *robot.limits, 0);
  const double way_m = 10.0;
  const LineBound bound = line_bound(form_of(robot), way_m, 0.0);
  double least_J = kNoLimit;
  for (const Motion& motion : worst_motions(judge, way_m * 1.0005)) {
    const Driven driven = drive(judge, motion);
    if (driven.within_limits && driven.way_m >= way_m) least_J = std::min(least_J, driven.energy_J);
  }
  EXPECT_LT(least_J, 1.01 * bound.energy_J) << "all rates too high by 1 %";
}

/// What X refunds to a turning robot may only fall along the way: a rise would pay for a rotation twice.
TEST(LineBound, CreditsOfATurnNeverRise) {
  for (const Variant& variant : kVariants) {
    const PowerForm form = form_of(robot_of(variant), variant.payload_kg);
    for (const double way_m : {0.3, 1.2, 3.5}) {
      const LinePrice line = line_price(form, way_m, 0.0);
      for (const double price_J : {0.0, 3.0}) {
        const auto credits = falling_credits(form, line, 0.0, {-price_J, price_J}, {0.0});
        for (std::size_t k = 0; k + 1 < credits.size(); ++k) {
          EXPECT_LE(credits[k + 1].spin, credits[k].spin) << variant.name << k;
          EXPECT_LE(credits[k + 1].inner, credits[k].inner) << variant.name << k;
        }
      }
    }
  }
}

/// L + dX/dt of a motion in J/m, where the energy comes from the judge: the mean power of 0.1 ms.
double rate_of(const JudgeRobot& judge, const PowerForm& form, const MotionPrice& price, double v, double w,
               double a, double alpha) {
  constexpr double kStep_s = 1e-4;
  const double before = -0.5 * kStep_s, after = 0.5 * kStep_s;
  const Motion motion{.time_s = {0, kStep_s},
                      .speed_m_s = {v + a * before, v + a * after},
                      .yaw_rate_rad_s = {w + alpha * before, w + alpha * after}};
  const double power_W = drive(judge, motion).energy_J / kStep_s;
  const double backward = std::abs(w) * form.half_track_m > v ? 1 : 0;
  return (power_W + price.p_slope * v * v * v + 2 * price.p * v * a -
          price.credit.spin * form.yaw_inertia_kg_m2 * w * alpha -
          price.credit.inner * backward * (form.half_track_m * alpha * (w > 0 ? 1 : -1) - a)) /
         v;
}

/// The least rate at a price of a radian is below that of every motion at the place. Without the least over
/// the yaw acceleration it is not.
TEST(LeastRate, NoMotionAtItsPlaceTakesLess) {
  std::mt19937 random(7);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  int below_without_yaw_acceleration = 0;
  for (const Variant& variant : kVariants) {
    const Robot robot = robot_of(variant);
    const JudgeRobot judge = path_bound::judge_robot(robot, *robot.limits, variant.payload_kg);
    const PowerForm form = form_of(robot, variant.payload_kg);
    PowerForm stiff = form;
    stiff.limits.yaw_acceleration_rad_s2 = 0;
    const LinePrice line = line_price(form, 1.6, 0.0);
    const std::vector<TurnCredit> credits = falling_credits(form, line, 0.0, {0.0}, {0.0});
    for (std::size_t k = 4; k + 4 < credits.size(); k += 5) {
      if (k == line.peak) continue;
      MotionPrice price = price_on(line, k, true, form);
      price.credit = credits[k];
      constexpr double kPerRad_J = 3;
      const double least = least_rates(form, price, {kPerRad_J}, 0.01).front(),
                   least_stiff = least_rates(stiff, price, {kPerRad_J}, 0.01).front();
      const Limits& limits = form.limits;
      for (int n = 0; n < 400; ++n) {
        const double v = draw(0.02, std::min(limits.speed_m_s, price.most_m_s));
        const double w_most = std::min(limits.yaw_rate_rad_s, limits.lateral_acceleration_m_s2 / v);
        const double w = draw(-w_most, w_most), a = draw(-limits.deceleration_m_s2, limits.acceleration_m_s2);
        const double alpha = draw(-limits.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2);
        const double rate = rate_of(judge, form, price, v, w, a, alpha) - kPerRad_J * w / v;
        EXPECT_GE(rate, least - 1e-3 * std::abs(least)) << variant.name << " piece " << k;
        below_without_yaw_acceleration += rate < least_stiff;
      }
    }
  }
  EXPECT_GT(below_without_yaw_acceleration, 0) << "a bound that leaves the yaw acceleration out";
}

TEST(PowerForm, EffectsThatDependOnMoreThanTheMotionAreNamed) {
  Robot robot = nomad();
  EXPECT_EQ(form_of(robot).not_covered, "");
  for (const EffectSetting& effect :
       {EffectSetting{.name = "floor_slope", .parameters = {{"grade", 0.03}, {"uphill_direction_rad", 0.4}}},
        EffectSetting{.name = "gear_efficiency", .parameters = {{"loss_fraction", 0.2}}}}) {
    robot.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.01}}}, effect};
    EXPECT_EQ(form_of(robot).not_covered, "the bound does not cover " + effect.name);
  }
}

/// Wherever the patch lies: also between all places that are looked at.
TEST(PowerForm, APartOfTheFloorIsNotCovered) {
  Robot robot = nomad();
  for (const double coefficient : {-0.019, 0.03})
    for (const double x_m : {-11.0, 0.0, 7.3, 400.0}) {
      robot.effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.02}}},
                       {.name = "floor_patch",
                        .parameters = {{"coefficient", coefficient},
                                       {"x_min_m", x_m},
                                       {"x_max_m", x_m + 2},
                                       {"y_min_m", 1.0},
                                       {"y_max_m", 3.5}}}};
      EXPECT_EQ(form_of(robot).not_covered, "the bound does not cover floor_patch") << x_m;
    }
}

/// A drop is left out, which lowers the power only where it is one.
TEST(PowerForm, ANegativeVoltageDropIsNotCovered) {
  Robot robot = nomad();
  robot.effects = {{.name = "driver_voltage_drop", .parameters = {{"voltage_V", 0.6}}}};
  EXPECT_EQ(form_of(robot).not_covered, "");
  robot.effects[0].parameters["voltage_V"] = -0.6;
  EXPECT_EQ(form_of(robot).not_covered, "the bound does not cover a negative voltage drop of the drivers");
}

TEST(PowerForm, LimitsThatTheBoundNeedsAreNamed) {
  Robot robot = nomad();
  robot.limits->yaw_rate_rad_s = kNoLimit;
  EXPECT_EQ(form_of(robot).not_covered, "the robot has no limit yaw_rate_rad_s");
}

}  // namespace
}  // namespace joulepath
