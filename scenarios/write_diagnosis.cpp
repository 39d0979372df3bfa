#include "scenarios/write_diagnosis.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// Six significant digits: what was measured, not what the arithmetic left.
double rounded(double value) {
  if (!std::isfinite(value) || value == 0) return std::isfinite(value) ? 0.0 : 0.0;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

Json interval(const Range95& range) { return Json::array({rounded(range.first), rounded(range.second)}); }

std::string number(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, rounded(value)).ptr;
  return {buffer, end};
}

Json energy_json(const EnergyGap& e) {
  return {{"before_percent", rounded(e.before_percent)},
          {"after_percent", rounded(e.after_percent)},
          {"bias_before_percent", rounded(e.bias_before_percent)},
          {"bias_after_percent", rounded(e.bias_after_percent)},
          {"noise_floor_percent", rounded(e.noise_floor_percent)},
          {"before_J", rounded(e.before_J)},
          {"after_J", rounded(e.after_J)},
          {"shrink_fraction", rounded(e.shrink_fraction)},
          {"shrink_interval_95", interval(e.shrink_interval_95)}};
}

void add_signal(Json& json, const SignalGap& gap, const std::string& prefix, const std::string& unit) {
  if (!gap.present) return;
  json[prefix + "before_rms_" + unit] = rounded(gap.before_rms);
  json[prefix + "after_rms_" + unit] = rounded(gap.after_rms);
  json[prefix + "noise_floor_rms_" + unit] = rounded(gap.noise_floor_rms);
}

Json gap_json(const GapReport& gap) {
  Json current = Json::object(), voltage = Json::object(), motion = Json::object(), battery = Json::object();
  add_signal(current, gap.current_A, "", "A");
  add_signal(voltage, gap.voltage_V, "", "V");
  add_signal(motion, gap.position_m, "", "m");
  add_signal(motion, gap.heading_rad, "heading_", "rad");
  add_signal(battery, gap.battery_W, "", "W");
  Json phases = Json::object();
  for (const auto& [phase, energy] : gap.energy_by_phase_J)
    phases[phase] = {{"before_J", rounded(energy.first)}, {"after_J", rounded(energy.second)}};
  return {{"energy", energy_json(gap.energy)},
          {"current", current},
          {"voltage", voltage},
          {"motion", motion},
          {"battery", battery},
          {"energy_by_phase", phases}};
}

Json where_json(const WhereCell& cell) {
  Json json{{"axis", cell.axis},
            {"value", cell.value},
            {"share_of_gap", rounded(cell.share_of_gap)},
            {"energy_J", rounded(cell.energy_J)},
            {"interval_95", interval(cell.interval_95)}};
  if (cell.bias_percent) json["bias_percent"] = rounded(*cell.bias_percent);
  return json;
}

Json cause_json(const Cause& cause) {
  Json parameters = Json::object();
  if (cause.effect.side) parameters["side"] = {{"value", side_name(*cause.effect.side)}};
  for (const FoundParameter& p : cause.parameters)
    parameters[p.name] = {{"value", rounded(p.value)}, {"interval_95", interval(p.interval_95)}};
  return {{"effect", cause.effect.name},
          {"probability", rounded(cause.probability)},
          {"indistinguishable_from", cause.indistinguishable_from},
          {"parameters", parameters},
          {"energy_share", rounded(cause.energy_share)},
          {"shrink_fraction_alone", rounded(cause.shrink_fraction_alone)}};
}

Json motion_json(const PrescribedMotion& m) {
  Json json{{"profile", std::string(kMotionProfileNames[static_cast<std::size_t>(m.profile)])}};
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) json[key] = rounded(*value);
  };
  add("acceleration_m_s2", m.acceleration_m_s2), add("deceleration_m_s2", m.deceleration_m_s2);
  add("speed_m_s", m.speed_m_s), add("start_speed_m_s", m.start_speed_m_s), add("ramp_s", m.ramp_s);
  add("distance_m", m.distance_m), add("duration_s", m.duration_s), add("radius_m", m.radius_m);
  add("angle_rad", m.angle_rad), add("yaw_rate_rad_s", m.yaw_rate_rad_s);
  add("yaw_acceleration_rad_s2", m.yaw_acceleration_rad_s2);
  if (m.repeat != 1) json["repeat"] = m.repeat;
  if (m.reverse) json["direction"] = "reverse";
  return json;
}

