#include "scenarios/result_files/write_diagnosis.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "model/text_of_list.hpp"
#include "scenarios/result_files/diagnosis_sentence.hpp"
#include "scenarios/result_files/gap_after.hpp"
#include "scenarios/result_files/next_step.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

Json interval(const Range95& range) {
  return Json::array({six_digits(range.first), six_digits(range.second)});
}

Json energy_json(const EnergyGap& e) {
  return {{"before_percent", six_digits(e.before_percent)},
          {"after_percent", six_digits(e.after_percent)},
          {"bias_before_percent", six_digits(e.bias_before_percent)},
          {"bias_after_percent", six_digits(e.bias_after_percent)},
          {"noise_floor_percent", six_digits(e.noise_floor_percent)},
          {"before_J", six_digits(e.before_J)},
          {"after_J", six_digits(e.after_J)},
          {"shrink_fraction", six_digits(e.shrink_fraction)},
          {"shrink_interval_95", interval(e.shrink_interval_95)}};
}

/// A list with one entry for each value, as `entry` writes it.
template <class Value, class Entry>
Json each_json(const std::vector<Value>& values, const Entry& entry) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(entry(value));
  return list;
}

Json hard_json(const HardToSee& one) {
  const bool shows = std::isfinite(one.detectable_percent);
  return {{"effect", one.effect},
          {"detectable_percent", shows ? Json(six_digits(one.detectable_percent)) : Json(nullptr)}};
}

void add_signal(Json& json, const SignalGap& gap, const std::string& prefix, const std::string& unit) {
  if (!gap.present) return;
  json[prefix + "before_rms_" + unit] = six_digits(gap.before_rms);
  json[prefix + "after_rms_" + unit] = six_digits(gap.after_rms);
  json[prefix + "noise_floor_rms_" + unit] = six_digits(gap.noise_floor_rms);
}

}  // namespace

Json gap_json(const GapReport& gap) {
  Json current = Json::object(), voltage = Json::object(), motion = Json::object(), battery = Json::object();
  add_signal(current, gap.current_A, "", "A");
  add_signal(voltage, gap.voltage_V, "", "V");
  add_signal(motion, gap.position_m, "", "m");
  add_signal(motion, gap.heading_rad, "heading_", "rad");
  add_signal(battery, gap.battery_W, "", "W");
  Json phases = Json::object();
  for (const auto& [phase, energy] : gap.energy_by_phase_J)
    phases[phase] = {{"before_J", six_digits(energy.first)}, {"after_J", six_digits(energy.second)}};
  Json json{{"energy", energy_json(gap.energy)},
            {"current", current},
            {"voltage", voltage},
            {"motion", motion},
            {"battery", battery},
            {"energy_by_phase", phases}};
  json["energy"]["detectable_percent"] = six_digits(gap.energy.detectable_percent);
  json["energy"]["hard_to_see"] = each_json(gap.energy.hard_to_see, hard_json);
  if (gap.battery_energy) json["battery_energy"] = energy_json(*gap.battery_energy);
  return json;
}

