#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/calibration/calibration.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

/// Unsigned currents, with the sign derived from the wheel's motion.
Dataset unsigned_dataset(bool told) {
  Dataset dataset{.file = "dataset.yaml", .robot = testing::nomad()};
  for (int k = 0; k < 8; ++k) {
    joulepath::Run run = testing::synthetic_run(testing::nomad(), "run_" + std::to_string(k), 12, 0,
                                                testing::swinging(0.5, 0.3, 1.5 + 0.1 * k));
    for (Side side : kSides)
      for (double& current : run.log.motor_current_A[side]) current = std::abs(current);
    run.current_sign_from_motion = told;
    dataset.runs.push_back(run);
  }
  return dataset;
}

TEST(UnsignedCurrents, DoNotSpoilTheFrictionWhenBrakingIsLeftOut) {
  const CalibrationResult told = calibrate(unsigned_dataset(true), CalibrationMethod::full);
  EXPECT_NEAR(told.robot.motor.left.friction_torque_Nm, 0.3728, 0.002);
  EXPECT_NEAR(told.robot.inertia.wheel_axle_inertia_kg_m2, 0.0281, 0.002);
  const CalibrationResult taken_as_they_are = calibrate(unsigned_dataset(false), CalibrationMethod::full);
  EXPECT_GT(std::abs(taken_as_they_are.robot.motor.left.friction_torque_Nm - 0.3728), 0.01);
}

}  // namespace
}  // namespace joulepath