Json next_json(const NextExperiment& next) {
  Json motion = Json::object();
  if (next.motions.size() == 1) motion = motion_json(next.motions.front());
  if (!next.motions.empty()) {
    Json legs = Json::array();
    for (const PrescribedMotion& m : next.motions) legs.push_back(motion_json(m));
    motion["legs"] = legs;
    motion["payload_kg"] = rounded(next.payload_kg);
    motion["why"] = next.why;
  }
  return {{"separates", next.separates},
          {"motion", motion},
          {"expected_evidence", rounded(next.expected_evidence)}};
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d) {
  Json where = Json::array(), causes = Json::array(), ranking = Json::array();
  for (const WhereCell& cell : d.where) where.push_back(where_json(cell));
  for (const Cause& cause : d.causes) causes.push_back(cause_json(cause));
  for (const RankedEffect& r : d.ranking)
    ranking.push_back({{"effect", r.effect}, {"probability", rounded(r.probability)}});
  const Json json{
      {"schema", "joulepath/diagnosis/1"},
      {"gap", gap_json(d.gap)},
      {"where", where},
      {"verdict", verdict_name(d.verdict)},
      {"causes", causes},
      {"ranking", ranking},
      {"leftover",
       {{"significant", d.leftover_significant},
        {"description", d.leftover_description},
        {"share", rounded(d.leftover_share)}}},
      {"next_experiment", next_json(d.next)},
      {"ceiling", {{"shrink_fraction", rounded(d.ceiling_shrink_fraction)}}},
      {"control", {{"effect", d.control_effect}, {"shrink_fraction", rounded(d.control_shrink_fraction)}}},
      {"pinned_combination", d.pinned_combination},
      {"artifacts", d.artifacts},
      {"missing_channels", d.missing_channels},
      {"notes", d.notes},
      {"decisions",
       {{"missions", d.decision_missions},
        {"joules_lost_with_nominal_percent", rounded(d.joules_lost_percent)}}},
      {"validation", {{"runs", d.validation_runs}, {"method", d.validation_method}}}};
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string corrected_dataset_text(const Dataset& dataset, const Diagnosis& diagnosis) {
  std::string text =
      "schema: joulepath/dataset/1\n# Readings as they would be without the instruments' errors:\n";
  for (const EffectSetting& effect : diagnosis.corrected_instruments) {
    text += "#   " + effect.name;
    if (effect.side) text += std::string(" ") + side_name(*effect.side);
    for (const auto& [key, value] : effect.parameters) text += " " + key + " = " + number(value);
    text += "\n";
  }
  text += "robot: " + std::filesystem::path(dataset.robot_file).filename().string() + "\ncolumns:\n";
  for (Side side : kSides) {
    double offset_A = 0, gain = 1, delay_s = 0;
    for (const EffectSetting& effect : diagnosis.corrected_instruments) {
      if (effect.name == "current_sensor_offset" && effect.side == side)
        offset_A += effect.parameters.at("offset_A");
      if (effect.name == "current_sensor_gain") gain *= 1 + effect.parameters.at("fraction");
      if (effect.name == "time_misalignment") delay_s += effect.parameters.at("delay_s");
    }
    const std::string name = std::string("motor_current_") + side_name(side) + "_A";
    text += "  " + name + ": {from: " + name + ", scale: " + number(1 / gain) +
            ", offset: " + number(-offset_A / gain) + "}\n";
    if (delay_s != 0 && side == Side::right)
      text += "# The motor channels come " + number(delay_s) +
              " s late: shift them against the others before use.\n";
  }
  text += "runs:\n";
  for (const Run& run : dataset.runs) {
    if (run.log.time_s.empty()) continue;
    text += "  - {file: " + run.name;
    if (run.payload.size() == 1) text += ", payload_kg: " + number(run.payload.front().payload_kg);
    if (run.start_time_s) text += ", start_time_s: " + number(*run.start_time_s);
    text += "}\n";
  }
  return text;
}

std::string motion_text(const PrescribedMotion& motion) {
  std::string text = "{";
  const auto json = motion_json(motion);  // items() of a temporary would dangle
  for (const auto& [key, value] : json.items())
    text += (text.size() > 1 ? ", " : "") + key + ": " +
            (value.is_string() ? value.get<std::string>() : value.dump());
  return text + "}";
}

std::string experiment_mission_text(const NextExperiment& next, const std::string& robot_file) {
  std::string text = "schema: joulepath/mission/1\n";
  text += "# Separates: ";
  for (std::size_t k = 0; k < next.separates.size(); ++k) text += (k ? ", " : "") + next.separates[k];
  text += "\n# " + next.why + "\nrobot: " + robot_file + "\nstart: {x_m: 0, y_m: 0, heading_rad: 0}\nlegs:\n";
  for (const PrescribedMotion& motion : next.motions)
    text += "  - {motion: " + motion_text(motion) + ", payload_kg: " + number(next.payload_kg) + "}\n";
  return text;
}

}  // namespace joulepath