namespace {

Json run_apart_json(const RunApart& apart) {
  return {{"run", apart.run},
          {"over_model_percent", six_digits(apart.over_model_percent)},
          {"share_of_gap", six_digits(apart.share_of_gap)}};
}

Json foreign_json(const ForeignConstant& one) {
  return {{"constant", one.name},
          {"unit", one.unit},
          {"in_file", six_digits(one.in_file)},
          {"in_runs", six_digits(one.in_runs)}};
}

Json where_json(const WhereCell& cell) {
  Json json{{"axis", cell.axis},
            {"value", cell.value},
            {"share_of_gap", six_digits(cell.share_of_gap)},
            {"energy_J", six_digits(cell.energy_J)},
            {"interval_95", interval(cell.interval_95)}};
  if (cell.bias_percent) json["bias_percent"] = six_digits(*cell.bias_percent);
  return json;
}

Json named_cause_json(const Cause& cause) {
  Json parameters = Json::object();
  if (cause.effect.side) parameters["side"] = {{"value", side_name(*cause.effect.side)}};
  for (const FoundParameter& p : cause.parameters)
    parameters[p.name] = {{"value", six_digits(p.value)}, {"interval_95", interval(p.interval_95)}};
  return {{"effect", cause.effect.name},
          {"probability", six_digits(cause.probability)},
          {"indistinguishable_from", cause.indistinguishable_from},
          {"parameters", parameters},
          {"energy_share", six_digits(cause.energy_share)},
          {"shrink_fraction_alone", six_digits(cause.shrink_fraction_alone)}};
}

Json simulator_json(const Diagnosis& d) {
  const SimulatorGap& simulator = d.simulator;
  Json json{{"runs", simulator.runs},
            {"of_runs", simulator.of_runs},
            {"gap_percent", six_digits(simulator.gap_percent)},
            {"bias_percent", six_digits(simulator.bias_percent)},
            {"noise_floor_percent", six_digits(simulator.noise_floor_percent)},
            {"contents_verdict", verdict_name(simulator.contents)},
            {"contains", each_json(simulator.contains, named_cause_json)},
            {"another_robots_file", simulator.is_another_robots},
            {"aligned_by",
             {{"time", simulator.by_time}, {"command", simulator.by_command}, {"path", simulator.by_path}}},
            {"clock_offset_s", six_digits(simulator.clock_offset_s)},
            {"motion_difference_percent", six_digits(simulator.motion_difference_percent)},
            {"lacking_channels", simulator.lacking_channels},
            {"sentence", simulator_words(d)}};
  if (simulator.velocity_filter_s > 0) json["velocity_filter_s"] = six_digits(simulator.velocity_filter_s);
  return json;
}

Json ranked_json(const RankedEffect& ranked) {
  return {{"effect", ranked.effect}, {"probability", six_digits(ranked.probability)}};
}

Json unknown_json(const UnknownCause& unknown) {
  return {{"depends_on", unknown.depends_on},
          {"probability", six_digits(unknown.probability)},
          {"share", six_digits(unknown.share)}};
}

Json small_json(const SmallEffect& small) {
  return {{"effect", small.effect},
          {"probability", six_digits(small.probability)},
          {"evidence", six_digits(small.evidence)},
          {"size", six_digits(small.size)}};
}

Json correlation_json(const ParameterCorrelation& pair) {
  return {
      {"parameter", pair.parameter}, {"other", pair.other}, {"correlation", six_digits(pair.correlation)}};
}

Json data_check_json(const DataCheck& check) {
  return {{"run", check.run.empty() ? "all" : check.run},
          {"channel", check.channel},
          {"kind", check.kind},
          {"evidence", check.evidence},
          {"repair", check.repair}};
}

Json motion_json(const PrescribedMotion& m) {
  Json json{{"profile", std::string(kMotionProfileNames[static_cast<std::size_t>(m.profile)])}};
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) json[key] = six_digits(*value);
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
    motion["legs"] = each_json(next.motions, motion_json);
    for (std::size_t k = 0; k < next.motions.size(); ++k)
      motion["legs"][k]["payload_kg"] = six_digits(next.payload_kg[k]);
    motion["payload_kg"] = six_digits(next.payload_kg.front());
    motion["why"] = next.why;
  }
  return {{"separates", next.separates},
          {"motion", motion},
          {"expected_evidence", six_digits(next.expected_evidence)},
          {"probability_settled", six_digits(next.probability_settled)}};
}

/// One prescribed motion as a YAML flow map.
std::string motion_text(const PrescribedMotion& motion) {
  std::string text = "{";
  const auto json = motion_json(motion);  // items() of a temporary would dangle
  for (const auto& [key, value] : json.items())
    text += (text.size() > 1 ? ", " : "") + key + ": " +
            (value.is_string() ? value.get<std::string>() : value.dump());
  return text + "}";
}

}  // namespace

