#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/calibration/calibration.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/document.hpp"
#include "tests/support/practice_sets.hpp"

namespace joulepath {
namespace {

class PracticeSet : public ::testing::TestWithParam<const char*> {};

TEST_P(PracticeSet, CalibrationRecoversFrictionAndTorqueConstant) {
  const Dataset dataset = read_dataset(testing::practice_file(GetParam()));
  const CalibrationResult result = calibrate(dataset, CalibrationMethod::full);
  const Document label = Document::load(testing::practice_file(GetParam(), "truth.yaml"));
  const Node drawn = label.root()["parameters"];
  EXPECT_NEAR(result.robot.motor.left.friction_torque_Nm / drawn["friction_torque_Nm"]["left"].number(), 1,
              0.02);
  EXPECT_NEAR(result.robot.motor.right.friction_torque_Nm / drawn["friction_torque_Nm"]["right"].number(), 1,
              0.02);
  EXPECT_NEAR(result.robot.motor.left.torque_constant_Nm_A / drawn["torque_constant_Nm_A"].number(), 1, 0.01);
}

TEST_P(PracticeSet, CalibratedRobotReadsBack) {
  const CalibrationResult result =
      calibrate(read_dataset(testing::practice_file(GetParam())), CalibrationMethod::full);
  const Robot again = robot_from(Document::parse(robot_text(result.robot), "robot.yaml"));
  EXPECT_EQ(again.motor.left.resistance_ohm, result.robot.motor.left.resistance_ohm);
  EXPECT_EQ(again.uncertainty, result.robot.uncertainty);
}

INSTANTIATE_TEST_SUITE_P(NullSets, PracticeSet, ::testing::Values("p01_null", "p02_null_rough"));

}  // namespace
}  // namespace joulepath
