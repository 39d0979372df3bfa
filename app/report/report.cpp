#include "app/report/report.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "app/report/page_text.hpp"
#include "app/report/plain_tables.hpp"
#include "diagnosis/values/verdict.hpp"
#include "model/limit_table.hpp"
#include "model/watt_hours.hpp"
#include "report/report_modules.hpp"
#include "scenarios/text/filled.hpp"

namespace joulepath::embedded {
extern const std::string_view page, style;
}  // namespace joulepath::embedded

namespace joulepath::report {
namespace {

using nlohmann::json;
constexpr std::size_t kMostRows = 4000;
constexpr std::size_t kMostOverlayRows = 1500;

/// Seven significant digits: more than a plot shows, and half the bytes.
double rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double unit = std::pow(10.0, 6.0 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(unit) ? std::round(value * unit) / unit : value;
}

json json_of(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values)
    list.push_back(std::isfinite(value) ? json(rounded(value)) : json(nullptr));
  return list;
}

json json_of(const Columns& columns, std::size_t most_rows) {
  json object = json::object();
  for (const auto& [name, values] : thinned(columns, most_rows)) object[name] = json_of(values);
  return object;
}

json json_of(const std::vector<NamedColumns>& profiles) {
  json list = json::array();
  for (const auto& profile : profiles)
    list.push_back({{"name", profile.name}, {"columns", json_of(profile.columns, kMostOverlayRows)}});
  return list;
}

json json_of(const MapPicture& map) {
  json runs = json::array();
  for (const auto& [cell, count] : map.runs) {
    runs.push_back(static_cast<int>(cell));
    runs.push_back(count);
  }
  return {{"width", map.width},
          {"height", map.height},
          {"resolution_m", map.resolution_m},
          {"origin", {map.origin.x_m, map.origin.y_m, map.origin.heading_rad}},
          {"runs", runs}};
}

json json_of(const Limits& limits) {
  json object = json::object();
  for (const Limit& row : kLimits)
    if (row.field != nullptr && std::isfinite(limits.*row.field))
      object[std::string(row.key)] = limits.*row.field;
  return object;
}

/// The ends of the 95 % interval along the plan.
void add_band(const char* name, const std::optional<PlanBand>& band, json& data) {
  if (!band) return;
  const auto [low, high] = ends_95(*band);
  data["bands"][name] = {{"time_s", json_of(band->time_s)},
                         {"value", json_of(band->value)},
                         {"low", json_of(low)},
                         {"high", json_of(high)}};
}

double number_at(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : 0.0;
}

/// Content of a report of thousands of missions: counts, the distributions of their numbers, and the missions
/// only where a table names them (no plan, or the most joules per meter).
json compact_batch(const json& batch) {
  constexpr std::size_t kMostNamed = 200, kMostNumbers = 20'000;
  json status = json::object(), columns = json::object(), unsolved = json::array();
  std::vector<std::pair<double, std::size_t>> by_cost;
  const json& missions = batch.at("missions");
  for (std::size_t k = 0; k < missions.size(); ++k) {
    const json& mission = missions[k];
    const std::string name = mission.value("status", "failed");
    status[name] = status.value(name, 0) + 1;
    if (name != "optimal" && name != "feasible") {
      if (unsolved.size() < kMostNamed) unsolved.push_back(mission);
      continue;
    }
    for (const char* key :
         {"energy_J", "duration_s", "distance_m", "saving_percent", "optimality_gap_percent"})
      if (mission.contains(key) && mission[key].is_number()) columns[key].push_back(rounded(mission[key]));
    const double distance_m = number_at(mission, "distance_m");
    if (distance_m > 0) by_cost.emplace_back(-number_at(mission, "energy_J") / distance_m, k);
  }
  std::ranges::sort(by_cost);
  json worst = json::array(), total = json::object(), spread = json::object();
  for (std::size_t k = 0; k < by_cost.size() && k < kMostNamed; ++k)
    worst.push_back(missions[by_cost[k].second]);
  for (const auto& [key, values] : columns.items()) {
    double sum = 0;
    const std::size_t stride = 1 + values.size() / kMostNumbers;
    for (std::size_t k = 0; k < values.size(); ++k) {
      sum += values[k].get<double>();
      if (k % stride == 0) spread[key].push_back(values[k]);
    }
    total[key] = sum;
  }
  total["energy_Wh"] = number_at(total, "energy_J") / kJoulesPerWh;
  return {{"count", missions.size()}, {"status", status},     {"total", total},
          {"spread", spread},         {"unsolved", unsolved}, {"worst", worst}};
}

json json_of(const MissionExtras& extras) {
  json data{{"title", extras.title}, {"subtitle", extras.subtitle}, {"goals", extras.goals}};
  if (extras.map) data["map"] = json_of(*extras.map);
  if (!extras.way.empty()) data["trajectory"] = json_of(extras.way, kMostOverlayRows);
  return data;
}

std::string page_of(const std::string& kind, const json& data) {
  return page_html(kind, data, {}, "report/main.js");
}

}  // namespace

