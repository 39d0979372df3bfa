#include "scenarios/robot_files/motor_sheet_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "model/motor_sheet.hpp"
#include "model/printable.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {
namespace {

constexpr double kRounded = 0.05;  ///< figures of data sheets are rounded by so much
constexpr double kMostLoss = 0.8;  ///< gears that lose more do not exist
constexpr double kOdd = 0.2;       ///< a rated voltage that differs by more is told

std::optional<SheetPoint> point_of(const Node& sheet, const std::string& which, bool turns) {
  std::vector<std::string> keys{which + "_torque_Nm", which + "_current_A"};
  if (turns) keys.push_back(which + "_speed_rpm");
  const auto stated = std::ranges::count_if(keys, [&](const std::string& key) { return sheet.has(key); });
  if (stated == 0) return std::nullopt;
  return SheetPoint{sheet[keys[0]].number(), turns ? sheet[keys[2]].number() * kRpm_rad_s : 0.0,
                    sheet[keys[1]].number()};
}

MotorSheet sheet_of(const Node& sheet) {
  MotorSheet motor{.nominal_voltage_V = sheet["nominal_voltage_V"].number(),
                   .no_load_speed_rad_s = sheet["no_load_speed_rpm"].number() * kRpm_rad_s,
                   .no_load_current_A = sheet["no_load_current_A"].number(),
                   .stall = point_of(sheet, "stall", false),
                   .rated = point_of(sheet, "rated", true),
                   .resistance_ohm = sheet.optional_number("resistance_ohm"),
                   .gear_ratio = sheet.number_or("gear_ratio", 1.0),
                   .at_output = sheet["at"].text() == "output"};
  if (const auto rpm_V = sheet.optional_number("speed_constant_rpm_V"))
    motor.voltage_constant_V_s_rad = 1 / (*rpm_V * kRpm_rad_s);
  if (!motor.stall && !motor.rated && !(motor.resistance_ohm && motor.voltage_constant_V_s_rad))
    sheet.fail_found("neither a stall point nor a rated point",
                     "stall_torque_Nm and stall_current_A, or rated_torque_Nm, rated_speed_rpm and "
                     "rated_current_A, or resistance_ohm and speed_constant_rpm_V");
  return motor;
}

/// Refuses what no motor does, in the order of the equations.
void check_sheet(const Node& node, const MotorSheet& sheet) {
  const auto less_current = [&](const std::optional<SheetPoint>& point, const char* key) {
    if (point && point->current_A <= sheet.no_load_current_A)
      node[key].fail("more than no_load_current_A (" + four_digits(sheet.no_load_current_A) + " A)");
  };
  less_current(sheet.stall, "stall_current_A");
  less_current(sheet.rated, "rated_current_A");
  if (const auto& rated = sheet.rated) {
    if (rated->speed_rad_s >= sheet.no_load_speed_rad_s)
      node["rated_speed_rpm"].fail("less than no_load_speed_rpm");
    const double out_W = rated->torque_Nm * rated->speed_rad_s;
    const double in_W = sheet.nominal_voltage_V * rated->current_A;
    if (out_W > (1 + kRounded) * in_W)
      node["rated_torque_Nm"].fail_found(
          four_digits(out_W) + " W at the shaft from " + four_digits(in_W) + " W of the supply",
          "a rated point that gives out less than it takes",
          "torques in Nm (1 kgf cm is 0.0981 Nm, 1 oz in is 0.00706 Nm), at: output or motor?");
  }
}

void check_motor(const Node& node, const MotorSheet& sheet, const SheetMotor& motor) {
  if (!(motor.torque_constant_Nm_A > 0 && motor.resistance_ohm > 0))
    node["no_load_current_A"].fail_found(
        four_digits(motor.resistance_ohm * sheet.no_load_current_A) + " V lost in the winding at no load",
        "less than nominal_voltage_V");
  if (motor.loss_fraction >= -kRounded && motor.loss_fraction <= kMostLoss) return;
  node[sheet.rated ? "rated_torque_Nm" : "stall_torque_Nm"].fail_found(
      four_digits(1 - motor.loss_fraction) +
          " times the torque that the current gives with the constant of " +
          four_digits(motor.torque_constant_Nm_A) + " Nm/A, which follows from no_load_speed_rpm",
      "0.2 to 1.05 times",
      "torques in Nm (1 kgf cm is 0.0981 Nm, 1 oz in is 0.00706 Nm), speed and torque at the same shaft?");
}

std::string rated_note(const MotorSheet& sheet, const SheetMotor& motor) {
  if (!sheet.rated) return {};
  const double to_motor = sheet.at_output ? sheet.gear_ratio : 1.0;
  const double needed_V = motor.resistance_ohm * sheet.rated->current_A +
                          motor.torque_constant_Nm_A * to_motor * sheet.rated->speed_rad_s;
  if (std::abs(needed_V / sheet.nominal_voltage_V - 1) < kOdd) return {};
  return "the rated point needs " + four_digits(needed_V) +
         " V with the constants of stall and no load, the sheet "
         "states " +
         four_digits(sheet.nominal_voltage_V) + " V";
}

}  // namespace

Schema motor_sheet_schema() {
  return with_physical_bounds(schema_in(embedded::file_schemas, "motor_sheet", false));
}

RobotDraft read_motor_sheet(const Document& document) {
  check_document(document, "motor_sheet", motor_sheet_schema());
  const Node node = document.root()["motor_sheet"];
  const MotorSheet sheet = sheet_of(node);
  check_sheet(node, sheet);
  const SheetMotor motor = motor_of(sheet);
  check_motor(node, sheet, motor);
  RobotDraft draft;
  const std::string from = std::filesystem::path(document.file()).filename().string() + ": ";
  draft.state("motor.gear_ratio", sheet.gear_ratio,
              from + (node.has("gear_ratio") ? "gear_ratio"
                                             : "not stated: the other constants are those of the output"));
  draft.state("motor.resistance_ohm", motor.resistance_ohm,
              from + (sheet.resistance_ohm ? "resistance_ohm"
                      : sheet.stall        ? "nominal voltage / stall current"
                                           : "speed drop from no load to the rated point"));
  const std::string constant =
      from + (sheet.voltage_constant_V_s_rad ? "30 / (pi speed_constant_rpm_V)"
                                             : "(voltage - resistance * no-load current) / no-load speed");
  draft.state("motor.torque_constant_Nm_A", motor.torque_constant_Nm_A, constant);
  draft.state("motor.voltage_constant_V_s_rad", motor.torque_constant_Nm_A, constant);
  draft.state(
      "motor.viscous_friction_Nm_s_rad", 0.0,
      from + "no sheet tells it from the loss of the gear: part of friction_torque_Nm and gear_efficiency");
  const std::string torque = sheet.rated ? "rated" : "stall";
  draft.state("motor.friction_torque_Nm", motor.friction_torque_Nm,
              from + torque + " torque * no-load / (" + torque +
                  " - no-load) current, at the output; wheels and floor add theirs");
  draft.state("motor.max_voltage_V", sheet.nominal_voltage_V,
              from + "nominal_voltage_V; the driver's may differ");
  if (motor.loss_fraction > 1e-3 && (sheet.stall || sheet.rated))
    draft.values.push_back({"effects",
                            "gear_efficiency: {loss_fraction: " + four_digits(motor.loss_fraction) + "}",
                            from + torque + " torque against torque constant * (current - no-load current)"});
  if (std::string note = rated_note(sheet, motor); !note.empty()) draft.notes.push_back(from + note);
  return draft;
}

}  // namespace joulepath
