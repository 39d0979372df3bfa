// The bound that knows headings, against motions that code of another kind makes and drives.
#include "planner/bound/heading_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "benchmarks/path_bound/judge_robot.hpp"
#include "planner/bound/heading_stages.hpp"
#include "planner/bound/turning_cost.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

using path_bound::Driven;
using path_bound::JudgeRobot;
using path_bound::Motion;
using path_bound::Variant;

constexpr double kDegree = std::numbers::pi / 180;

/// A robot, the table of its rates on a line, and the bound of motions of about that length.
struct Turning {
  Robot robot{};
  PowerForm form{};
  JudgeRobot judge{};
  RateTable table{};

  Turning(const Variant& variant, double way_m)
      : robot(path_bound::robot_of(testing::nomad(), variant)),
        form(power_form(make_plant(robot), *robot.limits, variant.payload_kg)),
        judge(path_bound::judge_robot(robot, *robot.limits, variant.payload_kg)),
        table(rate_table(form, way_m, 0, true, true)) {}

  double bound_J(const Driven& driven) const {
    const HeadingEnds ends{{driven.x_m, driven.y_m}, 0.0, driven.heading_rad};
    return heading_bound(table, ends, driven.way_m, driven.way_m, kNoLimit);
  }
  /// The same where less is known, and the way may be shorter or longer.
  std::vector<double> weaker_bounds_J(const Driven& driven) const {
    const Point2 offset{driven.x_m, driven.y_m};
    std::vector<double> bounds;
    for (const HeadingEnds& ends :
         {HeadingEnds{offset, 0.0, std::nullopt}, HeadingEnds{offset, std::nullopt, driven.heading_rad},
          HeadingEnds{offset, 0.0, driven.heading_rad}})
      bounds.push_back(heading_bound(table, ends, std::max(table.line.length_m(), 0.97 * driven.way_m),
                                     1.1 * driven.way_m, kNoLimit));
    return bounds;
  }
  double bound_J(double way_m, double start_deg, std::optional<double> goal_deg, double more_m = 0) const {
    HeadingEnds ends{{way_m, 0}, start_deg * kDegree, std::nullopt};
    if (goal_deg) ends.goal_rad = *goal_deg * kDegree;
    return heading_bound(table, ends, std::max(way_m, table.line.length_m()), way_m + more_m, kNoLimit);
  }
};

TEST(TurningCost, NoChordOfTheGridLiesAboveIt) {
  const Eigen::ArrayXd prices = Eigen::ArrayXd::LinSpaced(9, -4, 4);
  const TurningCost cost(prices, 1.3 - 0.11 * prices.square() + 0.02 * prices);
  for (const double cell_rad : {0.05, 0.4, 1.1}) {
    constexpr int kReach = 6;
    const std::vector<double> grid = cost.below_on_grid(cell_rad, kReach);
    EXPECT_DOUBLE_EQ(grid[kReach], cost(0.0));
    for (int k = 0; k < 2 * kReach; ++k)
      for (int j = 0; j <= 50; ++j) {
        const double share = j / 50.0, turn_rad = cell_rad * (k + share - kReach);
        const auto at = static_cast<std::size_t>(k);
        EXPECT_LE(std::lerp(grid[at], grid[at + 1], share), cost(turn_rad) + 1e-12) << turn_rad;
      }
    EXPECT_NEAR(grid.back(), cost(cell_rad * kReach), 0.5 * cell_rad) << "not far below";
  }
}

