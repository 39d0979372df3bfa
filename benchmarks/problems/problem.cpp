#include "benchmarks/problems/problem.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "model/limit_table.hpp"
#include "model/limits.hpp"

namespace joulepath::problems {
namespace {

constexpr std::pair<const char*, double Motor::*> kMotorKeys[] = {
    {"gear_ratio", &Motor::gear_ratio},
    {"resistance_ohm", &Motor::resistance_ohm},
    {"torque_constant_Nm_A", &Motor::torque_constant_Nm_A},
    {"voltage_constant_V_s_rad", &Motor::voltage_constant_V_s_rad},
    {"viscous_friction_Nm_s_rad", &Motor::viscous_friction_Nm_s_rad},
    {"friction_torque_Nm", &Motor::friction_torque_Nm}};
constexpr std::pair<const char*, double Inertia::*> kInertiaKeys[] = {
    {"chassis_mass_kg", &Inertia::chassis_mass_kg},
    {"wheel_mass_kg", &Inertia::wheel_mass_kg},
    {"chassis_yaw_inertia_kg_m2", &Inertia::chassis_yaw_inertia_kg_m2},
    {"payload_yaw_inertia_m2", &Inertia::payload_yaw_inertia_m2},
    {"wheel_axle_inertia_kg_m2", &Inertia::wheel_axle_inertia_kg_m2},
    {"wheel_diameter_inertia_kg_m2", &Inertia::wheel_diameter_inertia_kg_m2}};
constexpr std::pair<TimeMode, const char*> kModes[] = {{TimeMode::free_time, "free"},
                                                       {TimeMode::time_budget, "at_most"},
                                                       {TimeMode::fixed_time, "exactly"},
                                                       {TimeMode::minimum_time, "least"}};

Robot robot_from_json(const Json& json) {
  Robot robot;
  robot.geometry = {
      .wheel_radius_m = {json["wheel_radius_m"].get<double>(), json["wheel_radius_m"].get<double>()},
      .half_track_m = json["half_track_m"],
      .center_of_mass_offset_m = json["center_of_mass_offset_m"]};
  for (const auto& [key, field] : kInertiaKeys) robot.inertia.*field = json[key];
  for (const auto& [key, field] : kMotorKeys)
    for (const Side side : kSides)
      robot.motor[side].*field = json["motor"][key][side == Side::left ? 0 : 1].get<double>();
  return robot;
}

void read_limits(const Json& json, ProfileRequest& request) {
  for (const Limit& row : kLimits) {
    const auto found = json.find(std::string(row.key));
    if (found == json.end()) continue;
    if (row.field) request.limits.*row.field = found->get<double>();
    if (row.rating)
      for (const Side side : kSides) request.plant.robot.motor[side].*row.rating = found->get<double>();
  }
}

TimeGoal time_from_json(const Json& json) {
  for (const auto& [mode, name] : kModes)
    if (json["mode"] == name) return {mode, json.value("duration_s", kNoLimit)};
  throw std::runtime_error("unknown mode " + json["mode"].get<std::string>());
}

/// A turn in place has the angle (rad) as arc length and the sense (+-1) as curvature.
PathPiece piece_from_json(const Json& json) {
  const Knots knots{json["path"]["s_m"], json["path"]["curvature_per_m"]};
  if (json["kind"] == kTurn) return TurnInPlace{{}, knots.s_m.back() * knots.curvature_per_m.back()};
  return curve_through(knots);
}

Problem problem_from(const Json& json, const Json& robots) {
  Robot robot = robot_from_json(robots.at(json["robot"].get<std::string>()));
  robot.power = {.standby_W = json["standby_W"],
                 .regeneration_efficiency = json["regeneration_efficiency"],
                 .sharing = json["sharing"] == "bus" ? PowerSharing::bus : PowerSharing::wheel};
  const double payload_kg = json["payload_kg"];
  Problem problem{.id = json["id"],
                  .kind = json["kind"],
                  .robot_name = json["robot"],
                  .request = {.piece = piece_from_json(json),
                              .plant = make_plant(robot),
                              .payload = {payload_kg, payload_kg},
                              .start_rate = json["end_speeds_m_s"][0],
                              .end_rate = json["end_speeds_m_s"][1],
                              .time = time_from_json(json["time"])}};
  read_limits(json["limits"], problem.request);
  return problem;
}

}  // namespace

Curve curve_through(const Knots& knots) {
  std::vector<CurveSegment> segments;
  Pose pose{};
  for (std::size_t k = 0; k + 1 < knots.s_m.size(); ++k) {
    const double length_m = knots.s_m[k + 1] - knots.s_m[k];
    const double slope_per_m2 = (knots.curvature_per_m[k + 1] - knots.curvature_per_m[k]) / length_m;
    const LinearCurvature stretch(pose, length_m, knots.curvature_per_m[k], slope_per_m2);
    pose = stretch.at(length_m).pose;
    segments.emplace_back(stretch);
  }
  return Curve(std::move(segments));
}

Knots knots_of(const PathPiece& piece) {
  Knots knots{.s_m = piece_breakpoints(piece)};
  for (const double s : knots.s_m)
    knots.curvature_per_m.push_back(is_turn(piece) ? turn_sign(piece)
                                                   : piece_point(piece, s).curvature_per_m);
  return knots;
}

std::map<std::string, double> limits_by_key(const ProfileRequest& request) {
  std::map<std::string, double> limits;
  for (const Limit& row : kLimits) {
    if (!row.value) continue;
    const double limit = limit_of(row, request.limits, request.plant.robot.motor, Side::left);
    if (limit < kNoLimit) limits[std::string(row.key)] = limit;
  }
  return limits;
}

Json robot_json(const Robot& robot) {
  Json json{{"wheel_radius_m", robot.geometry.wheel_radius_m.left},
            {"half_track_m", robot.geometry.half_track_m},
            {"center_of_mass_offset_m", robot.geometry.center_of_mass_offset_m}};
  for (const auto& [key, field] : kInertiaKeys) json[key] = robot.inertia.*field;
  for (const auto& [key, field] : kMotorKeys)
    json["motor"][key] = {robot.motor.left.*field, robot.motor.right.*field};
  return json;
}

Json problem_json(const Problem& problem) {
  const ProfileRequest& request = problem.request;
  const PowerSupply& power = request.plant.robot.power;
  const Knots knots = knots_of(request.piece);
  Json time;
  for (const auto& [mode, name] : kModes)
    if (mode == request.time.mode) time["mode"] = name;
  if (request.time.duration_s < kNoLimit) time["duration_s"] = request.time.duration_s;
  return {{"id", problem.id},
          {"kind", problem.kind},
          {"robot", problem.robot_name},
          {"payload_kg", request.payload.from_kg},
          {"standby_W", power.standby_W},
          {"regeneration_efficiency", power.regeneration_efficiency},
          {"sharing", power.sharing == PowerSharing::bus ? "bus" : "wheel"},
          {"limits", limits_by_key(request)},
          {"path", {{"s_m", knots.s_m}, {"curvature_per_m", knots.curvature_per_m}}},
          {"end_speeds_m_s", {request.start_rate, request.end_rate}},
          {"time", time}};
}

Json solution_json(const Profile& profile) {
  const bool steps =
      std::all_of(profile.jerk.begin(), profile.jerk.end(), [](double jerk) { return jerk == 0; });
  Json json = steps ? Json{{"s_m", profile.s}, {"speed_m_s", profile.rate}}
                    : Json{{"time_s", profile.time_s}, {"jerk_m_s3", profile.jerk}};
  if (profile.wait_s > 0) json["wait_s"] = profile.wait_s;
  return json;
}

std::vector<Problem> read_problems(const std::string& file) {
  const Json json = Json::parse(std::ifstream(file));
  std::vector<Problem> problems;
  for (const Json& problem : json["problems"]) problems.push_back(problem_from(problem, json["robots"]));
  return problems;
}

}  // namespace joulepath::problems
