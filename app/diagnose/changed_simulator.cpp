#include "app/diagnose/changed_simulator.hpp"

#include <map>
#include <nlohmann/json.hpp>

#include "app/jobs/content_hash.hpp"
#include "diagnosis/simulator/simulated_runs.hpp"
#include "model/number_text.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/log_files/predictions_in.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/result_files/gap_after.hpp"
#include "scenarios/result_files/output_schemas.hpp"

namespace joulepath {
namespace {

struct ComparedLog {
  std::string content{}, predicted_content{};
};

std::string content_of(const Run& run) {
  ContentHash hash;
  hash.mix(run_log_text(run.log));
  for (const PayloadStep& step : run.payload)
    hash.mix(number_text(step.from_s)).mix(number_text(step.payload_kg));
  return hash.text();
}

/// By the name of the run.
std::map<std::string, ComparedLog> compared_logs(const Dataset& dataset) {
  std::map<std::string, ComparedLog> logs;
  for (const Run& run : dataset.runs)
    if (has_prediction(run))
      logs[run.name] = {content_of(run), ContentHash().mix(run_log_text(*run.predicted)).text()};
  return logs;
}

/// The runs of a first diagnosis must be those of the dataset, unchanged.
void refuse_other_logs(const Dataset& dataset, const Node& first) {
  const std::map<std::string, ComparedLog> logs = compared_logs(dataset);
  const std::vector<Node> entries = first["logs"].items();
  for (const Node& entry : entries) {
    const std::string& run = entry["run"].text();
    const auto log = logs.find(run);
    if (log == logs.end())
      entry["run"].fail_found("\"" + run + "\", which " + dataset.file + " does not compare",
                              "the runs of the first diagnosis");
    if (log->second.content != entry["content"].text())
      entry["content"].fail_found("another content of " + run, "the log that the first diagnosis saw");
    if (log->second.predicted_content != entry["predicted_content"].text())
      entry["predicted_content"].fail_found("another content of the prediction of " + run,
                                            "the prediction that the first diagnosis saw",
                                            "the changed simulator's logs stand in a directory of their own");
  }
  if (logs.size() != entries.size())
    first["logs"].fail_found(std::to_string(entries.size()) + " runs, where " + dataset.file + " compares " +
                                 std::to_string(logs.size()),
                             "the runs of the first diagnosis");
}

Forecast forecast_of(const Node& first) {
  const Node energy = first["gap"]["energy"];
  const std::vector<Node> ends = energy["shrink_interval_95"].items();
  Forecast forecast{.method = first["validation"]["method"].text(),
                    .noise_floor_percent = energy["noise_floor_percent"].number(),
                    .shrink_fraction = energy["shrink_fraction"].number(),
                    .shrink_interval_95 = {ends[0].number(), ends[1].number()}};
  if (const auto battery = first["gap"].find("battery_energy");
      battery && battery->kind() == Value::Kind::map)
    forecast.battery_floor_percent = (*battery)["noise_floor_percent"].number();
  for (const Node& cause : first["causes"].items()) forecast.causes.push_back(cause["effect"].text());
  const Node judges = first["validation"]["runs"];
  for (const Node& run : judges.items()) forecast.held_out.push_back(run.text());
  if (forecast.held_out.empty()) judges.fail_found("no run", "a first diagnosis with runs that judge");
  return forecast;
}

/// Filters behind which the first diagnosis read the wheel speeds of the robot and of the simulator; 0: none.
struct Filters {
  double of_robot_s{}, of_simulator_s{};
};

Filters filters_of(const Node& first) {
  const auto read = [](const Node& of) {
    const auto filter_s = of.find("velocity_filter_s");
    return filter_s ? filter_s->number() : 0.0;
  };
  return {read(first), read(first["simulator"])};
}

Dataset behind(const Filters& filters, Dataset dataset) {
  for (Run& run : dataset.runs) {
    run.velocity_filter_s = filters.of_robot_s;
    run.predicted_filter_s = filters.of_simulator_s;
  }
  return dataset;
}

}  // namespace

std::string with_compared_logs(const std::string& diagnosis_json, const Dataset& dataset) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(diagnosis_json);
  nlohmann::ordered_json& list = json["simulator"]["logs"] = nlohmann::ordered_json::array();
  for (const auto& [run, log] : compared_logs(dataset))
    list.push_back({{"run", run}, {"content", log.content}, {"predicted_content", log.predicted_content}});
  return json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

ChangedSimulator changed_simulator(const Dataset& dataset, const std::string& first,
                                   const std::string& directory, const ReadOptions& options) {
  const Document document = Document::load(first);
  check_document(document, "diagnosis", result_schema("diagnosis"));
  const Node root = document.root();
  if (!root.has("simulator"))
    root.fail_found("no simulator", "a diagnosis of a dataset whose runs have `predicted:`");
  refuse_other_logs(dataset, root["simulator"]);
  const Forecast forecast = forecast_of(root);
  const Filters filters = filters_of(root);
  const GapAfter after =
      gap_after(behind(filters, dataset), behind(filters, with_predictions_in(dataset, directory, options)),
                forecast.held_out, forecast.noise_floor_percent, forecast.battery_floor_percent);
  return {gap_after_json(after, forecast), after_sentence(after, forecast)};
}

}  // namespace joulepath
