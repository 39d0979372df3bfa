#include "extensions/studies/commands/sweep_result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "extensions/studies/sweep/sweep_analysis.hpp"
#include "model/number_text.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLeastOfMissions = "battery_end_fraction";

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : number_text(value.get<double>());
}

bool has_plan(const Json& line) { return line.contains("energy_J"); }

/// A field of a CSV row (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// A result that the study uses and that the plan does not have; null: it has all.
const std::string* missing_result(const Study& study, const Json& line) {
  const auto is_missing = [&](const std::string& result) {
    return std::ranges::find(sweep_results(), result) != sweep_results().end() && !line.contains(result);
  };
  for (const StudyConstraint& constraint : study.constraints)
    if (is_missing(constraint.result)) return &constraint.result;
  for (const StudyObjective& objective : study.objectives)
    if (is_missing(objective.result)) return &objective.result;
  return nullptr;
}

std::string unknown(const std::string& result) {
  return result + " is unknown: the robot file lacks its source";
}

/// Relative excess over a bound; 0 within the rounding errors of a plan, which may take 8.000000000000002 s
/// of 8 s.
double excess_of(const StudyConstraint& constraint, double value) {
  const auto relative = [&](double beyond, double bound) {
    const double excess = beyond / std::max(std::abs(bound), 1e-9);
    return excess > 1e-9 ? excess : 0.0;
  };
  double excess = 0.0;
  if (constraint.max) excess = std::max(excess, relative(value - *constraint.max, *constraint.max));
  if (constraint.min) excess = std::max(excess, relative(*constraint.min - value, *constraint.min));
  return excess;
}

/// The objective of a design: a result, or a parameter of the design.
double objective_value(const Study& study, const StudyObjective& objective, const DesignTotal& total) {
  const double sign = objective.maximize ? -1.0 : 1.0;
  const auto result = total.sums.find(objective.result);
  if (result != total.sums.end()) return sign * result->second;
  const auto& parameters = study.designs.parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (parameters[p].name == objective.result)
      return sign * parse_number(total.values[p]).value_or(std::numeric_limits<double>::infinity());
  return std::numeric_limits<double>::infinity();
}

void add_line(const Study& study, const Json& line, DesignTotal& total) {
  total.planned = total.planned && has_plan(line) && missing_result(study, line) == nullptr;
  for (const std::string& result : sweep_results()) {
    if (!line.contains(result)) continue;
    const double value = line[result];
    const auto [sum, is_first] = total.sums.emplace(result, value);
    if (!is_first)
      sum->second = result == kLeastOfMissions ? std::min(sum->second, value) : sum->second + value;
  }
  for (const StudyConstraint& constraint : study.constraints)
    if (line.contains(constraint.result))
      total.excess = std::max(total.excess, excess_of(constraint, line[constraint.result]));
}

Json parameters_json(const Study& study, const std::vector<std::string>& values) {
  Json json = Json::object();
  for (std::size_t p = 0; p < values.size(); ++p) {
    const auto number = parse_number(values[p]);
    json[study.designs.parameters()[p].name] = number ? Json(*number) : Json(values[p]);
  }
  return json;
}

Json total_json(const Study& study, const DesignTotal& total) {
  Json json{{"design", total.design}, {"parameters", parameters_json(study, total.values)}};
  for (const auto& [result, value] : total.sums) json[result] = value;
  return json;
}

Json effects_json(const SweepEffects& effects) {
  Json main = Json::array(), interactions = Json::array();
  for (const MainEffect& effect : effects.main) {
    Json levels = Json::array();
    for (const LevelMean& level : effect.levels)
      levels.push_back({{"level", level.label}, {"mean", level.mean}, {"designs", level.rows}});
    main.push_back({{"parameter", effect.parameter},
                    {"share_of_variance", effect.share_of_variance},
                    {"levels", levels}});
  }
  for (const Interaction& pair : effects.interactions)
    interactions.push_back(
        {{"parameters", {pair.first, pair.second}}, {"share_of_variance", pair.share_of_variance}});
  return {{"main", main}, {"interactions", interactions}, {"unexplained", effects.unexplained}};
}

/// Over all designs with a plan: constraints select designs, but do not change the effect of a parameter.
Json all_effects(const Study& study, const std::vector<DesignTotal>& totals) {
  std::vector<const DesignTotal*> planned;
  for (const DesignTotal& total : totals)
    if (total.planned) planned.push_back(&total);
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> settings;
  for (std::size_t p = 0; p < study.designs.parameters().size(); ++p) {
    names.push_back(study.designs.parameters()[p].name);
    settings.emplace_back();
    for (const DesignTotal* total : planned) settings.back().push_back(total->values[p]);
  }
  const std::vector<LevelColumn> columns = level_columns(names, settings);
  Json json = Json::object();
  for (const char* result : {"energy_J", "motion_energy_J", "duration_s"}) {
    std::vector<double> values;
    for (const DesignTotal* total : planned) values.push_back(total->sums.at(result));
    json[result] = effects_json(sweep_effects(columns, values));
  }
  return json;
}

Json front_json(const Study& study, const std::vector<DesignTotal>& totals) {
  std::vector<const DesignTotal*> within;
  std::vector<std::vector<double>> rows;
  for (const DesignTotal& total : totals)
    if (total.is_within()) {
      within.push_back(&total);
      rows.push_back(total.objectives);
    }
  Json json = Json::array();
  for (const std::size_t k : pareto_front(rows)) json.push_back(total_json(study, *within[k]));
  return json;
}

const DesignTotal* best_of(const std::vector<DesignTotal>& totals) {
  const DesignTotal* best = nullptr;
  for (const DesignTotal& total : totals)
    if (total.is_within() && (best == nullptr || total.objectives[0] < best->objectives[0])) best = &total;
  return best;
}