/// The stage's cost against fine sums of the rate that lies on the chords, with slopes that change on the
/// way.
TEST(HeadingStage, CostIsBelowTheIntegralForEverySlope) {
  const HeadingRates steep{3, Eigen::ArrayXd::LinSpaced(17, 9, -9)},
      flat{3, Eigen::ArrayXd::LinSpaced(17, 2, 4)};
  const HeadingRates bent{3, 5 - Eigen::ArrayXd::LinSpaced(17, -3, 3).square()};
  RateTable table{.line = {.s_m = {0, 0.006, 0.0175, 0.0175, 0.03}, .p = {0, 0, 0, 0, 0}, .peak = 2},
                  .pieces = {{steep, bent}, {flat, steep}, {bent, bent}, {bent, flat}},
                  .middle = bent,
                  .bounded = true};
  const HeadingStage stage = heading_stages(table, 0.03, 0.03, false).front();
  ASSERT_NEAR(stage.length_m, 0.0175, 1e-12) << "two pieces in one";
  for (const double price : {-1.5, 0.0, 0.8, 2.0})
    for (const double low : {-30.0, 10.0})
      for (const double high : {20.0, 45.0}) {
        double integral_J = 0;
        constexpr int kParts = 4000;
        for (int k = 0; k < kParts; ++k) {
          const double sigma = 0.0175 * (k + 0.5) / kParts, shift = sigma - 0.00875;
          const double slope = k % 2 ? high : low, at = price - shift * slope;
          const bool second = sigma > 0.006;
          const double share = second ? (sigma - 0.006) / 0.0115 : sigma / 0.006;
          integral_J += 0.0175 / kParts *
                        std::lerp(second ? flat(at) : steep(at), second ? steep(at) : bent(at), share);
        }
        EXPECT_LE(stage.cost_J(price, low, high), integral_J + 1e-4) << price << " " << low << " " << high;
      }
}

/// A long piece is cut, its rates being linear along it: without a slope the stages take what the piece
/// takes.
TEST(HeadingStage, StagesOfALongPieceTakeWhatItTakes) {
  const HeadingRates from{3, Eigen::ArrayXd::LinSpaced(17, 9, -9)},
      to{3, Eigen::ArrayXd::LinSpaced(17, 2, 4)};
  const RateTable table{.line = {.s_m = {0, 0.4, 0.4}, .p = {0, 0, 0}, .peak = 1},
                        .pieces = {{from, to}, {to, to}},
                        .middle = to,
                        .bounded = true};
  const std::vector<HeadingStage> stages = heading_stages(table, 0.4, 0.4, false);
  EXPECT_GT(stages.size(), 8u) << "more than a few centimeters are no stage";
  for (const double price : {-1.5, 0.0, 0.8}) {
    double cost_J = 0, length_m = 0;
    for (const HeadingStage& stage : stages) cost_J += stage.cost_J(price, 0, 0), length_m += stage.length_m;
    EXPECT_NEAR(length_m, 0.4, 1e-12);
    EXPECT_NEAR(cost_J, 0.2 * (from(price) + to(price)), 1e-9) << price;
  }
}

TEST(HeadingBound, NoMotionBetweenItsPosesTakesLess) {
  std::mt19937 random(47);
  int judged = 0;
  for (const Variant& variant : path_bound::kVariants)
    for (const double way_m : {0.6, 3.2}) {
      const Turning turning(variant, way_m);
      const std::vector<Motion> worst = worst_motions(turning.judge, way_m * 1.0005);
      std::vector<Motion> motions;
      for (std::size_t k = 0; k < worst.size(); k += 14) motions.push_back(worst[k]);
      for (int k = 0; k < 14; ++k) motions.push_back(random_motion(turning.judge, way_m * 1.001, random));
      for (const Motion& motion : motions) {
        const Driven driven = drive(turning.judge, motion);
        if (!driven.within_limits || driven.way_m < way_m) continue;
        if (variant.forward_only && drives_backward(motion)) continue;
        ++judged;
        EXPECT_GE(driven.energy_J, turning.bound_J(driven))
            << variant.name << ", " << motion.kind << ", " << driven.way_m << " m";
        if (judged % 5 != 0) continue;
        for (const double bound_J : turning.weaker_bounds_J(driven)) EXPECT_GE(driven.energy_J, bound_J);
      }
    }
  EXPECT_GT(judged, 120);
}

TEST(HeadingBound, RisesWithTheHeadingOffTheLine) {
  const Turning forward({.forward_only = true}, 2.0);
  double before_J = forward.bound_J(2.0, 0, std::nullopt);
  const double straight_J = before_J;
  for (const double start_deg : {90.0, 135.0, 180.0}) {
    const double bound_J = forward.bound_J(2.0, start_deg, std::nullopt);
    EXPECT_GT(bound_J, before_J) << start_deg;
    before_J = bound_J;
  }
  EXPECT_GT(before_J, straight_J + 4);
  EXPECT_GT(forward.bound_J(2.0, 90, 90), forward.bound_J(2.0, 90, std::nullopt) + 2);
}

