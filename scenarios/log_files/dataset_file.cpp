#include "scenarios/log_files/dataset_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "diagnosis/checks/plausible.hpp"
#include "model/number_text.hpp"
#include "model/progress.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/log_files/clock_jumps.hpp"
#include "scenarios/log_files/log_tables.hpp"
#include "scenarios/log_files/partial_channels.hpp"
#include "scenarios/log_files/predictions_in.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/log_files/standstill_cuts.hpp"
#include "scenarios/mission_files/motion_entry.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/csv_table.hpp"
#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {
namespace {

std::vector<PayloadStep> read_payload(const Node& node) {
  if (node.kind() == Value::Kind::scalar) return {{0.0, node.number()}};
  std::vector<PayloadStep> steps;
  for (const auto& item : node.items()) {
    steps.push_back({item["from_s"].number(), item["kg"].number()});
    if (steps.size() > 1 && steps.back().from_s <= steps[steps.size() - 2].from_s)
      item["from_s"].fail("a time after the step before");
  }
  return steps;
}

/// Readings of a log's payload that differ from what the dataset file states; the file's value is used.
void find_contradiction(const Run& run, const std::vector<double>& stated_kg,
                        std::vector<LogArtifact>& artifacts) {
  constexpr double kRounding_kg = 0.01;
  const std::vector<double>& logged_kg = run.log.payload_kg;
  LogArtifact found{.kind = "contradiction", .run = run.name, .channel = "payload_kg"};
  for (std::size_t i = 0; i < logged_kg.size(); ++i) {
    if (std::abs(logged_kg[i] - stated_kg[i]) <= kRounding_kg || found.count++ > 0) continue;
    found.first_time_s = run.log.time_s[i];
    found.description = "the log has " + number_text(logged_kg[i]) + " kg, the dataset file " +
                        number_text(stated_kg[i]) + " kg; the dataset file's value is used";
  }
  if (found.count > 0) artifacts.push_back(std::move(found));
}

/// The steps of the payload; a column of it only where it changes, because that of a long log takes memory.
void fill_payload(Run& run, std::vector<LogArtifact>& artifacts) {
  Trajectory& log = run.log;
  std::vector<double>& column = log.payload_kg;
  if (run.payload.empty()) {
    run.payload_known = !column.empty();
    if (column.empty()) run.payload = {{log.size() ? log.time_s.front() : 0.0, 0.0}};
    for (std::size_t i = 0; i < column.size(); ++i)
      if (i == 0 || column[i] != column[i - 1]) run.payload.push_back({log.time_s[i], column[i]});
  } else {
    run.payload_known = true;
    std::vector<double> stated_kg(run.payload.size() > 1 || !column.empty() ? log.size() : 0);
    std::size_t step = 0;
    for (std::size_t i = 0; i < stated_kg.size(); ++i) {
      while (step + 1 < run.payload.size() && log.time_s[i] >= run.payload[step + 1].from_s) ++step;
      stated_kg[i] = run.payload[step].payload_kg;
    }
    find_contradiction(run, stated_kg, artifacts);
    column = std::move(stated_kg);
  }
  if (run.payload.size() == 1) column = std::vector<double>();
}

/// The run without channels that are known in a part of it: as a whole, or in its parts.
std::vector<Run> with_whole_channels(Run run, const ReadOptions& options,
                                     std::vector<LogArtifact>& artifacts) {
  if (!options.keep_whole_drives) return split_at_partial_channels(std::move(run), artifacts);
  drop_partial_channels(run.log, run.name, artifacts);
  std::vector<Run> whole;
  whole.push_back(std::move(run));
  return whole;
}

class RunReader {
 public:
  RunReader(Dataset& dataset, const ColumnSources& sources, const ReadOptions& options,
            const DatasetInMemory& memory)
      : dataset_(dataset), sources_(sources), options_(options), memory_(memory) {}

