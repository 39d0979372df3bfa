#include <gtest/gtest.h>

#include "scenarios/robot_files/motor_sheet_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

Document sheet(const std::string& keys) {
  return Document::parse("motor_sheet: {" + keys + "}\n", "motor.yaml");
}

const std::string kGood =
    "at: output, gear_ratio: 20, nominal_voltage_V: 12, no_load_speed_rpm: 200, no_load_current_A: 0.2, ";

std::string refusal(const std::string& keys) {
  try {
    static_cast<void>(read_motor_sheet(sheet(keys)));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(MotorSheetFile, StatesEachConstantWithItsOrigin) {
  const RobotDraft draft = read_motor_sheet(sheet(kGood + "stall_torque_Nm: 2, stall_current_A: 6"));
  ASSERT_FALSE(draft.values.empty());
  for (const DraftValue& value : draft.values)
    EXPECT_NE(value.origin.find("motor.yaml: "), std::string::npos);
  const std::string text = draft_text(draft);
  EXPECT_NE(text.find("  resistance_ohm: 2  # motor.yaml: nominal voltage / stall current"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("gear_efficiency: {loss_fraction: "), std::string::npos);
}

TEST(MotorSheetFile, AnEffectOfASecondSourceIsNotUsed) {
  RobotDraft draft, second;
  draft.values.push_back({"effects", "gear_efficiency: {loss_fraction: 0.2}", "one.yaml"});
  second.values.push_back({"effects", "gear_efficiency: {loss_fraction: 0.3}", "two.yaml"});
  second.values.push_back({"effects", "rolling_resistance: {coefficient: 0.02}", "two.yaml"});
  add_draft(draft, second);
  ASSERT_EQ(draft.values.size(), 2u);
  EXPECT_EQ(draft.values[0].text, "gear_efficiency: {loss_fraction: 0.2}");
  EXPECT_EQ(draft.values[0].origin, "one.yaml; not used: gear_efficiency: {loss_fraction: 0.3} of two.yaml");
}

TEST(MotorSheetFile, ContradictionsAreToldWithTheirNumber) {
  // 6 Nm from 6 A where the speed at 12 V allows 0.56 Nm/A: torque in another unit.
  EXPECT_NE(refusal(kGood + "stall_torque_Nm: 6, stall_current_A: 6").find("1.868 times the torque"),
            std::string::npos)
      << refusal(kGood + "stall_torque_Nm: 6, stall_current_A: 6");
  EXPECT_NE(refusal(kGood + "stall_torque_Nm: 2, stall_current_A: 0.1").find("more than no_load_current_A"),
            std::string::npos);
  EXPECT_NE(refusal(kGood + "rated_torque_Nm: 5, rated_speed_rpm: 150, rated_current_A: 2")
                .find("78.54 W at the shaft from 24 W"),
            std::string::npos);
  EXPECT_NE(refusal(kGood + "stall_torque_Nm: 2").find("stall_current_A"), std::string::npos);
  EXPECT_NE(refusal(kGood).find("neither a stall point nor a rated point"), std::string::npos);
}

TEST(MotorSheetFile, ARatedPointThatNeedsAnotherVoltageIsNoted) {
  const RobotDraft draft =
      read_motor_sheet(sheet(kGood + "stall_torque_Nm: 2, stall_current_A: 6, rated_torque_Nm: 0.6, "
                                     "rated_speed_rpm: 60, rated_current_A: 1.5"));
  ASSERT_EQ(draft.notes.size(), 1u);
  EXPECT_NE(draft.notes.front().find("the sheet states 12 V"), std::string::npos);
}

TEST(MotorSheetFile, ABrushlessMotorHasItsPhaseToPhaseValues) {
  const RobotDraft draft = read_motor_sheet(sheet(
      "at: motor, gear_ratio: 10, nominal_voltage_V: 24, no_load_speed_rpm: 2350, no_load_current_A: 0.3, "
      "resistance_ohm: 0.4, speed_constant_rpm_V: 100"));
  for (const DraftValue& value : draft.values) {
    if (value.key == "motor.torque_constant_Nm_A") {
      EXPECT_NEAR(std::stod(value.text), 0.0954930, 1e-7);
    }
    if (value.key == "motor.resistance_ohm") {
      EXPECT_EQ(value.text, "0.4");
    }
    EXPECT_NE(value.key, "effects");
  }
}

}  // namespace
}  // namespace joulepath
