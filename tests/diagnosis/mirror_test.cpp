#include <gtest/gtest.h>

#include <string>

#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "tests/support/practice_sets.hpp"

namespace joulepath {
namespace {

template <class Value>
void swap_sides(Sided<Value>& pair) {
  std::swap(pair.left, pair.right);
}

void negate(std::vector<double>& values) {
  for (double& value : values) value = -value;
}

/// The mirrored day: left and right are swapped, y and every turn have the other sign.
Dataset mirrored(Dataset dataset) {
  swap_sides(dataset.robot.motor);
  swap_sides(dataset.robot.geometry.wheel_radius_m);
  for (Run& run : dataset.runs) {
    Trajectory& log = run.log;
    swap_sides(log.wheel_speed_rad_s), swap_sides(log.motor_voltage_V);
    swap_sides(log.motor_current_A), swap_sides(log.motor_power_W);
    negate(log.angular_speed_rad_s), negate(log.gyro_yaw_rate_rad_s), negate(log.heading_rad);
    negate(log.position_y_m), negate(log.command_angular_speed_rad_s);
  }
  return dataset;
}

std::string other_side(const std::string& value) {
  return value == "left" ? "right" : value == "right" ? "left" : value;
}

double share_of(const Diagnosis& d, const std::string& axis, const std::string& value) {
  for (const WhereCell& cell : d.where)
    if (cell.axis == axis && cell.value == value) return cell.share_of_gap;
  return 0;
}

/// A parameter of the mirrored answer equals the parameter itself, or its negative if it changes sign.
double mirror_parameter(const FoundParameter& parameter) {
  const bool turns = parameter.name == "uphill_direction_rad";
  return turns ? -parameter.value : parameter.value;
}

class Mirror : public ::testing::TestWithParam<const char*> {};

TEST_P(Mirror, AMirroredDayGetsTheMirroredAnswer) {
  const Dataset dataset = read_dataset(testing::practice_file(GetParam()));
  const Diagnosis seen = diagnose(dataset, {.bootstrap = 20}),
                  glass = diagnose(mirrored(dataset), {.bootstrap = 20});
  EXPECT_EQ(seen.verdict, glass.verdict);
  EXPECT_NEAR(seen.gap.energy.before_percent, glass.gap.energy.before_percent, 1e-6);
  EXPECT_NEAR(seen.gap.energy.after_percent, glass.gap.energy.after_percent, 0.05);
  for (const char* side : {"left", "right"})
    EXPECT_NEAR(share_of(seen, "wheel", side), share_of(glass, "wheel", other_side(side)), 0.01);
  ASSERT_EQ(seen.causes.size(), glass.causes.size());
  for (std::size_t k = 0; k < seen.causes.size(); ++k) {
    const Cause &a = seen.causes[k], &b = glass.causes[k];
    EXPECT_EQ(a.effect.name, b.effect.name);
    ASSERT_EQ(a.effect.side.has_value(), b.effect.side.has_value());
    EXPECT_TRUE(!a.effect.side || *a.effect.side != *b.effect.side);
    for (std::size_t p = 0; p < a.parameters.size(); ++p)
      EXPECT_NEAR(mirror_parameter(a.parameters[p]), b.parameters[p].value,
                  2e-3 * std::abs(a.parameters[p].value) + 1e-6)
          << a.parameters[p].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Practice, Mirror, ::testing::Values("p04_dragging_wheel_rough", "p05_floor_slope"));

}  // namespace
}  // namespace joulepath
