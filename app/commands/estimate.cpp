#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/terminal.hpp"
#include "diagnosis/estimation/estimate_dataset.hpp"
#include "model/printable.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/log_tables.hpp"
#include "scenarios/log_files/run_log.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostExcess = 1.0,
                 kMostLack = 0.5;  ///< relative errors: twice or half of the measured energy

Json sided_json(const Sided<double>& value) { return {{"left", value.left}, {"right", value.right}}; }

Json run_json(const RunEstimate& run) {
  const EnergyByCause& cause = run.estimate.by_cause;
  Json effects = Json::object();
  for (const auto& [name, energy_J] : cause.effects_J) effects[name] = energy_J;
  Json json{{"run", run.name},
            {"duration_s", run.estimate.duration_s},
            {"distance_m", run.estimate.distance_m},
            {"estimated",
             {{"motor_energy_J", sided_json(run.estimate.counted_J)},
              {"motor_energy_with_braking_J", sided_json(run.estimate.motor_J)},
              {"energy_J", run.terminals_J},
              {"battery_loss_J", run.estimate.battery_loss_J},
              {"energy_by_cause_J",
               {{"copper", cause.copper_J},
                {"coulomb_friction", cause.coulomb_friction_J},
                {"viscous_friction", cause.viscous_friction_J},
                {"kinetic", cause.kinetic_J},
                {"standby", cause.standby_J},
                {"effects", effects},
                {"not_recovered", cause.not_recovered_J}}},
              {"smoothing_reach_s", run.estimate.reach_s}}}};
  Json measured = Json::object();
  if (run.measured_motor_J) measured["motor_energy_J"] = sided_json(*run.measured_motor_J);
  if (run.measured_battery_J) measured["energy_J"] = *run.measured_battery_J;
  if (!measured.empty()) json["measured"] = measured;
  if (run.error) json["error_percent"] = 100 * *run.error;
  json["required"] = {{"sigma_J", run.sigma_J},
                      {"energy_upper_95_J", run.upper_95_J},
                      {"capacity_upper_95_Wh", run.capacity_Wh}};
  return json;
}

Json report_of(const DatasetEstimate& all) {
  Json report{{"schema", "joulepath/estimate/1"},
              {"braking_counts_with_efficiency", all.regeneration_efficiency},
              {"runs", Json::array()}};
  for (const RunEstimate& run : all.runs) report["runs"].push_back(run_json(run));
  report["compared_runs"] = all.compared;
  if (all.compared > 0) {
    report["fitness_percent"] = 100 * all.fitness;
    report["mean_error_percent"] = 100 * all.mean_error;
  }
  if (all.model_error) report["model_error_percent"] = 100 * *all.model_error;
  report["upper_bound"] =
      "one-sided 95 % of a normal distribution: energy + battery loss + 1.645 sqrt(sigma^2 + (model_error "
      "energy)^2), over (1 - reserve); sigma from the robot file's uncertainty, model_error the rms of the "
      "compared runs' errors (none below " +
      std::to_string(kLeastRunsToCompare) + " runs)";
  return report;
}

class EstimateCommand : public Command {
 public:
  EstimateCommand()
      : Command({.name = "estimate",
                 .says = "energy and power of logged motions from odometry alone",
                 .examples = "  joulepath estimate run.csv --robot robot.yaml\n"
                             "  joulepath estimate scenarios/paper/straight_measured.yaml\n"
                             "  joulepath estimate dataset.yaml --json | jq .fitness_percent\n"}) {}

  void declare(CommandLine& line) override {
    line.option("input", input_, "run log (" + log_formats() + ") or dataset (YAML)").required();
    line.option("--robot", robot_, "robot file; required for a log, replaces a dataset's");
    line.option("--out", out_, "directory for estimate.json and the power over time of every run");
    line.option("--smoothing-s", reach_s_,
                "half width of the smoothing window for speeds; 0: none; default: from their noise")
        .between(0.0, 5.0);
    add_common_flags(line, common_, "qjfu");
  }

  int run() override {
    const Dataset dataset =
        read_dataset_or_log(input_, {.untrusted = common_.untrusted, .keep_whole_drives = true}, robot_);
    if (!common_.quiet)
      for (const LogArtifact& artifact : dataset.artifacts)
        if (artifact.kind == "cut" || artifact.kind == "partial_channel")
          std::cerr << "note: " << artifact.channel << (artifact.channel.empty() ? "" : " ")
                    << artifact.description << '\n';
    std::optional<OutputDirectory> out;
    if (!out_.empty()) out.emplace(out_, file_names(dataset.runs.size()), common_.force);
    const DatasetEstimate all = estimate_dataset(dataset, {.reach_s = reach_s_});
    const Json report = report_of(all);
    if (out) {
      for (std::size_t k = 0; k < all.runs.size(); ++k)
        out->write(file_names(k + 1).back(), run_log_text(all.runs[k].estimate.power));
      out->write("estimate.json", report.dump(2) + "\n");
      out->commit();
    }
    if (!common_.quiet) hint(all);
    if (common_.json)
      std::cout << report.dump(2) << '\n';
    else if (!common_.quiet)
      print(all);
    return kDone;
  }

 private:
  /// Errors that no model has are those of the data: units, signs, a robot file of another robot.
  void hint(const DatasetEstimate& all) const {
    for (const RunEstimate& run : all.runs)
      if (run.error && (*run.error > kMostExcess || *run.error < -kMostLack)) {
        std::cerr << "note: " << printable(run.name) << ": the estimate is " << figure(1 + *run.error, 3)
                  << " times the measured energy: joulepath check " << printable(input_)
                  << " examines the data\n";
        return;
      }
  }

  static std::vector<std::string> file_names(std::size_t runs) {
    std::vector<std::string> names{"estimate.json"};
    for (std::size_t k = 1; k <= runs; ++k)
      names.push_back("power" + std::string(k < 10 ? "_0" : "_") + std::to_string(k) + ".csv");
    return names;
  }

  static std::string joules(const std::optional<Sided<double>>& energy_J, Side side) {
    return energy_J ? figure((*energy_J)[side]) : "-";
  }

  static void print(const DatasetEstimate& all) {
    Table table(
        {"run", "left J", "measured", "right J", "measured", "error", "terminals J", "battery Wh (95 %)"});
    for (const RunEstimate& run : all.runs)
      table.row({run.name, figure(run.estimate.counted_J.left), joules(run.measured_motor_J, Side::left),
                 figure(run.estimate.counted_J.right), joules(run.measured_motor_J, Side::right),
                 run.error ? figure(100 * *run.error, 3) + " %" : "-", figure(run.terminals_J),
                 figure(run.capacity_Wh)});
    table.print(std::cout);
    if (all.compared > 0)
      std::cout << "fitness " << figure(100 * all.fitness, 4) << " % of " << all.compared
                << " runs within 10 %; mean error " << figure(100 * all.mean_error, 3) << " %\n";
    std::cout
        << "braking power counts with the robot file's efficiency " << figure(all.regeneration_efficiency, 3)
        << ", for estimated and measured energy\n"
        << "battery: 95 % upper bound of the task's energy, with the reserve; normal errors from the robot "
           "file's uncertainty"
        << (all.model_error ? " and the rms error of these runs" : "") << '\n';
  }

  std::string input_{};
  std::string robot_{};
  std::string out_{};
  std::optional<double> reach_s_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_estimate_command() { return std::make_unique<EstimateCommand>(); }

}  // namespace joulepath
