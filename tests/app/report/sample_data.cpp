#include "tests/app/report/sample_data.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace joulepath::report::sample {
namespace {

using nlohmann::json;

/// One trapezoid: rate of a path coordinate, from rest to rest.
struct Ramp {
  double length{}, rate{}, slope{};
  double ramp_s() const { return rate / slope; }
  double duration_s() const { return length / rate + ramp_s(); }
  double rate_at(double t) const {
    return std::max(0.0, std::min({rate, slope * t, slope * (duration_s() - t)}));
  }
  double slope_at(double t) const {
    return t < ramp_s() ? slope : t > duration_s() - ramp_s() ? -slope : 0.0;
  }
};

constexpr Ramp kLegs[2] = {{6.0, 0.8, 0.4}, {4.0, 0.6, 0.3}};
constexpr Ramp kTurn{std::numbers::pi / 2, 0.8, 0.8};

void push(Columns& c, double t, double v, double a, double w, double x, double y, double heading, int leg) {
  const double torque_Nm = 1.2 * a + (v > 0 ? 0.36 : 0.0), turn_Nm = w != 0 ? 0.5 : 0.0;
  const double left_W = torque_Nm * v * 10 + 0.4 * torque_Nm * torque_Nm + turn_Nm;
  const double right_W = torque_Nm * v * 10 + 0.5 * torque_Nm * torque_Nm + turn_Nm;
  const double battery_W = 10 + std::max(0.0, left_W) + std::max(0.0, right_W);
  const double before_J = c["energy_J"].empty() ? 0.0 : c["energy_J"].back();
  const double step_s = c["time_s"].empty() ? 0.0 : t - c["time_s"].back();
  const std::pair<const char*, double> row[] = {{"time_s", t},
                                                {"linear_speed_m_s", v},
                                                {"angular_speed_rad_s", w},
                                                {"linear_acceleration_m_s2", a},
                                                {"position_x_m", x},
                                                {"position_y_m", y},
                                                {"heading_rad", heading},
                                                {"leg", leg},
                                                {"wheel_torque_left_Nm", torque_Nm - turn_Nm},
                                                {"wheel_torque_right_Nm", torque_Nm + turn_Nm},
                                                {"motor_power_left_W", left_W},
                                                {"motor_power_right_W", right_W},
                                                {"battery_power_W", battery_W},
                                                {"payload_kg", leg == 0 ? 0.0 : 5.7},
                                                {"energy_J", before_J + battery_W * step_s}};
  for (const auto& [name, value] : row) c[name].push_back(value);
}

}  // namespace

Columns trajectory(double step_s) {
  Columns c;
  double t = 0, x = 1, y = 1, heading = 0;
  for (double u = 0; u < kLegs[0].duration_s(); u += step_s, t += step_s) {
    x += kLegs[0].rate_at(u) * step_s;
    push(c, t, kLegs[0].rate_at(u), kLegs[0].slope_at(u), 0, x, y, heading, 0);
  }
  for (double u = 0; u < 3; u += step_s, t += step_s) push(c, t, 0, 0, 0, x, y, heading, 0);
  for (double u = 0; u < kTurn.duration_s(); u += step_s, t += step_s) {
    heading += kTurn.rate_at(u) * step_s;
    push(c, t, 0, 0, kTurn.rate_at(u), x, y, heading, 1);
  }
  for (double u = 0; u < kLegs[1].duration_s(); u += step_s, t += step_s) {
    y += kLegs[1].rate_at(u) * step_s;
    push(c, t, kLegs[1].rate_at(u), kLegs[1].slope_at(u), 0, x, y, heading, 1);
  }
  return c;
}

