#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/output_directory.hpp"
#include "app/terminal.hpp"
#include "extensions/onboard/planned_pieces.hpp"
#include "extensions/onboard/replan/follow_drive.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/log_files/simulation_input.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;
using Kind = Disturbance::Kind;

/// A kind of disturbance with what it is where the command line does not say.
struct Preset {
  const char* name;
  const char* size_says;
  Disturbance usual;
  double least{}, most{};  ///< of the size
};
constexpr double kPartOfPlan = 0.3;  ///< at which a disturbance begins
constexpr double kLongest_s = 100;   ///< the simulation ends 120 s after the plan
const Preset kPresets[] = {
    {"push", "N along the heading", {Kind::push, 0, 1.0, -40.0}, -1e4, 1e4},
    {"slip", "wheel travel lost to slip, m", {Kind::slip, 0, 0.0, 0.1}, 0, 10},
    {"late_start", "s", {Kind::late_start, 0, 0.0, 2.0}, 0, kLongest_s},
    {"payload",
     "times the stated payload, known for_s later; above max_payload_kg the robot stops",
     {Kind::payload, 0, 1.0, 1.3},
     0,
     10},
    {"obstacle", "m ahead, for for_s", {Kind::obstacle, 0, 4.0, 1.5}, 0, 1000},
    {"speed_limit", "m/s, for for_s", {Kind::speed_limit, 0, 5.0, 0.3}, 1e-3, 100},
};

[[noreturn]] void refuse_disturbance(const std::string& found, const std::string& accepted) {
  throw ConfigError({{"--disturb", 0, 0}, "", found, accepted, "as in push:at_s=10,for_s=1,size=-40"});
}

void check_range(const std::string& key, double value, double least, double most, const char* why) {
  if (value >= least && value <= most) return;
  refuse_disturbance(key + "=" + figure(value, 6),
                     figure(least, 6) + " to " + figure(most, 6) + " (" + why + ")");
}

/// Numbers that a drive can meet.
void check_disturbance(const Disturbance& disturbance, const Preset& preset, const Robot& robot,
                       const PlannedDrives& plan) {
  check_range("at_s", disturbance.at_s, 0, plan.duration_s, "s; within the plan");
  check_range("for_s", disturbance.for_s, 0, kLongest_s, "s; the simulation ends 120 s after the plan");
  check_range("size", disturbance.size, preset.least, preset.most, preset.size_says);
  double most_kg = 0;
  for (const PlannedDrive& drive : plan.drives)
    most_kg = std::max({most_kg, drive.request.payload.from_kg, drive.request.payload.to_kg});
  if (disturbance.kind == Kind::push)
    check_range("size", std::abs(disturbance.size), 0, kGravity_m_s2 * robot.total_mass_kg(most_kg),
                "N; no more than the robot weighs");
}

/// `NAME[:at_s=..,for_s=..,size=..]`.
Disturbance parse_disturbance(const std::string& text, const Robot& robot, const PlannedDrives& plan) {
  const NamedSettings named = split_settings(text);
  const auto* preset = std::find_if(std::begin(kPresets), std::end(kPresets),
                                    [&](const Preset& p) { return named.name == p.name; });
  if (preset == std::end(kPresets))
    refuse_disturbance("'" + named.name + "'", "push, slip, late_start, payload, obstacle or speed_limit");
  Disturbance disturbance = preset->usual;
  disturbance.at_s = kPartOfPlan * plan.duration_s;
  for (const auto& [key, text_of] : named.settings) {
    const std::optional<double> value = parse_number(text_of);
    if (!value) refuse_disturbance("'" + key + (text_of.empty() ? "" : "=" + text_of) + "'", "KEY=NUMBER");
    if (key == "at_s")
      disturbance.at_s = *value;
    else if (key == "for_s")
      disturbance.for_s = *value;
    else if (key == "size")
      disturbance.size = *value;
    else
      refuse_disturbance("'" + key + "'", "at_s, for_s or size");
  }
  check_disturbance(disturbance, *preset, robot, plan);
  return disturbance;
}

std::string follow_examples() {
  std::string text =
      "  joulepath follow out/warehouse_pick --robot scenarios/robots/nomad_super_scout.yaml --out "
      "out/follow\n"
      "  joulepath follow out/warehouse_pick --robot robot.yaml --disturb payload --disturb "
      "obstacle:at_s=30,size=2 --out out/follow\n\nDisturbances (at_s, for_s, size):\n";
  for (const Preset& preset : kPresets) {
    const std::string name = preset.name;
    text += "  " + name + std::string(13 - name.size(), ' ') + "size: " + preset.size_says + "; default " +
            figure(preset.usual.size, 3) + "\n";
  }
  return text;
}

class FollowPlanCommand : public Command {
 public:
  FollowPlanCommand()
      : Command({.name = "follow",
                 .says = "drive a plan on the simulated robot with the profile follower, with disturbances",
                 .examples = follow_examples()}) {}

  void declare(CommandLine& line) override {
    line.option("plan", directory_, "directory of a plan (trajectory.csv)").required();
    line.option("--robot", robot_, "robot file").required();
    line.option("--out", out_, "directory for executed.csv and follow.json").required();
    line.option("--disturb", disturbances_, "NAME or NAME:at_s=..,for_s=..,size=.. (repeatable)")
        .repeatable();
    line.option("--effect", effects_,
                "effect of the simulated robot that neither planner nor follower models, as "
                "NAME:PARAMETER=VALUE,... (repeatable)")
        .repeatable();
    line.option("--period-s", settings_.period_s, "time between two commands, s")
        .between(0.005, 0.5)
        .shows_default();
    line.option("--latency-s", settings_.latency_s, "time from a pose to its command's effect, s")
        .between(0.0, 0.5)
        .shows_default();
    add_common_flags(line, common_, "qjf");
  }