  void read(const Node& node) {
    Run run{.name = node.path(),
            .surface = node.text_or("surface", ""),
            .start_time_s = node.optional_number("start_time_s"),
            .mark = node.mark()};
    const std::string use = node.text_or("use", "any");
    run.use = use == "diagnosis" ? RunUse::diagnosis : use == "validation" ? RunUse::validation : RunUse::any;
    if (const auto payload = node.find("payload_kg")) run.payload = read_payload(*payload);
    read_energy(node, run);
    if (node.has("motion"))
      read_energy_only(node, run);
    else
      read_log(node, run);
    fill_payload(run, dataset_.artifacts);
    add(node, std::move(run));
  }

  /// The prediction of a run that is read, from another directory.
  void read_prediction_in(const std::string& directory, const Node& node, Run& run) {
    const Node predicted = node["predicted"];
    auto file = std::filesystem::path(directory) / predicted.text();  // as deep as predicted: says, or flat
    if (!std::filesystem::exists(file)) file = std::filesystem::path(directory) / file.filename();
    if (!std::filesystem::exists(file))
      predicted.fail_found("no file " + file.string(), "a log of that name for each run with `predicted:`");
    read_predicted(predicted, file.string(), sources_of_run(node, sources_), run);
  }

 private:
  void add(const Node& node, Run whole) {
    std::vector<Run> runs = with_whole_channels(std::move(whole), options_, dataset_.artifacts);
    for (Run& run : runs) add_stretches(node, std::move(run));
  }

  void add_stretches(const Node& node, Run run) {
    std::vector<Run> stretches = split_at_clock_jumps(std::move(run), dataset_.artifacts);
    if (stretches.empty())
      node.fail_found("a log with a jump of the clock at every sample", "a clock in seconds");
    if (stretches.size() > 1)
      for (const char* key : {"measured_energy_J", "battery_energy_Wh", "predicted"})
        if (const auto whole = node.find(key))
          whole->fail_found("a value of the whole run", "no such value for a log whose clock jumps",
                            "split the log at the jump, or correct time_s");
    std::move(stretches.begin(), stretches.end(), std::back_inserter(dataset_.runs));
  }

  static void read_energy(const Node& node, Run& run) {
    if (const auto energy = node.find("measured_energy_J"))
      run.measured_energy_J = Sided<double>{(*energy)["left"].number(), (*energy)["right"].number()};
    run.battery_energy_Wh = node.optional_number("battery_energy_Wh");
  }

  static void read_energy_only(const Node& node, Run& run) {
    run.motion = read_motion(node["motion"]);
    if (!run.measured_energy_J && !run.battery_energy_Wh)
      node.fail("motion together with measured_energy_J or battery_energy_Wh",
                "a run without a log needs its measured energy");
    if (const auto predicted = node.find("predicted"))
      predicted->fail("no such key", "not allowed together with motion");
  }

  void read_log(const Node& node, Run& run) {
    std::vector<LogFileName> files;
    const auto add = [&](const Node& name) {
      if (const CsvTable* table = in_memory(name.text()))
        files.push_back({name.text(), NamedBy(name), table});
      else
        files.push_back({resolve_file(name, options_), NamedBy(name)});
    };
    if (const auto names = node.find("files"))
      for (const auto& name : names->items()) add(name);
    else
      add(node["file"]);
    run.name = node.has("file") ? node["file"].text() : node["files"].items().front().text();
    const Node named_by = node.has("file") ? node["file"] : node["files"];
    refuse_repeated(run.name, named_by);
    const ColumnSources sources = sources_of_run(node, sources_);
    RunLog log = read_run_log(files, sources, dataset_.robot.geometry, run.name);
    run.log = std::move(log.trajectory);
    refuse_same_samples(run, named_by);
    run.current_sign_from_motion = log.current_sign_from_motion;
    run.wheels_from_body_speeds = log.wheels_from_body_speeds;
    run.clock_origin_s = log.clock_origin_s;
    if (!options_.accept_implausible)
      for (const Implausible& channel : implausible_channels(run, dataset_.robot))
        named_by.fail_found(channel.found, channel.accepted,
                            channel.hint + " `columns:` with scale converts");
    dataset_.artifacts.insert(dataset_.artifacts.end(), log.artifacts.begin(), log.artifacts.end());
    if (const auto predicted = node.find("predicted"))
      read_predicted(*predicted, resolve_file(*predicted, options_), sources, run);
  }

