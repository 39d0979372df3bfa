// `drift` on days whose datasets name different robot files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/app/program_result.hpp"

namespace joulepath {
namespace {

void replace(std::string& text, const std::string& old_part, const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  ASSERT_NE(at, std::string::npos) << old_part;
  text.replace(at, old_part.size(), new_part);
}

/// The starter's files, with a second day of the same logs and a robot file of its own.
class DriftCommand : public ::testing::Test {
 protected:
  DriftCommand() { EXPECT_EQ(run_program(scratch, "init " + scratch.at("d") + " --quiet").code, 0); }

  void second_day(const std::string& old_part, const std::string& new_part) {
    std::string robot = text_of(scratch.at("d/robot.yaml")), day = text_of(scratch.at("d/dataset.yaml"));
    replace(robot, old_part, new_part);
    replace(day, "robot: robot.yaml", "robot: other.yaml");
    std::ofstream(scratch.at("d/other.yaml")) << robot;
    std::ofstream(scratch.at("d/second.yaml")) << day;
  }
  ProgramResult drift(const std::string& options = "") const {
    return run_program(
        scratch, "drift " + scratch.at("d/dataset.yaml") + " " + scratch.at("d/second.yaml") + options);
  }

  ScratchDirectory scratch{};
};

TEST_F(DriftCommand, RefusesDaysWithDifferentRobots) {
  for (const auto& [old_part, new_part] :
       {std::pair{"chassis_mass_kg: 21.2", "chassis_mass_kg: 26"},
        std::pair{"resistance_ohm: 2.74", "resistance_ohm: 2.2"},
        std::pair{"friction_torque_Nm: 0.015", "friction_torque_Nm: 0.2"}}) {
    second_day(old_part, new_part);
    const ProgramResult refused = drift();
    EXPECT_EQ(refused.code, 2) << new_part;
    EXPECT_EQ(refused.out, "") << new_part;
    EXPECT_NE(refused.err.find("second.yaml: robot: found"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("one robot file for all days"), std::string::npos) << refused.err;
  }
}

TEST_F(DriftCommand, ComparesCopiesOfOneRobotAndDaysWithAStatedOne) {
  second_day("name: my_robot", "name: another_name");
  EXPECT_EQ(drift().code, 0) << "the same values under another name";
  second_day("chassis_mass_kg: 21.2", "chassis_mass_kg: 26");
  EXPECT_EQ(drift(" --robot " + scratch.at("d/robot.yaml")).code, 0);
}

}  // namespace
}  // namespace joulepath
