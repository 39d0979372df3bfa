#include <gtest/gtest.h>

#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

/// One row of cells of 0.5 m along the x axis; 0 is no cap.
SpeedMask row_of_cells(std::vector<std::int8_t> values) {
  const int width = static_cast<int>(values.size());
  return {.grid = {.width = width,
                   .height = 1,
                   .resolution_m = 0.5,
                   .origin = {0, -0.25, 0},
                   .occupancy_percent = std::move(values)},
          .kind = SpeedMask::Kind::absolute,
          .base = 0,
          .multiplier = 0.01};
}

std::vector<SpeedCap> caps_along(const SpeedMask& mask, double from_m, double length_m) {
  return speed_caps_on(straight_piece({from_m, 0, 0}, length_m), 0, 0, {}, mask, 1.0);
}

/// A cap that reached farther made plans and controllers too slow.
TEST(MaskCaps, BeginAndEndAtTheBordersOfTheirCells) {
  const std::vector<SpeedCap> caps = caps_along(row_of_cells({0, 0, 40, 40, 70, 0, 0, 0}), 0.13, 3.5);
  ASSERT_EQ(caps.size(), 2u);
  EXPECT_NEAR(caps[0].from_m, 1.0 - 0.13, 1e-5);
  EXPECT_NEAR(caps[0].to_m, 2.0 - 0.13, 1e-5);
  EXPECT_DOUBLE_EQ(caps[0].speed_m_s, 0.4);
  EXPECT_EQ(caps[1].from_m, caps[0].to_m);
  EXPECT_NEAR(caps[1].to_m, 2.5 - 0.13, 1e-5);
}

TEST(MaskCaps, ReachToTheEndsOfThePath) {
  const std::vector<SpeedCap> caps = caps_along(row_of_cells({30, 30, 0, 0, 0, 30}), 0.2, 2.6);
  ASSERT_EQ(caps.size(), 2u);
  EXPECT_EQ(caps[0].from_m, 0);
  EXPECT_NEAR(caps[0].to_m, 0.8, 1e-5);
  EXPECT_NEAR(caps[1].from_m, 2.3, 1e-5);
  EXPECT_EQ(caps[1].to_m, 2.6);
}

}  // namespace
}  // namespace joulepath