  int run() override {
    OutputDirectory out(out_, {"executed.csv", "follow.json"}, common_.force);
    const Robot robot = read_robot(robot_);
    const PlannedDrives plan = read_planned_drives(directory_, robot);
    FollowRequest request{
        .robot = robot, .start = plan.start, .end_s = plan.duration_s, .follower = settings_};
    for (const std::string& text : effects_) request.effects.push_back(parse_effect(text));
    for (const std::string& text : disturbances_)
      request.disturbances.push_back(parse_disturbance(text, robot, plan));
    for (const PlannedDrive& drive : plan.drives)
      request.pieces.push_back({&drive.request, &drive.plan, drive.start_s, drive.end_s});
    const FollowResult result = follow(request);
    const Json report = report_of(plan, result);
    out.write("executed.csv", run_log_text(result.executed));
    out.write("follow.json", report.dump(2) + "\n");
    out.commit();
    if (common_.json)
      std::cout << report.dump(2) << '\n';
    else if (!common_.quiet)
      print(report);
    return result.finished == request.pieces.size() ? kDone : kInfeasibleOrFailed;
  }

 private:
  Json report_of(const PlannedDrives& plan, const FollowResult& result) const {
    const bool arrived = std::isfinite(result.late_s);
    Json limits = Json::array();
    for (const LimitUse& use : result.limits)
      limits.push_back({{"limit", use.limit}, {"largest_fraction", use.fraction}, {"at_s", use.at_s}});
    return {{"schema", "joulepath/follow/1"},
            {"plan", directory_},
            {"planned", {{"energy_J", plan.energy_J}, {"duration_s", plan.duration_s}}},
            {"executed",
             {{"energy_J", result.energy_J},
              {"duration_s", result.duration_s},
              {"late_s", arrived ? Json(std::max(0.0, result.late_s)) : Json(nullptr)},
              {"pieces", result.finished},
              {"of_pieces", plan.drives.size()},
              {"off_path", result.off_path},
              {"stopped", stop_of(plan, result)},
              {"stopped_by", result.stopped_by.empty() ? Json(nullptr) : Json(result.stopped_by)},
              {"replans", result.replans},
              {"worst_lateral_m", result.worst_lateral_m},
              {"end_error_m", result.end_error_m},
              {"end_error_rad", result.end_error_rad}}},
            {"command_limits", limits}};
  }

  static Json stop_of(const PlannedDrives& plan, const FollowResult& result) {
    if (!result.stopped) return nullptr;
    const FollowStop& stop = *result.stopped;
    return {{"time_s", stop.time_s},
            {"leg", plan.drives.at(stop.piece).leg},
            {"piece", stop.piece},
            {is_turn(plan.drives[stop.piece].request.piece) ? "turned_rad" : "along_m", stop.s},
            {"x_m", stop.pose.x_m},
            {"y_m", stop.pose.y_m}};
  }

  /// When, where and why a drive stopped without having arrived.
  static std::string stop_text(const Json& executed) {
    const Json &stop = executed["stopped"], &limit = executed["stopped_by"];
    std::string text;
    if (!stop.is_null())
      text = ": stopped at " + figure(stop["time_s"]) + " s on leg " +
             std::to_string(stop["leg"].get<int>() + 1) + ", piece " + stop["piece"].dump() + " at " +
             (stop.contains("along_m") ? figure(stop["along_m"], 3) + " m"
                                       : figure(stop["turned_rad"], 3) + " rad") +
             ", (" + figure(stop["x_m"], 3) + ", " + figure(stop["y_m"], 3) + ") m";
    return limit.is_null() ? text : text + ", by " + limit.get<std::string>();
  }

  static void print(const Json& report) {
    const Json &planned = report["planned"], &executed = report["executed"];
    Table table({"", "energy", "time"});
    table.row({"planned", figure(planned["energy_J"]) + " J", figure(planned["duration_s"]) + " s"});
    table.row({"executed", figure(executed["energy_J"]) + " J", figure(executed["duration_s"]) + " s"});
    table.print(std::cout);
    if (executed["off_path"])
      std::cout << "left the path: the follower stopped" << stop_text(executed) << "\n";
    else if (executed["late_s"].is_null())
      std::cout << "did not arrive (" << executed["pieces"] << " of " << executed["of_pieces"] << " pieces)"
                << stop_text(executed) << "\n";
    else
      std::cout << "late by at most " << figure(executed["late_s"], 3) << " s; off by "
                << figure(executed["end_error_m"], 3) << " m, " << figure(executed["worst_lateral_m"], 3)
                << " m aside at most; planned again " << executed["replans"] << " times\n";
    const auto use_text = [](const Json& use) {
      return use["limit"].get<std::string>() + " " + figure(100 * use["largest_fraction"].get<double>(), 3) +
             " %";
    };
    std::cout << "largest use of the limits by the commands: "
              << text_of_list(report["command_limits"], use_text) << "\n";
  }

  std::string directory_{};
  std::string robot_{};
  std::string out_{};
  std::vector<std::string> disturbances_{};
  std::vector<std::string> effects_{};
  FollowerSettings settings_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_follow_command() { return std::make_unique<FollowPlanCommand>(); }

}  // namespace joulepath
