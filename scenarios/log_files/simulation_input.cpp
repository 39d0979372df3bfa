#include "scenarios/log_files/simulation_input.hpp"

#include <algorithm>
#include <filesystem>

#include "model/estimate.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/mission_source.hpp"
#include "scenarios/robot_files/effect_list.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& file, const std::string& key, const std::string& found,
                         const std::string& accepted, const std::string& hint = {}) {
  throw ConfigError({.mark = {.file = file}, .key = key, .found = found, .accepted = accepted, .hint = hint});
}

Pose first_pose(const Trajectory& t) {
  if (t.position_x_m.empty() || t.position_y_m.empty() || t.heading_rad.empty()) return {};
  return {t.position_x_m.front(), t.position_y_m.front(), t.heading_rad.front()};
}

void account(SimulationInput& input) {
  input.planned_energy_J =
      estimate_energy(make_plant(input.robot), input.reference, {.reach_s = 0.0}).by_cause.total_J();
  input.planned_duration_s = input.reference.time_s.back() - input.reference.time_s.front();
}

SimulationInput from_trajectory(const std::string& path, const std::string& robot_file) {
  const bool is_directory = fs::is_directory(path);
  const std::string file = is_directory ? (fs::path(path) / "trajectory.csv").string() : path;
  if (robot_file.empty())
    refuse(path, "--robot", "nothing", "a robot file", "a trajectory does not name its robot");
  SimulationInput input{.name = path, .robot = read_robot(robot_file)};
  input.reference = read_run_log(file, input.robot.geometry).trajectory;
  input.start = first_pose(input.reference);
  account(input);
  const fs::path plan = fs::path(path) / "plan.json";
  if (is_directory && fs::exists(plan)) {
    const Document document = Document::load(plan.string());
    input.planned_energy_J = document.root()["energy_J"].number();
    input.planned_duration_s = document.root()["duration_s"].number();
  }
  return input;
}

/// If all legs are prescribed they are simulated unchanged, so that coasting stays coasting.
SimulationInput from_motions(const MissionRequest& mission, const MissionWorld& world) {
  SimulationInput input{.name = mission.file, .robot = world.robot, .start = mission.start.pose};
  Pose pose = input.start;
  double time_s = 0;
  for (const LegRequest& leg : mission.legs) {
    std::vector<PrescribedMotion> motions{*leg.motion};
    if (leg.dwell_s > 0) motions.push_back({.profile = MotionProfile::stand, .duration_s = leg.dwell_s});
    TimedMotion timed;
    try {
      timed = timed_motion(input.robot, motions,
                           {.start = pose, .start_time_s = time_s, .payload_kg = leg.payload.from_kg});
    } catch (const ConfigError& error) {
      ConfigError::Detail detail = error.detail();
      detail.mark = leg.marks.at("motion");
      detail.key = leg.marks.key_path(detail.key);
      throw ConfigError(detail);
    }
    Trajectory& all = input.reference;
    const Trajectory& t = timed.trajectory;
    const std::size_t skip = all.size() > 0 ? 1 : 0;  // the joint is already contained
    const auto join = [&](std::vector<double>& to, const std::vector<double>& from) {
      to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(skip), from.end());
    };
    join(all.time_s, t.time_s);
    join(all.linear_speed_m_s, t.linear_speed_m_s);
    join(all.angular_speed_rad_s, t.angular_speed_rad_s);
    join(all.payload_kg, t.payload_kg);
    input.coasting.insert(input.coasting.end(), timed.coasting.begin(), timed.coasting.end());
    time_s = t.time_s.back();
    pose = {t.position_x_m.back(), t.position_y_m.back(), t.heading_rad.back()};
  }
  account(input);
  return input;
}

SimulationInput from_mission(const std::string& path, const std::string& robot_file,
                             const ReadOptions& options, const PlanOptions& planning) {
  MissionRequest mission = read_mission(path, options);
  replace_file(mission, "robot", &MissionRequest::robot_file, robot_file);
  const MissionWorld world = read_world(mission, options);
  const bool prescribed =
      !mission.legs.empty() &&
      std::all_of(mission.legs.begin(), mission.legs.end(), [](const LegRequest& leg) { return leg.motion; });
  if (prescribed) return from_motions(mission, world);
  const Plan plan = plan_mission(mission, world, planning);
  if (plan.status != SolveStatus::optimal && plan.status != SolveStatus::feasible)
    return {.name = path,
            .robot = world.robot,
            .infeasible = plan.message.empty() ? "the mission has no feasible plan" : plan.message};
  SimulationInput input = simulation_input(plan, plan_trajectory(plan, make_plant(world.robot)), world.robot);
  input.name = path;
  return input;
}

}  // namespace

SimulationInput simulation_input(const Plan& plan, const Trajectory& trajectory, const Robot& robot) {
  return {.name = plan.mission,
          .robot = robot,
          .reference = trajectory,
          .start = first_pose(trajectory),
          .planned_energy_J = plan.energy.total_J(),
          .planned_duration_s = plan.duration_s};
}

SimulationRequest simulation_request(const SimulationInput& input, const std::vector<EffectSetting>& effects,
                                     bool ideal_sensors, std::uint64_t seed) {
  return {.robot = input.robot,
          .effects = effects,
          .reference = input.reference,
          .coasting = input.coasting,
          .start = input.start,
          .sensors = ideal_sensors ? SensorSettings{} : typical_sensors(),
          .seed = seed};
}

SimulationInput read_simulation_input(const std::string& path, const std::string& robot_file,
                                      const ReadOptions& options, const PlanOptions& planning) {
  if (!fs::exists(path))
    refuse(path, "", "no such file", "a plan's directory, a trajectory (CSV) or a mission (YAML)");
  if (fs::is_directory(path) || fs::path(path).extension() == ".csv")
    return from_trajectory(path, robot_file);
  return from_mission(path, robot_file, options, planning);
}

NamedSettings split_settings(const std::string& text) {
  const std::size_t colon = text.find(':');
  NamedSettings named{.name = text.substr(0, colon)};
  std::string rest = colon == std::string::npos ? "" : text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string pair = rest.substr(0, comma);
    rest = comma == std::string::npos ? "" : rest.substr(comma + 1);
    const std::size_t equals = pair.find('=');
    named.settings.emplace_back(pair.substr(0, equals),
                                equals == std::string::npos ? "" : pair.substr(equals + 1));
  }
  return named;
}

EffectSetting parse_effect(const std::string& text) {
  const NamedSettings named = split_settings(text);
  Value parameters, entry;
  parameters.kind = entry.kind = Value::Kind::map;
  for (const auto& [key, value] : named.settings) {
    if (std::ranges::count(parameters.entries, key, &Value::Entry::key) > 0)
      refuse("--effect", named.name + "." + key, "it twice", "each parameter once");
    parameters.entries.push_back({.key = key});
    Value& scalar = parameters.entries.back().value;
    scalar.kind = value.empty() ? Value::Kind::null : Value::Kind::scalar;
    scalar.text = value;
  }
  entry.entries.push_back({.key = named.name, .value = std::move(parameters)});
  const Node node(entry, "--effect", "", PathStyle::dotted);
  check_value(node, effect_entry_schema());
  return read_effect_entry(node);
}

}  // namespace joulepath