json plan() {
  const json causes{{"copper", 40},          {"coulomb_friction", 72},
                    {"viscous_friction", 9}, {"kinetic", 0},
                    {"standby", 240},        {"effects", {{"rolling_resistance", 21}, {"floor_slope", 6}}},
                    {"not_recovered", 14}};
  const auto leg = [&](const char* to, double share, double payload_kg) {
    json part = causes;
    for (auto& value : part)
      if (value.is_number()) value = value.get<double>() * share;
    for (auto& value : part["effects"]) value = value.get<double>() * share;
    return json{{"to", to},
                {"status", "optimal"},
                {"energy_J", 402 * share},
                {"duration_s", 22 * share},
                {"distance_m", 10 * share},
                {"payload_kg", payload_kg},
                {"price_of_time_W", 1.9},
                {"path_gap_percent", 12},
                {"far_above_path_bound", share > 0.5},
                {"energy_by_cause_J", part}};
  };
  return {{"schema", "joulepath/plan/1"},
          {"status", "optimal"},
          {"energy_J", 402},
          {"motion_energy_J", 162},
          {"energy_Wh", 402 / 3600.0},
          {"battery_loss_J", 0.8},
          {"duration_s", 22},
          {"distance_m", 10},
          {"optimality_gap_percent", 0.02},
          {"energy_by_cause_J", causes},
          {"solver", {{"name", "ipopt"}, {"iterations", 17}}},
          {"replay", {{"energy_J", 402.01}, {"worst_violation", 0.0}, {"limit", ""}}},
          {"battery",
           {{"start_fraction", 0.9},
            {"end_fraction", 0.8995},
            {"interval_95", {0.8993, 0.8997}},
            {"required_capacity_Wh", 0.13},
            {"missions_per_charge", 1720}}},
          {"legs", {leg("shelf <3> & co", 0.6, 0.0), leg("dock", 0.4, 5.7)}},
          {"baselines",
           {{{"name", "trapezoid_max_acceleration"},
             {"energy_J", 431},
             {"motion_energy_J", 171},
             {"duration_s", 26},
             {"later_s", 4},
             {"optimum_J", 425},
             {"optimum_motion_J", 165},
             {"saving_percent", 1.39},
             {"motion_saving_percent", 3.5},
             {"parameters", {{"speed_m_s", 0.7}, {"acceleration_m_s2", 0.5}}}},
            {{"name", "trapezoid_best_tuned"},
             {"energy_J", 403},
             {"motion_energy_J", 163},
             {"duration_s", 22},
             {"optimum_J", 402},
             {"optimum_motion_J", 162},
             {"saving_percent", 0.25},
             {"motion_saving_percent", 0.6},
             {"parameters", {{"speed_m_s", 0.8}, {"acceleration_m_s2", 0.4}}}}}}};
}

PlanBands bands() {
  PlanBands bands{.battery_power_W = PlanBand{}, .energy_J = PlanBand{}, .battery_fraction = PlanBand{}};
  const Columns rows = trajectory();
  const auto add = [](PlanBand& band, double time_s, double value, double sigma) {
    band.time_s.push_back(time_s), band.value.push_back(value), band.sigma.push_back(sigma);
  };
  for (std::size_t k = 0; k < rows.at("time_s").size(); ++k) {
    const double time_s = rows.at("time_s")[k], energy_J = rows.at("energy_J")[k];
    add(*bands.battery_power_W, time_s, rows.at("battery_power_W")[k], 1.0);
    add(*bands.energy_J, time_s, energy_J, 0.1 * energy_J);
    add(*bands.battery_fraction, time_s, 0.9 - 1e-6 * energy_J, 1e-7 * energy_J);
  }
  return bands;
}

json infeasible_plan() {
  return {{"schema", "joulepath/plan/1"},
          {"status", "infeasible"},
          {"infeasibility",
           {{"constraint", "deadline"},
            {"leg", 1},
            {"to", "dock"},
            {"arc_length_m", 3.1},
            {"x_m", 4.0},
            {"y_m", 2.2},
            {"amount", 2.3},
            {"unit", "s"},
            {"relaxation", {{"deadline_s", 62.3}}}}}};
}

std::vector<MapPlace> stations() {
  return {{"start", 1.0, 1.0}, {"shelf <3> & co", 7.0, 1.0}, {"dock", 4.0, 2.2}, {"off the map", 4.0, 20.0}};
}

OccupancyGrid hall() {
  OccupancyGrid grid{180, 140, 0.05, {0, 0, 0}, {}, "hall"};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const bool wall = row < 3 || column < 3 || row >= grid.height - 3 || column >= grid.width - 3;
      const bool shelf = row > 40 && row < 110 && column > 20 && column < 100 && (row / 16) % 2 == 1;
      grid.occupancy_percent.push_back(wall || shelf ? 100 : (column > 165 ? kUnknownCell : 0));
    }
  return grid;
}

