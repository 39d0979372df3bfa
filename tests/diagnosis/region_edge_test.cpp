// A smoothed sample at the edge of a patch of the floor: the mean over the kernel.
#include "diagnosis/prediction/region_edge.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

constexpr double kReach_m = 0.1;

/// A rough floor north-east of the origin.
Plant rough_quadrant() {
  return make_plant(
      testing::nomad(),
      {{.name = "floor_patch",
        .parameters = {
            {"coefficient", 0.05}, {"x_min_m", 0}, {"x_max_m", 100}, {"y_min_m", 0}, {"y_max_m", 100}}}});
}

/// Share of the patch's current in a sample there.
double share_at(const Pose& pose, double reach_m = kReach_m) {
  const Plant plant = rough_quadrant();
  const BodyMotion<double> motion{.speed_m_s = 0.5};
  const auto current_A = [&](const Pose& place, double reach) {
    Site site = site_of(plant.robot.geometry, place, 0.0, motion.speed_m_s, 0.0);
    return operating_point_over_kernel(plant, motion, site, reach).left.current_A;
  };
  const double none_A = current_A({-50, -50, 0}, 0), all_A = current_A({50, 50, 0}, 0);
  return (current_A(pose, reach_m) - none_A) / (all_A - none_A);
}

/// Five equally likely places, at -1.28, -0.52, 0, 0.52 and 1.28 reaches along the heading.
TEST(RegionEdge, CountsTheShareOfTheKernelInsideOfThePatch) {
  const double pi = std::numbers::pi;
  for (const auto& [ahead, share] :
       {std::pair{-1.4, 0.0}, {-0.9, 0.2}, {-0.26, 0.4}, {0.26, 0.6}, {0.9, 0.8}, {1.4, 1.0}}) {
    const double d = ahead * kReach_m;
    EXPECT_NEAR(share_at({d, 50, 0}), share, 1e-9) << ahead << " eastwards";
    EXPECT_NEAR(share_at({50, d, pi / 2}), share, 1e-9) << ahead << " northwards";
    EXPECT_NEAR(share_at({d, 50, pi}), share, 1e-9) << ahead << " westwards: the kernel is symmetric";
  }
  EXPECT_NEAR(share_at({-0.026, 50, pi / 2}), 0.0, 1e-9) << "beside the patch and along it";
}

}  // namespace
}  // namespace joulepath