std::string page_html(const std::string& kind, const json& data, std::span<const Module> own,
                      const std::string& starts) {
  const std::string title = data.value("title", ""), robot = data.value("subtitle", "");
  json versioned = data;
  versioned["version"] = JOULEPATH_VERSION;
  std::string name = title.empty() ? kind : kind + " · " + title;  // tabs of one mission differ in the kind
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  const std::string about =
      (robot.empty() ? "" : robot + " · ") + day() + " · joulepath " + JOULEPATH_VERSION;
  versioned["about"] = about;
  return filled(
      embedded::page,
      {{"@KIND@", kind},
       {"@STARTS@", starts},
       {"@TITLE@", escaped(name + " · " + about)},
       {"@SENTENCE@", escaped(data.value(json::json_pointer("/diagnosis/sentence"), ""))},
       {"@TABLES@", plain_tables(data.at(kind))},
       {"@PAGE_STYLE@", shared_style()},
       {"@STYLE@", std::string(embedded::style)},
       {"@DATA@", script_safe(versioned)},
       {"@MODULES@", module_scripts(shared_modules()) + module_scripts(kReportModules) + module_scripts(own)},
       {"@BOOT@", boot_script()}});
}

std::string plan_report_html(const json& plan, const Columns& trajectory, const PlanExtras& extras) {
  json data{{"plan", plan}, {"title", extras.title}, {"subtitle", extras.subtitle}};
  if (!trajectory.empty()) data["trajectory"] = json_of(trajectory, kMostRows);
  if (extras.map) data["map"] = json_of(*extras.map);
  for (const auto& [name, x_m, y_m] : extras.stations)
    data["stations"].push_back({{"name", name}, {"x_m", x_m}, {"y_m", y_m}});
  if (extras.limits) data["limits"] = json_of(*extras.limits);
  data["overlays"] = json_of(extras.overlays);
  for (const Saving& saving : extras.savings)
    data["savings"].push_back(
        {{"name", saving.name}, {"saved_J", saving.saved_J}, {"by_cause", saving.by_cause_J}});
  add_band("battery_power_W", extras.bands.battery_power_W, data);
  add_band("energy_J", extras.bands.energy_J, data);
  add_band("battery_fraction", extras.bands.battery_fraction, data);
  add_band("winding_C", extras.bands.winding_C, data);
  const auto& [missions_per_day, price_per_kWh] = extras.operation;
  if (missions_per_day) data["missions_per_day"] = *missions_per_day;
  if (price_per_kWh) data["price_per_kWh"] = *price_per_kWh;
  return page_of("plan", data);
}

json runs_json(const std::vector<RunComparison>& runs, std::size_t most_numbers) {
  std::size_t columns = 0;
  for (const RunComparison& run : runs) columns += run.columns.size();
  const std::size_t rows =
      std::clamp<std::size_t>(most_numbers / std::max<std::size_t>(columns, 1), 100, kMostOverlayRows);
  json list = json::array();
  for (const RunComparison& run : runs)
    list.push_back({{"name", run.name}, {"use", run.use}, {"columns", json_of(run.columns, rows)}});
  return list;
}

std::string diagnosis_report_html(const json& diagnosis, const DiagnosisExtras& extras) {
  json data{{"diagnosis", diagnosis}, {"title", extras.title}, {"subtitle", extras.subtitle}};
  for (const VerdictWords& words : kVerdicts)
    if (diagnosis.value("verdict", "") == words.name)
      data["verdict"] = {{"title", words.title}, {"meaning", words.meaning}, {"good", words.good}};
  if (extras.map) data["map"] = json_of(*extras.map);
  data["runs"] = runs_json(extras.runs);
  return page_of("diagnosis", data);
}

std::string compare_report_html(const json& compare, const std::vector<NamedColumns>& profiles,
                                const MissionExtras& extras) {
  json data = json_of(extras);
  data["compare"] = compare;
  data["profiles"] = json_of(profiles);
  return page_of("compare", data);
}

std::string front_report_html(const json& front, const MissionExtras& extras) {
  json data = json_of(extras);
  data["front"] = front;
  return page_of("front", data);
}

std::string batch_report_html(const json& batch, const std::string& title) {
  return page_of("batch", {{"batch", compact_batch(batch)}, {"title", title}});
}

}  // namespace joulepath::report