json diagnosis() {
  const auto entry = [](const char* axis, const json& value, double share) {
    return json{{"axis", axis},
                {"value", value},
                {"share_of_gap", share},
                {"energy_J", 210 * share},
                {"interval_95", {0.9 * share, 1.1 * share}}};
  };
  return {
      {"schema", "joulepath/diagnosis/1"},
      {"verdict", "explained"},
      {"next_step", "Plan with the corrected files."},
      {"gap",
       {{"energy",
         {{"before_percent", 14.2},
          {"after_percent", 0.6},
          {"bias_before_percent", -14.1},
          {"noise_floor_percent", 0.5},
          {"before_J", 210.3},
          {"after_J", 9.1},
          {"shrink_fraction", 0.96},
          {"shrink_interval_95", {0.94, 0.97}}}},
        {"current", {{"before_rms_A", 0.13}, {"after_rms_A", 0.021}, {"noise_floor_rms_A", 0.02}}},
        {"voltage", json::object()},
        {"motion",
         {{"before_rms_m", 0.08},
          {"after_rms_m", 0.02},
          {"noise_floor_rms_m", 0.015},
          {"heading_before_rms_rad", 0.02},
          {"heading_after_rms_rad", 0.02}}},
        {"energy_by_phase",
         {{"cruise", {{"before_J", 120.5}, {"after_J", 4.1}}},
          {"turn", {{"before_J", 80.2}, {"after_J", 5.0}}}}}}},
      {"where",
       {entry("phase", "turn", 0.62), entry("phase", "cruise", 0.3), entry("phase", "accelerate", 0.08),
        entry("wheel", "left", 0.55), entry("wheel", "right", 0.45), entry("floor", "1..3, 1..2", 0.1),
        entry("floor", "3..5, 1..2", 0.75), entry("floor", "5..7, 1..2", 0.15)}},
      {"causes",
       {{{"effect", "rolling_resistance"},
         {"probability", 0.8},
         {"indistinguishable_from", {"gear_efficiency"}},
         {"parameters", {{"coefficient", {{"value", 0.0159}, {"interval_95", {0.0152, 0.0166}}}}}},
         {"energy_share", 0.93},
         {"shrink_fraction_alone", 0.93}}}},
      {"ranking",
       {{{"effect", "rolling_resistance"}, {"probability", 0.8}},
        {{"effect", "gear_efficiency"}, {"probability", 0.19}},
        {{"effect", "turning_scrub"}, {"probability", 0.01}}}},
      {"leftover", {{"significant", true}, {"description", "depends on speed"}}},
      {"next_experiment",
       {{"separates", json::array({json::array({"rolling_resistance", "gear_efficiency"})})},
        {"motion", {{"profile", "constant_ramp"}, {"acceleration_m_s2", 0.2}, {"distance_m", 10}}},
        {"expected_evidence", 8.2}}},
      {"isolability",
       {{"effects",
         {{{"effect", "rolling_resistance"}, {"probability_seen", 1.0}},
          {{"effect", "gear_efficiency"}, {"probability_seen", 1.0}},
          {{"effect", "dragging_wheel (left)"}, {"probability_seen", 1.0}},
          {{"effect", "turning_scrub"}, {"probability_seen", 0.01}}}},
        {"not_seen", {"turning_scrub"}},
        {"not_told_apart",
         {{{"effect", "rolling_resistance"},
           {"other", "gear_efficiency"},
           {"two_ln_likelihood_ratio", 4.2},
           {"probability_told_apart", 0.33}}}},
        {"groups", json::array({json::array({"rolling_resistance", "gear_efficiency"})})}}},
      {"ceiling", {{"shrink_fraction", 0.97}}},
      {"control", {{"effect", "floor_slope"}, {"shrink_fraction", 0.1}}},
      {"missing_channels", {"battery_voltage_V"}},
      {"artifacts", json::array()},
      {"decisions", {{"missions", 3}, {"joules_lost_with_nominal_percent", 0.4}}},
      {"validation", {{"runs", {"run_07.csv"}}, {"method", "held-out runs, never used to choose or fit"}}}};
}

