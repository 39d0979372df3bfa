#include "logs.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace control {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The first number that follows `key:` at or after `from`.
double number(const std::string& text, const std::string& key, std::size_t from = 0) {
  const std::size_t at = text.find(key + ": ", from);
  if (at == std::string::npos) throw std::runtime_error("no " + key);
  return std::stod(text.substr(at + key.size() + 2));
}

Robot read_robot(const std::string& path) {
  const std::string t = text_of(path);
  Robot r;
  r.radius_m = number(t, "wheel_radius_m");
  r.half_track_m = number(t, "half_track_m");
  r.center_offset_m = number(t, "center_of_mass_offset_m");
  r.chassis_kg = number(t, "chassis_mass_kg");
  r.wheel_kg = number(t, "wheel_mass_kg");
  r.yaw_inertia = number(t, "chassis_yaw_inertia_kg_m2");
  r.payload_yaw_inertia_m2 = number(t, "payload_yaw_inertia_m2");
  r.axle_inertia = number(t, "wheel_axle_inertia_kg_m2");
  r.diameter_inertia = number(t, "wheel_diameter_inertia_kg_m2");
  r.gear = number(t, "gear_ratio");
  r.ohm = number(t, "resistance_ohm");
  r.torque_constant = number(t, "torque_constant_Nm_A");
  r.viscous = number(t, "viscous_friction_Nm_s_rad");
  const std::size_t friction = t.find("friction_torque_Nm: {");
  r.friction_Nm = {number(t, "left", friction), number(t, "right", friction)};
  r.standby_W = number(t, "standby_W");
  r.regeneration = number(t, "regeneration_efficiency");
  r.open_circuit_V = number(t, "open_circuit_voltage_V");
  r.internal_ohm = number(t, "internal_resistance_ohm");
  return r;
}

Column smoothed(const Column& x, int half) {
  const int n = static_cast<int>(x.size());
  Column out(x.size());
  for (int k = 0; k < n; ++k) {
    double sum = 0;
    const int low = std::max(0, k - half), high = std::min(n - 1, k + half);
    for (int j = low; j <= high; ++j) sum += x[static_cast<std::size_t>(j)];
    out[static_cast<std::size_t>(k)] = sum / (high - low + 1);
  }
  return out;
}

Column slope(const Column& x, int half, double period_s) {
  const int n = static_cast<int>(x.size());
  Column out(x.size());
  for (int k = 0; k < n; ++k) {
    const int low = std::max(0, k - half), high = std::min(n - 1, k + half);
    out[static_cast<std::size_t>(k)] =
        (x[static_cast<std::size_t>(high)] - x[static_cast<std::size_t>(low)]) / ((high - low) * period_s);
  }
  return out;
}

Run read_run(const std::string& path) {
  std::istringstream in(text_of(path));
  std::string line, field;
  std::getline(in, line);
  std::vector<std::string> names;
  for (std::istringstream head(line); std::getline(head, field, ',');) names.push_back(field);
  std::map<std::string, Column> table;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    for (const std::string& name : names) {
      std::getline(row, field, ',');
      table[name].push_back(std::stod(field));
    }
  }
  Run run;
  run.time_s = table.at("time_s");
  run.speed = {table.at("wheel_speed_left_rad_s"), table.at("wheel_speed_right_rad_s")};
  run.volts = {table.at("motor_voltage_left_V"), table.at("motor_voltage_right_V")};
  run.amps = {table.at("motor_current_left_A"), table.at("motor_current_right_A")};
  run.battery_V = table.at("battery_voltage_V");
  run.battery_A = table.at("battery_current_A");
  run.gyro = table.at("gyro_yaw_rate_rad_s");
  run.x_m = table.at("position_x_m");
  run.y_m = table.at("position_y_m");
  run.heading = smoothed(table.at("heading_rad"), 4);
  const double period_s = run.time_s[1] - run.time_s[0];
  for (std::size_t side = 0; side < 2; ++side) {
    run.smooth_speed[side] = smoothed(run.speed[side], 4);
    run.acceleration[side] = slope(run.smooth_speed[side], 5, period_s);
    run.smooth_amps[side] = smoothed(run.amps[side], 4);
  }
  return run;
}

}  // namespace

DataSet read_data_set(const std::string& folder) {
  DataSet data;
  data.robot = read_robot(folder + "/robot.yaml");
  const std::string list = text_of(folder + "/dataset.yaml");
  const std::regex entry(R"(file: ([^,]+), payload_kg: ([^,]+), start_time_s: ([^}]+)\})");
  for (std::sregex_iterator at(list.begin(), list.end(), entry), end; at != end; ++at) {
    Run run = read_run(folder + "/" + (*at)[1].str());
    run.payload_kg = std::stod((*at)[2]);
    run.start_s = std::stod((*at)[3]);
    data.runs.push_back(std::move(run));
  }
  if (data.runs.size() < 2) throw std::runtime_error("fewer than two runs in " + folder);
  return data;
}

}  // namespace control
