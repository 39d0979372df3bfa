#include "model/simulation/simulate.hpp"

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/terminal.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/log_files/simulation_input.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

Json pose_json(const Pose& pose) {
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"heading_rad", pose.heading_rad}};
}

double percent(double value, double of) { return of != 0 ? 100 * (value / of - 1) : 0.0; }

Json balance_json(const EnergyBalance& balance) {
  return {{"motors", balance.motors_J},
          {"copper", balance.copper_J},
          {"driver", balance.driver_J},
          {"gear", balance.gear_J},
          {"wheel_friction", balance.wheel_friction_J},
          {"body_work", balance.body_work_J},
          {"creep", balance.creep_J},
          {"stored", balance.stored_J}};
}

/// The summary of one run: planned against executed, and the energy by cause.
Json run_json(const std::string& file, const SimulationInput& input, const SimulationRequest& request,
              const SimulationResult& result, double standby_W) {
  const Pose& to = result.planned_pose;
  const Pose& end = result.final_pose;
  const double planned_motion_J =
      input.planned_energy_J - input.robot.power.standby_W * input.planned_duration_s;
  const double motion_J = result.energy_J - standby_W * result.duration_s;
  return {
      {"file", file},
      {"input", input.name},
      {"seed", request.seed},
      {"planned",
       {{"energy_J", input.planned_energy_J},
        {"motion_energy_J", planned_motion_J},
        {"duration_s", input.planned_duration_s},
        {"end", pose_json(to)}}},
      {"executed",
       {{"energy_J", result.energy_J},
        {"motion_energy_J", motion_J},
        {"motor_energy_J", {{"left", result.motor_energy_J.left}, {"right", result.motor_energy_J.right}}},
        {"battery_loss_J", result.battery_loss_J},
        {"duration_s", result.duration_s},
        {"came_to_rest", result.came_to_rest},
        {"end", pose_json(end)}}},
      {"difference",
       {{"energy_percent", percent(result.energy_J, input.planned_energy_J)},
        {"motion_energy_percent", percent(motion_J, planned_motion_J)},
        {"duration_s", result.duration_s - input.planned_duration_s},
        {"position_m", std::hypot(end.x_m - to.x_m, end.y_m - to.y_m)},
        {"heading_rad", end.heading_rad - to.heading_rad}}},
      {"balance_J", balance_json(result.balance)},
      {"worst_wheel_speed_error_rad_s", result.worst_speed_error_rad_s},
      {"saturated_fraction", result.saturated_fraction},
      {"battery_gave_way", result.battery_gave_way}};
}

Json effects_json(const std::vector<EffectSetting>& effects) {
  Json list = Json::array();
  for (const EffectSetting& effect : effects) {
    Json parameters = Json::object();
    if (effect.side) parameters["side"] = side_name(*effect.side);
    for (const auto& [name, value] : effect.parameters) parameters[name] = value;
    list.push_back({{effect.name, parameters}});
  }
  return list;
}

std::string numbered(const char* stem, std::size_t number) {
  return std::string(stem) + (number < 10 ? "_0" : "_") + std::to_string(number) + ".csv";
}

std::vector<std::string> names_of_files(std::size_t runs) {
  std::vector<std::string> names{"dataset.yaml", "robot.yaml", "simulation.json"};
  for (std::size_t k = 1; k <= runs; ++k) {
    names.push_back(numbered("run", k));
    names.push_back(numbered("executed", k));
  }
  return names;
}

class SimulateCommand : public Command {
 public:
  SimulateCommand()
      : Command({.name = "simulate",
                 .says = "drive plans or missions on a simulated robot and log them",
                 .examples =
                     "  joulepath simulate out/warehouse_pick --robot "
                     "scenarios/robots/nomad_super_scout.yaml --out "
                     "out/sim\n"
                     "  joulepath simulate mission.yaml --effect rolling_resistance:coefficient=0.015 "
                     "--effect dragging_wheel:side=left,torque_Nm=0.1 --out out/sim --seed 7\n"
                     "  joulepath diagnose out/sim/dataset.yaml --out out/diagnosis\n"}) {}

  void declare(CommandLine& line) override {
    line.option("input", inputs_,
                "plan directories (trajectory.csv, plan.json), trajectories (CSV) or missions (YAML)")
        .required();
    line.option("--out", out_, "directory for the logs, dataset.yaml, robot.yaml, simulation.json")
        .required();
    line.option("--robot", robot_, "robot file; replaces a mission's");
    line.option("--effect", effects_,
                "effect of the simulated robot that the controller does not model, as "
                "NAME:PARAMETER=VALUE,... (repeatable)")
        .repeatable();
    line.option("--repeat", repeat_, "number of runs of each input, each with its own noise")
        .between(1, 1000);
    line.option("--seed", seed_, "seed of the sensors' noise; each run has its own").shows_default();
    line.option("--time-of-day-s", time_of_day_s_,
                "operating time of the robot before the first run (heating)")
        .between(0.0, 1e9);
    line.option("--sample-rate-Hz", sensors_.sample_rate_Hz, "rows per second of the log")
        .between(1.0, 1000.0)
        .shows_default();
    line.option("--delay-s", sensors_.electrical_delay_s, "delay of the electrical channels")
        .between(0.0, 5.0);
    line.flag("--ideal-sensors", ideal_, "no noise, no quantization");
    line.option("--inductance-H", inductance_H_, "inductance of each armature; 0: neglected")
        .between(0.0, 1.0);
    line.option("--control-period-s", controller_.period_s, "period of the wheel-speed loops")
        .between(1e-4, 0.1)
        .shows_default();
    line.option("--bandwidth-per-s", controller_.bandwidth_per_s, "bandwidth of the wheel-speed loops")
        .between(0.1, 200.0)
        .shows_default();
    line.flag("--no-feed-forward", feedback_only_, "feedback only");
    add_common_flags(line, common_, "qjfu");
  }