std::vector<RunComparison> runs() {
  std::vector<RunComparison> list;
  for (int k = 0; k < 2; ++k) {
    RunComparison run{"run_0" + std::to_string(k + 1) + ".csv", k == 0 ? "diagnosis" : "validation", {}};
    for (int row = 0; row < 1200; ++row) {
      const double t = 0.02 * row, power = 20 + 8 * std::sin(0.7 * t + k);
      run.columns["time_s"].push_back(t);
      run.columns["measured_motor_power_W"].push_back(power + std::sin(97.0 * t));
      run.columns["predicted_motor_power_W"].push_back(0.86 * power);
      run.columns["corrected_motor_power_W"].push_back(power);
      run.columns["measured_yaw_rate_rad_s"].push_back(std::cos(0.3 * t));
      run.columns["predicted_yaw_rate_rad_s"].push_back(1.02 * std::cos(0.3 * t));
      run.columns["motion_speed_m_s"].push_back(0.4 + 0.3 * std::sin(0.7 * t + k));
      run.columns["motion_payload_kg"].push_back(3.0 * k);
    }
    list.push_back(run);
  }
  return list;
}

json compare() {
  return {{"profiles",
           {{{"name", "plan"},
             {"energy_J", 402},
             {"motion_energy_J", 162},
             {"optimum_J", 402},
             {"optimum_motion_J", 162},
             {"duration_s", 22}},
            {{"name", "trapezoid_max_acceleration"},
             {"energy_J", 431},
             {"motion_energy_J", 171},
             {"optimum_J", 425},
             {"optimum_motion_J", 165},
             {"duration_s", 26},
             {"later_s", 4},
             {"parameters", json::array({{{"speed_m_s", 0.7}}, {{"yaw_rate_rad_s", 1.2}}})}},
            {{"name", "s_curve"}, {"feasible", false}, {"reason", "cannot make the time"}}}}};
}

json loss() {
  return {{"of", "nav2_params.yaml"},
          {"plan", {{"duration_s", 22}, {"energy_J", 402}}},
          {"parameters", {"controller_server.FollowPath.desired_linear_vel: 0.5"}},
          {"unused", json::array()},
          {"not_modelled", json::array()},
          {"own_time", {{"duration_s", 26}, {"energy_J", 525}, {"optimum_J", 420}, {"lost_percent", 20}}},
          {"plan_time", nullptr},
          {"broken_limit", ""}};
}

std::vector<NamedColumns> profiles() {
  Columns slower = trajectory();
  for (auto& t : slower["time_s"]) t *= 1.1;
  for (auto& v : slower["linear_speed_m_s"]) v /= 1.1;
  return {{"plan", trajectory()}, {"trapezoid_max_acceleration", slower}};
}

std::vector<NamedColumns> loss_motions() {
  std::vector<NamedColumns> motions = profiles();
  motions.back().name = "settings";
  return motions;
}

json front() {
  json points = json::array(), baselines = json::array();
  for (int k = 0; k < 15; ++k) {
    const double t = 12 + 2.0 * k, motion = 90 + 9000 / (t * t), price = 18000 / (t * t * t) - 10;
    points.push_back({{"duration_s", t},
                      {"energy_J", motion + 10 * t},
                      {"motion_energy_J", motion},
                      {"price_of_time_W", price},
                      {"status", "optimal"}});
    baselines.push_back({{"name", "trapezoid_best_tuned"},
                         {"duration_s", t},
                         {"energy_J", 1.02 * motion + 10 * t},
                         {"optimum_J", motion + 10 * t},
                         {"motion_energy_J", 1.02 * motion}});
  }
  return {{"points", points}, {"baselines", baselines}};
}

json batch() {
  json missions = json::array();
  for (int k = 0; k < 40; ++k) {
    const double d = 20 + (k * 37) % 60;
    missions.push_back({{"name", "mission_" + std::to_string(k) + ".yaml"},
                        {"status", "optimal"},
                        {"energy_J", d * (25 + (k * 13) % 9)},
                        {"duration_s", 1.7 * d},
                        {"distance_m", d},
                        {"saving_percent", 0.1 * ((k * 7) % 11)},
                        {"optimality_gap_percent", 0.02}});
  }
  missions.push_back(
      {{"name", "mission_40.yaml"}, {"status", "infeasible"}, {"message", "the deadline cannot be met"}});
  return {{"missions", missions}};
}

}  // namespace joulepath::report::sample
