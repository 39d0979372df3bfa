#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/terminal.hpp"
#include "diagnosis/calibration/calibration.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

const char* visibility_name(Visibility visibility) {
  return visibility == Visibility::seen ? "seen" : visibility == Visibility::weak ? "weak" : "unseen";
}

/// Numbers that are not finite become null.
nlohmann::ordered_json parameters_json(const CalibrationResult& result) {
  auto list = nlohmann::ordered_json::array();
  for (const CalibratedParameter& p : result.parameters)
    list.push_back({{"name", p.name},
                    {"unit", p.unit},
                    {"nominal", p.nominal},
                    {"value", p.value},
                    {"standard_deviation", p.standard_deviation},
                    {"interval_95", p.interval_95},
                    {"effective_runs", p.effective_runs},
                    {"visibility", visibility_name(p.visibility)},
                    {"note", p.note}});
  return list;
}

nlohmann::ordered_json correlations_json(const Robot& robot) {
  auto list = nlohmann::ordered_json::array();
  for (const Correlation& pair : robot.uncertainty_correlations)
    list.push_back({{"first", pair.first}, {"second", pair.second}, {"correlation", pair.correlation}});
  return list;
}

nlohmann::ordered_json line_json(const SteadyLine& line) {
  nlohmann::ordered_json json{{"b1_A", line.b1_A}, {"b2_A_s_rad", line.b2_A_s_rad}};
  if (line.has_voltage) json["c1_V"] = line.c1_V, json["c2_V_s_rad"] = line.c2_V_s_rad;
  return json;
}

nlohmann::ordered_json result_json(const CalibrationResult& result) {
  nlohmann::ordered_json json{
      {"method", result.method == CalibrationMethod::steady ? "steady" : "full"},
      {"runs", result.runs_used},
      {result.method == CalibrationMethod::steady ? "steady_segments" : "samples", result.samples_used},
      {"resampled", result.resampled},
      {"parameters", parameters_json(result)},
      {"current_rms_A", {{"before", result.current_rms_before_A}, {"after", result.current_rms_after_A}}}};
  if (result.voltage_rms_before_V)
    json["voltage_rms_V"] = {{"before", *result.voltage_rms_before_V},
                             {"after", *result.voltage_rms_after_V}};
  if (result.lines)
    json["equation_30"] = {{"left", line_json(result.lines->left)},
                           {"right", line_json(result.lines->right)}};
  json["uncertainty"] = result.robot.uncertainty;
  json["uncertainty_correlations"] = correlations_json(result.robot);
  json["notes"] = result.notes;
  return json;
}

/// `0.3671 +/- 0.0008`, or the note that there is no interval.
std::string interval_text(const CalibratedParameter& p) {
  if (p.visibility == Visibility::unseen) return "not seen";
  if (!std::isfinite(p.standard_deviation)) return "no interval";
  return figure(p.interval_95[0]) + " .. " + figure(p.interval_95[1]);
}

class Calibrate : public Command {
 public:
  Calibrate()
      : Command({.name = "calibrate",
                 .says = "fit a robot's friction, motor constants and inertias to measured runs",
                 .examples = "  joulepath calibrate dataset.yaml --out robot_calibrated.yaml\n"
                             "  joulepath calibrate dataset.yaml --method steady --json"}) {}

  void declare(CommandLine& line) override {
    line.option("DATASET", dataset_, "dataset: the robot and its runs").required();
    line.option("--robot", robot_, "robot file; replaces the dataset's");
    line.option("--out", out_, "robot file to write, with the calibrated values and their covariance");
    line.option(
            "--method", method_,
            "full: whole runs with voltages and currents; steady: stretches of constant speed, friction only")
        .one_of({"full", "steady"})
        .shows_default();
    add_common_flags(line, options_, "qjfu");
  }

  int run() override {
    const Dataset dataset = read_dataset_or_log(dataset_, {options_.untrusted}, robot_);
    const CalibrationResult result =
        calibrate(dataset, method_ == "steady" ? CalibrationMethod::steady : CalibrationMethod::full);
    if (!out_.empty())
      write_output_file(out_, robot_text_like(dataset.robot_file, result.robot), options_.force);
    if (options_.json) {
      std::cout << result_json(result).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
      return kDone;
    }
    tell(result);
    return kDone;
  }

 private:
  void tell(const CalibrationResult& result) const {
    Table table({"parameter", "robot file", "calibrated", "95 % interval", "unit"});
    for (const CalibratedParameter& p : result.parameters)
      table.row({p.name + (p.visibility == Visibility::weak ? " (weak)" : ""), figure(p.nominal),
                 figure(p.value), interval_text(p), p.unit});
    table.print(std::cout);
    std::cout << "current residual " << figure(result.current_rms_before_A) << " -> "
              << figure(result.current_rms_after_A) << " A rms";
    if (result.voltage_rms_before_V)
      std::cout << ", voltage " << figure(*result.voltage_rms_before_V) << " -> "
                << figure(*result.voltage_rms_after_V) << " V rms";
    std::cout << " (" << result.runs_used << " runs, intervals from resampled " << result.resampled << ")\n";
    if (!out_.empty()) std::cout << "wrote " << out_ << '\n';
    if (options_.quiet) return;
    for (const CalibratedParameter& p : result.parameters)
      if (!p.note.empty()) std::cerr << "note: " << p.name << ": " << p.note << '\n';
    for (const std::string& note : result.notes) std::cerr << "note: " << note << '\n';
  }

  std::string dataset_{}, robot_{}, out_{}, method_{"full"};
  CommonOptions options_{};
};

}  // namespace

std::unique_ptr<Command> make_calibrate_command() { return std::make_unique<Calibrate>(); }

}  // namespace joulepath