  [[nodiscard]] const CsvTable* in_memory(const std::string& name) const {
    if (!memory_.logs) return nullptr;
    const auto found = memory_.logs->find(name);
    return found == memory_.logs->end() ? nullptr : &found->second;
  }

  /// A log that is listed twice would count twice as evidence, and could be its own held-out run.
  void refuse_repeated(const std::string& name, const Node& named_by) const {
    for (std::size_t r = 0; r < dataset_.runs.size(); ++r)
      if (dataset_.runs[r].name == name)
        named_by.fail_found("\"" + name + "\", which runs[" + std::to_string(r) + "] has already",
                            "a log that no other run has", "remove one of them");
  }

  /// Detects two names of one file (a link or a copy).
  void refuse_same_samples(const Run& run, const Node& named_by) const {
    for (std::size_t r = 0; r < dataset_.runs.size(); ++r) {
      const Trajectory &one = dataset_.runs[r].log, &other = run.log;
      if (one.time_s == other.time_s && one.wheel_speed_rad_s.left == other.wheel_speed_rad_s.left &&
          one.wheel_speed_rad_s.right == other.wheel_speed_rad_s.right &&
          one.motor_current_A.left == other.motor_current_A.left &&
          one.battery_current_A == other.battery_current_A)
        named_by.fail_found("\"" + run.name + "\", with the same samples as runs[" + std::to_string(r) + "]",
                            "a log that no other run has", "remove one of them if both are the same file");
    }
  }

  /// Reads another simulator's log, with the format's own names (`columns:` does not apply then) or with the
  /// names of the run's log.
  void read_predicted(const Node& node, const std::string& file, const ColumnSources& sources, Run& run) {
    RunLog predicted =
        read_run_log({{file, NamedBy(node)}}, has_own_names(node, file) ? ColumnSources{} : sources,
                     dataset_.robot.geometry, node.text());
    drop_partial_channels(predicted.trajectory, node.text(), dataset_.artifacts);
    refuse_no_common(node, run.log, predicted.trajectory);
    run.predicted = std::move(predicted.trajectory);
  }

  /// Bags name their sources themselves.
  static bool has_own_names(const Node& node, const std::string& file) {
    if (log_reader_of(file, NamedBy(node))) return true;
    const auto header = read_csv(
                            file, [](const std::string&) { return false; }, NamedBy(node))
                            .header;
    return std::find(header.begin(), header.end(), "time_s") != header.end();
  }

  static void refuse_no_common(const Node& node, const Trajectory& real, const Trajectory& predicted) {
    const auto span = [](const Trajectory& log) {
      return number_text(log.time_s.front()) + " to " + number_text(log.time_s.back()) + " s";
    };
    if (predicted.time_s.back() <= real.time_s.front() || real.time_s.back() <= predicted.time_s.front())
      node.fail_found("a log from " + span(predicted),
                      "one that has a time in common with the run's, " + span(real),
                      "both times count from the same origin");
    const auto both = [](const std::vector<double>& one, const std::vector<double>& other) {
      return !one.empty() && !other.empty();
    };
    const auto both_drive = [&](Side side) {
      return both(real.motor_current_A[side], predicted.motor_current_A[side]) ||
             both(real.motor_voltage_V[side], predicted.motor_voltage_V[side]) ||
             both(real.motor_power_W[side], predicted.motor_power_W[side]);
    };
    if (both_drive(Side::left) || both_drive(Side::right) ||
        both(real.battery_current_A, predicted.battery_current_A) ||
        both(real.gyro_yaw_rate_rad_s, predicted.gyro_yaw_rate_rad_s) ||
        both(real.heading_rad, predicted.heading_rad) || both(real.position_x_m, predicted.position_x_m))
      return;
    node.fail_found("no channel beyond the motion that the run's log has, too",
                    "a motor's current, voltage or power, the battery's current, gyro or pose");
  }

  Dataset& dataset_;
  const ColumnSources& sources_;
  const ReadOptions& options_;
  const DatasetInMemory& memory_;
};

}  // namespace