/// Reasons by the number of their lines; numbers in a reason are left out, so that similar reasons are one.
Json reason_counts(const Study& study, const std::vector<std::string>& lines) {
  std::map<std::string, std::size_t> count;
  for (const std::string& text : lines) {
    const Json line = Json::parse(text);
    if (reason_of(study, line).empty()) continue;
    const std::string status = line["status"];
    if (!has_plan(line))
      ++count[status + (line.contains("constraint") ? ": " + line["constraint"].get<std::string>() : "")];
    else if (const std::string* missing = missing_result(study, line))
      ++count[unknown(*missing)];
    else
      for (const StudyConstraint& constraint : study.constraints)
        if (excess_of(constraint, line[constraint.result]) > 0)
          ++count["outside of the constraint on " + constraint.result];
  }
  return count;
}

}  // namespace

std::string reason_of(const Study& study, const Json& line) {
  if (!has_plan(line)) return line.value("message", line.value("status", "no plan"));
  if (const std::string* missing = missing_result(study, line)) return unknown(*missing);
  for (const StudyConstraint& constraint : study.constraints) {
    const double value = line[constraint.result];
    if (excess_of(constraint, value) <= 0) continue;
    const bool above = constraint.max && value > *constraint.max;
    return constraint.result + " " + number_text(value) + (above ? " > " : " < ") +
           number_text(above ? *constraint.max : *constraint.min);
  }
  return "";
}

std::vector<DesignTotal> design_totals(const Study& study, const std::vector<std::string>& lines) {
  std::vector<DesignTotal> totals;
  for (const std::string& text : lines) {
    const Json line = Json::parse(text);
    const std::size_t design = line["design"];
    if (totals.empty() || totals.back().design != design) {
      totals.push_back({.design = design, .planned = true});
      for (const auto& value : line["parameters"]) totals.back().values.push_back(text_of(value));
    }
    add_line(study, line, totals.back());
  }
  for (DesignTotal& total : totals)
    for (const StudyObjective& objective : study.objectives)
      total.objectives.push_back(objective_value(study, objective, total));
  return totals;
}

std::string sweep_csv(const Study& study, const std::vector<std::string>& lines) {
  std::vector<std::string> columns = kColumnsBefore;
  for (const SweepParameter& parameter : study.designs.parameters())
    columns.push_back(csv_field(parameter.name));
  columns.insert(columns.end(), kColumnsAfter.begin(), kColumnsAfter.end());
  std::vector<Json> rows;
  for (const std::string& text : lines) rows.push_back(Json::parse(text));
  std::vector<std::string> results = sweep_results();
  if (std::ranges::any_of(rows, [](const Json& line) {  // with --path-bound
        return line.contains("path_lower_bound_J") || line.contains("path_bound_reason");
      }))
    results.emplace_back("path_lower_bound_J");
  columns.insert(columns.end(), results.begin(), results.end());
  std::string csv;
  for (const std::string& column : columns) csv += (csv.empty() ? "" : ",") + column;
  csv += "\n";
  for (const Json& line : rows) {
    const std::string reason = reason_of(study, line);
    csv += std::to_string(line["design"].get<std::size_t>()) + "," + csv_field(line["mission"]);
    for (const auto& value : line["parameters"]) csv += "," + csv_field(text_of(value));
    csv += "," + line["status"].get<std::string>() + (reason.empty() ? ",yes," : ",no,") + csv_field(reason);
    for (const std::string& result : results)
      csv += "," + (line.contains(result) ? number_text(line[result]) : "");
    csv += "\n";
  }
  return csv;
}

std::vector<std::string> held_constant(const Study& study) {
  std::vector<std::string> held{"every key of robot and mission that is not a parameter"};
  if (!study.changes_gear()) return held;
  held.push_back(
      study.friction == FrictionHeld::wheel
          ? "friction at the wheel, while the gear ratio changes; hold_friction: motor holds the "
            "motor's instead"
          : "friction at the motor's shaft, while the gear ratio changes: torque at the wheel grows "
            "with the ratio, viscous friction with its square");
  held.push_back(
      "inertia at the wheel's axle: a rotor's share of it would grow with the square of the gear ratio");
  return held;
}

Json sweep_json(const Study& study, const std::vector<std::string>& lines,
                const std::vector<DesignTotal>& totals, const std::vector<std::string>& optimized) {
  Json json{{"schema", "joulepath/sweep/1"},
            {"study", study.name},
            {"designs", totals.size()},
            {"rows", lines.size()}};
  json["planned"] = std::ranges::count_if(totals, &DesignTotal::planned);
  json["within_constraints"] = std::ranges::count_if(totals, &DesignTotal::is_within);
  json["not_counted"] = reason_counts(study, lines);
  json["held_constant"] = held_constant(study);
  for (std::size_t p = 0; p < study.targets.size(); ++p)
    json["parameters"].push_back(
        {{"name", study.designs.parameters()[p].name},
         {"key", (study.targets[p].in_robot ? "robot." : "mission.") + study.targets[p].path}});
  for (const StudyObjective& objective : study.objectives)
    json["objectives"][objective.result] = objective.maximize ? "maximize" : "minimize";
  if (const DesignTotal* best = best_of(totals)) json["best"] = total_json(study, *best);
  json["pareto"] = front_json(study, totals);
  json["effects"] = all_effects(study, totals);
  if (!optimized.empty()) {
    const DesignTotal found = design_totals(study, optimized).front();
    json["optimized"] = total_json(study, found);
    json["optimized"].erase("design");
    json["optimized"]["within_constraints"] = found.is_within();
  }
  return json;
}

}  // namespace joulepath