Json data_checks_json(const std::vector<DataCheck>& checks) { return each_json(checks, data_check_json); }

Json isolability_json(const Isolability& isolability) {
  const auto effect_json = [](const Isolability::Effect& effect) {
    Json seen_from = Json::object();
    if (effect.seen_from) seen_from[effect.seen_from->parameter] = six_digits(effect.seen_from->value);
    Json json{{"effect", effect.effect},
              {"probability_seen", six_digits(effect.probability_seen)},
              {"seen_from", seen_from}};
    if (effect.is_found) json["found"] = true;
    return json;
  };
  Json pairs = Json::array();
  for (const Isolability::Pair& pair : inseparable_pairs(isolability))
    pairs.push_back({{"effect", pair.effect},
                     {"other", pair.other},
                     {"two_ln_likelihood_ratio", six_digits(pair.likelihood_ratio)},
                     {"probability_told_apart", six_digits(pair.probability_told_apart)}});
  return {{"effects", each_json(isolability.effects, effect_json)},
          {"not_seen", unseen_effects(isolability)},
          {"not_told_apart", pairs},
          {"groups", inseparable_groups(isolability)}};
}

std::string diagnosis_json(const Diagnosis& d) {
  Json json{
      {"schema", "joulepath/diagnosis/1"},
      {"gap", gap_json(d.gap)},
      {"runs_apart", each_json(d.runs_apart, run_apart_json)},
      {"where", each_json(d.where, where_json)},
      {"verdict", verdict_name(d.verdict)},
      {"sentence", diagnosis_sentence(d)},
      {"next_step", next_step(d)},
      {"causes", each_json(d.causes, named_cause_json)},
      {"ranking", each_json(d.ranking, ranked_json)},
      {"unknowns", each_json(d.unknowns, unknown_json)},
      {"below_materiality", each_json(d.below_materiality, small_json)},
      {"leftover",
       {{"significant", d.leftover_significant},
        {"description", d.leftover_description},
        {"share", six_digits(d.leftover_share)}}},
      {"next_experiment", next_json(d.next)},
      {"ceiling", {{"shrink_fraction", six_digits(d.ceiling_shrink_fraction)}}},
      {"control", {{"effect", d.control_effect}, {"shrink_fraction", six_digits(d.control_shrink_fraction)}}},
      {"pinned_combination", d.pinned_combination},
      {"correlations", each_json(d.correlations, correlation_json)},
      {"isolability", isolability_json(d.isolability)},
      {"foreign_constants", each_json(d.foreign_constants, foreign_json)},
      {"data_checks", data_checks_json(d.data_checks)},
      {"artifacts", d.artifacts},
      {"missing_channels", d.missing_channels},
      {"notes", d.notes},
      {"decisions",
       {{"missions", d.decision_missions},
        {"joules_lost_with_nominal_percent", six_digits(d.joules_lost_percent)}}},
      {"validation", {{"runs", d.validation_runs}, {"method", d.validation_method}}}};
  if (d.velocity_filter_s > 0) json["velocity_filter_s"] = six_digits(d.velocity_filter_s);
  if (d.simulator.runs > 0) json["simulator"] = simulator_json(d);
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string experiment_mission_text(const NextExperiment& next, const std::string& robot_file) {
  std::string text = "schema: joulepath/mission/1\n";
  text += "# Separates: " + text_of_list(next.separates) + "\n# " + next.why + "\nrobot: " + robot_file +
          "\nstart: {x_m: 0, y_m: 0, heading_rad: 0}\nlegs:\n";
  for (std::size_t k = 0; k < next.motions.size(); ++k)
    text += "  - {motion: " + motion_text(next.motions[k]) +
            ", payload_kg: " + significant_text(next.payload_kg[k]) + "}\n";
  return text;
}

}  // namespace joulepath