Schema dataset_schema() {
  return with_physical_bounds(schema_in(embedded::file_schemas, "dataset", false,
                                        {{"columns", column_sources_schema()}, {"motion", motion_schema()}}));
}

Dataset read_dataset(const std::string& file, const ReadOptions& options, const std::string& robot_file) {
  return dataset_from(Document::load(file), options, robot_file);
}

Dataset dataset_from(const Document& document, const ReadOptions& options, const std::string& robot_file,
                     const DatasetInMemory& memory) {
  static const Schema schema = dataset_schema();
  check_document(document, "dataset", schema);
  const Node root = document.root();
  Dataset dataset{.file = document.file()};
  if (memory.robot) {
    dataset.robot = *memory.robot;
  } else {
    if (robot_file.empty() && !root.has("robot"))
      root.fail_found("no robot", "robot: with the name of a robot file", "or give it with --robot");
    dataset.robot_file = robot_file.empty() ? resolve_file(root["robot"], options) : robot_file;
    dataset.robot = read_robot(dataset.robot_file, robot_file.empty() ? NamedBy(root["robot"]) : NamedBy{});
  }
  const auto columns = root.find("columns");
  const ColumnSources sources = columns ? read_column_sources(*columns) : ColumnSources{};
  RunReader reader(dataset, sources, options, memory);
  const std::vector<Node> runs = root["runs"].items();
  expect_steps(runs.size());
  for (const Node& run : runs) {
    reader.read(run);
    finish_steps();
  }
  if (options.cut_long_logs) dataset.runs = cut_at_standstill(std::move(dataset.runs), dataset.artifacts);
  return dataset;
}

Dataset with_predictions_in(Dataset dataset, const std::string& directory, const ReadOptions& options) {
  const Document document = Document::load(dataset.file);
  const Node root = document.root();
  const auto columns = root.find("columns");
  const ColumnSources sources = columns ? read_column_sources(*columns) : ColumnSources{};
  const DatasetInMemory memory;
  RunReader reader(dataset, sources, options, memory);
  for (const Node& node : root["runs"].items())
    for (Run& run : dataset.runs)
      if (run.predicted && run.mark.line == node.mark().line && run.mark.column == node.mark().column)
        reader.read_prediction_in(directory, node, run);
  return dataset;
}

Dataset read_dataset_or_log(const std::string& file, const ReadOptions& options,
                            const std::string& robot_file) {
  if (!is_log_file(file)) return read_dataset(file, options, robot_file);
  if (robot_file.empty())
    throw ConfigError(
        {{file, 1, 1}, "", "a log, which names no robot", "--robot with the name of a robot file", ""});
  return dataset_of_log(file, robot_file, options);
}

Dataset dataset_of_log(const std::string& log_file, const std::string& robot_file,
                       const ReadOptions& options) {
  Dataset dataset{.file = log_file, .robot_file = robot_file, .robot = read_robot(robot_file)};
  RunLog log = read_run_log({{log_file, {}}}, {}, dataset.robot.geometry, log_file);
  Run run{.name = log_file, .log = std::move(log.trajectory), .mark = {log_file, 0, 0}};
  run.wheels_from_body_speeds = log.wheels_from_body_speeds;
  run.clock_origin_s = log.clock_origin_s;
  if (!options.accept_implausible)
    for (const Implausible& channel : implausible_channels(run, dataset.robot))
      throw ConfigError({run.mark, "", channel.found, channel.accepted,
                         channel.hint + " `columns:` with scale, in a dataset that names the log, converts"});
  dataset.artifacts = std::move(log.artifacts);
  fill_payload(run, dataset.artifacts);
  std::vector<Run> runs = with_whole_channels(std::move(run), options, dataset.artifacts);
  for (Run& whole : runs)
    std::ranges::move(split_at_clock_jumps(std::move(whole), dataset.artifacts),
                      std::back_inserter(dataset.runs));
  if (options.cut_long_logs) dataset.runs = cut_at_standstill(std::move(dataset.runs), dataset.artifacts);
  return dataset;
}

}  // namespace joulepath