/// A second at its price is contained, and raises the bound.
TEST(HeadingBound, TimeAtItsPriceIsContained) {
  constexpr double kPrice_W = 20;
  Turning turning({}, 1.2);
  const double free_J = turning.bound_J(1.2, 120, 40);
  turning.table = rate_table(turning.form, 1.2, kPrice_W, true, true);
  EXPECT_GT(turning.bound_J(1.2, 120, 40), free_J + 20);
  std::mt19937 random(8);
  for (int k = 0; k < 30; ++k) {
    const Driven driven = drive(turning.judge, random_motion(turning.judge, 1.202, random));
    if (!driven.within_limits || driven.way_m < 1.2) continue;
    EXPECT_GE(driven.energy_J + kPrice_W * driven.duration_s, turning.bound_J(driven));
  }
}

/// In line, it gives little away beside the bound of a line of that length.
TEST(HeadingBound, InLineItIsThatOfTheLine) {
  const Turning turning({}, 2.0);
  const double line_J = line_bound(turning.form, 2.0, 0).energy_J;
  EXPECT_NEAR(turning.bound_J(2.0, 0, 0), line_J, 1.3);
}

/// Longer ways, a free heading and driving backward only add motions. 0.2 J: each bound has its own
/// multiplier.
TEST(HeadingBound, MoreFreedomNeverRaisesIt) {
  const Turning turning({}, 1.5);
  const double exact_J = turning.bound_J(1.5, 120, 60);
  EXPECT_LE(turning.bound_J(1.5, 120, 60, 0.3), exact_J + 1e-9);
  EXPECT_LE(turning.bound_J(1.5, 120, std::nullopt), exact_J + 0.2);
  const Turning forward({.forward_only = true}, 1.5);
  EXPECT_GT(forward.bound_J(1.5, 180, 180), turning.bound_J(1.5, 180, 180) + 3)
      << "a robot that may drive backward need not turn";
}

TEST(HeadingBound, MirrorImageHasTheSameBound) {
  const Variant uneven{.payload_kg = 3, .friction_left_Nm = 0.6};
  Turning left(uneven, 1.2);
  Robot mirrored = left.robot;
  std::swap(mirrored.motor.left, mirrored.motor.right);
  Turning right = left;
  right.form = power_form(make_plant(mirrored), *mirrored.limits, uneven.payload_kg);
  right.table = rate_table(right.form, 1.2, 0, true, true);
  EXPECT_NEAR(left.bound_J(1.2, 100, -30), right.bound_J(1.2, -100, 30), 0.15);
}

/// Turned and moved, the same drive has the same bound.
TEST(HeadingBound, DependsOnTheHeadingsRelativeToTheLine) {
  const Turning turning({}, 1.2);
  const auto at = [&](double course_deg) {
    const double course = course_deg * kDegree;
    const HeadingEnds ends{{1.2 * std::cos(course), 1.2 * std::sin(course)}, course + 1.7, course - 0.6};
    return heading_bound(turning.table, ends, 1.2, 1.2, kNoLimit);
  };
  EXPECT_NEAR(at(37), at(0), 1e-6);
  EXPECT_NEAR(at(-160), at(0), 1e-6);
}

/// Mistakes in the bound, each of which some motion made for it must reveal.
int found_below(const Turning& turning, double way_m, double factor = 1) {
  const std::vector<Motion> motions = worst_motions(turning.judge, way_m * 1.0005);
  int below = 0;
  for (std::size_t k = 0; k < motions.size(); k += 5) {
    const Driven driven = drive(turning.judge, motions[k]);
    if (driven.within_limits && driven.way_m >= way_m)
      below += driven.energy_J < factor * turning.bound_J(driven);
  }
  return below;
}

TEST(MutantsOfTheHeadingBound, AreCaught) {
  const Variant recovering{.regeneration = 1};
  const Turning sound(recovering, 2.0);
  EXPECT_EQ(found_below(sound, 2.0), 0);
  EXPECT_GT(found_below(sound, 2.0, 1.03), 0) << "all too high by 3 %";

  Turning one_way = sound;
  std::erase_if(one_way.form.sectors, [](const Sector& sector) { return sector.turn < 0; });
  one_way.table = rate_table(one_way.form, 2.0, 0, true, true);
  EXPECT_GT(found_below(one_way, 2.0), 0) << "turns to one side left out";
}

}  // namespace
}  // namespace joulepath