  int run() override {
    if (ideal_ && repeat_ > 1)
      throw UsageError("--ideal-sensors and --repeat " + std::to_string(repeat_) +
                       " exclude each other: runs without noise are the same");
    OutputDirectory out(out_, names_of_files(inputs_.size() * repeat_), common_.force);
    std::vector<EffectSetting> effects;
    for (const std::string& text : effects_) effects.push_back(parse_effect(text));
    Json report{{"schema", "joulepath/simulation/1"},
                {"seed", seed_},
                {"effects", effects_json(effects)},
                {"runs", Json::array()}};
    std::string dataset = "schema: joulepath/dataset/1\nrobot: robot.yaml\nruns:\n";
    double hour_s = time_of_day_s_;
    std::size_t k = 0;
    for (const std::string& name : inputs_) {
      const SimulationInput input = read_simulation_input(name, robot_, {.untrusted = common_.untrusted});
      if (!input.infeasible.empty()) {
        std::cerr << "joulepath: " << name << ": " << input.infeasible << '\n';
        return kInfeasibleOrFailed;
      }
      if (k == 0) out.write("robot.yaml", robot_text(input.robot));
      for (std::size_t i = 0; i < repeat_; ++i) {
        const SimulationRequest request = request_for(input, effects, hour_s, seed_of_run(seed_, k++));
        const SimulationResult result = simulate(request);
        const double standby_W = make_plant(request.robot, effects).robot.power.standby_W;
        out.write(numbered("run", k), run_log_text(result.log));
        out.write(numbered("executed", k), run_log_text(result.executed));
        dataset += "  - {file: " + numbered("run", k) + ", start_time_s: " + figure(hour_s, 12) + "}\n";
        report["runs"].push_back(run_json(numbered("run", k), input, request, result, standby_W));
        hour_s += result.duration_s;
      }
    }
    out.write("dataset.yaml", dataset);
    out.write("simulation.json", report.dump(2) + "\n");
    out.commit();
    if (common_.json)
      std::cout << report.dump(2) << '\n';
    else if (!common_.quiet)
      print(report);
    return kDone;
  }

 private:
  SimulationRequest request_for(const SimulationInput& input, const std::vector<EffectSetting>& effects,
                                double hour_s, std::uint64_t seed) const {
    SimulationRequest request = simulation_request(input, effects, ideal_, seed);
    request.time_of_day_s = hour_s;
    request.controller = controller_;
    request.controller.feed_forward = !feedback_only_;
    request.sensors.sample_rate_Hz = sensors_.sample_rate_Hz;
    request.sensors.electrical_delay_s = sensors_.electrical_delay_s;
    if (inductance_H_)
      for (Side side : kSides) request.robot.motor[side].inductance_H = *inductance_H_;
    return request;
  }

  void print(const Json& report) const {
    Table table({"run", "planned", "executed", "", "time", "off by", "heading"});
    for (const Json& run : report["runs"]) {
      const Json& difference = run["difference"];
      const double change = difference["energy_percent"];
      table.row(
          {run["file"], figure(run["planned"]["energy_J"]) + " J", figure(run["executed"]["energy_J"]) + " J",
           (change >= 0 ? "+" : "") + figure(change, 3) + " %", figure(run["executed"]["duration_s"]) + " s",
           figure(difference["position_m"], 3) + " m", figure(difference["heading_rad"], 3) + " rad"});
      if (run["battery_gave_way"])
        std::cerr << run["file"] << ": the required power exceeds the battery's maximum\n";
      if (const double share = run["saturated_fraction"]; share > 0.001)
        std::cerr << run["file"] << ": the motor drivers were saturated for " << figure(100 * share, 2)
                  << " % of the time\n";
    }
    table.print(std::cout);
    std::cout << "energy at the battery's terminals, standby included\n" << out_ << "/dataset.yaml\n";
  }

  std::vector<std::string> inputs_{};
  std::string out_{};
  std::string robot_{};
  std::vector<std::string> effects_{};
  std::size_t repeat_{1};
  std::uint64_t seed_{1};
  double time_of_day_s_{};
  SensorSettings sensors_{};
  ControllerSettings controller_{};
  bool ideal_{}, feedback_only_{};
  std::optional<double> inductance_H_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_simulate_command() { return std::make_unique<SimulateCommand>(); }

}  // namespace joulepath
