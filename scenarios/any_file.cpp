#include "scenarios/any_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include "diagnosis/checks/data_checks.hpp"
#include "diagnosis/checks/motor_notes.hpp"
#include "diagnosis/checks/plausible.hpp"
#include "diagnosis/checks/pose_notes.hpp"
#include "diagnosis/checks/survey.hpp"
#include "diagnosis/evidence/another_robot.hpp"
#include "diagnosis/evidence/isolability.hpp"
#include "diagnosis/evidence/unstated_payload.hpp"
#include "model/abilities.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/file_kinds.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/repaired_dataset.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/mission_files/map_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/mission_list.hpp"
#include "scenarios/mission_files/path_file.hpp"
#include "scenarios/mission_files/world_notes.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/result_files/diagnosis_sentence.hpp"
#include "scenarios/robot_files/robot_check.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/robot_files/robot_sources.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

/// One note for each kind and channel, over all runs.
std::vector<std::string> notes_of(const std::vector<LogArtifact>& artifacts) {
  std::vector<std::string> notes;
  std::vector<std::pair<const LogArtifact*, std::size_t>> groups;
  for (const auto& a : artifacts) {
    const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return group.first->kind == a.kind && group.first->channel == a.channel;
    });
    if (same == groups.end())
      groups.emplace_back(&a, 1);
    else
      ++same->second;
  }
  for (const auto& [a, runs] : groups)
    notes.push_back(a->kind + (a->channel.empty() ? "" : " " + a->channel) + ": " + a->description +
                    (a->run.empty()
                         ? ""
                         : " [" + a->run + (runs > 1 ? " and " + counted(runs - 1, "other run") : "") + "]"));
  return notes;
}

/// "top speed 1.36 m/s by voltage and current, 17.8 J/m at 1 m/s, torque for a slope of 12 %, 24 kg"
std::string abilities_text(const Robot& robot) {
  const Abilities able = abilities_of(robot);
  const std::string mass = four_digits(robot.total_mass_kg(0.0)) + " kg";
  if (!able.can_move()) return mass + ", cannot move";
  std::string text;
  const auto add = [&](const std::string& before, double value, const std::string& after) {
    if (std::isfinite(value)) append_item(text, before + four_digits(value) + after);
  };
  add("top speed ", able.top_speed_m_s, " m/s by voltage and current");
  add("", able.energy_J_m, " J/m at " + four_digits(able.cruise_m_s) + " m/s");
  if (able.grade == kNoLimit) append_item(text, "torque for any slope");
  add("torque for a slope of ", 100 * able.grade, " %");
  append_item(text, mass);
  add("", able.distance_m / 1000, " km per charge");
  return text;
}

FileSummary summary_of_robot(const std::string& file) {
  const Robot robot = read_robot(file);
  FileSummary summary{"robot", robot.name + ": " + abilities_text(robot), robot_notes(robot)};
  if (!robot.limits)
    summary.notes.push_back("no limits: diagnose, estimate and calibrate work, plan does not");
  if (!robot.effects.empty()) summary.text += ", " + counted(robot.effects.size(), "effect");
  return summary;
}

/// Of a file that says something about a robot, for `init --from`.
FileSummary summary_of_source(const RobotSource& source, const std::string& file) {
  const RobotDraft draft = source.read(file, {});
  std::string text;
  for (const DraftValue& value : draft.values) append_item(text, value.key + ": " + value.text);
  return {source.says, text, draft.notes};
}

FileSummary summary_of_map(const std::string& file, const ReadOptions& options) {
  const OccupancyGrid grid = read_map(file, {}, options);
  return {"map",
          std::to_string(grid.width) + " x " + std::to_string(grid.height) + " cells, " +
              four_digits(grid.width * grid.resolution_m) + " x " +
              four_digits(grid.height * grid.resolution_m) + " m",
          map_notes(file, options)};
}

FileSummary summary_of_mission(const std::string& file, const ReadOptions& options) {
  const MissionRequest mission = read_mission(file, options);
  const MissionWorld world = read_world(mission, options);
  FileSummary summary{"mission", "", {}};
  summary.text =
      mission.legs.empty() ? counted(mission.visit.size(), "visit") : counted(mission.legs.size(), "leg");
  if (!mission.order_file.empty()) summary.text += ", from an order";
  summary.notes = world_notes(mission, world, options);
  if (!world.robot.limits) summary.notes.push_back("its robot has no limits: plan needs them");
  return summary;
}

/// Each line of a list of missions, as `batch` reads it.
FileSummary summary_of_mission_list(const std::string& file, const ReadOptions& options) {
  const std::vector<MissionItem> items = mission_items(file);
  FileSummary summary{"missions", counted(items.size(), "mission"), {}};
  for (const MissionItem& item : items) try {
      const MissionRequest mission = mission_from(document_of(item), options);
      for (const std::string& note : world_notes(mission, read_world(mission, options), options))
        if (std::ranges::find(summary.notes, note) == summary.notes.end()) summary.notes.push_back(note);
    } catch (const ConfigError& error) {
      summary.errors.push_back(error);
    }
  if (!summary.errors.empty())
    summary.text += ", " + std::to_string(summary.errors.size()) + " cannot be read";
  return summary;
}

FileSummary summary_of_dataset(const std::string& file, const ReadOptions& options, bool brief) {
  const Dataset dataset =
      read_dataset(file, {.untrusted = options.untrusted, .cut_long_logs = true, .accept_implausible = true});
  std::size_t samples = 0;
  for (const auto& run : dataset.runs) samples += run.log.size();
  refuse_short_runs(dataset);
  RunsByUse runs = sort_runs(dataset);
  FileSummary summary{"dataset", counted(dataset.runs.size(), "run") + ", " + counted(samples, "sample"),
                      notes_of(dataset.artifacts), check_data(dataset, runs)};
  describe_repairs(dataset, summary.data_checks);
  const AnotherRobot another = another_robot(dataset, runs, summary.data_checks);
  const bool of_a_simulator =
      std::ranges::any_of(dataset.runs, [](const Run& run) { return run.predicted.has_value(); });
  if (!of_a_simulator)
    summary.question = right_robot_question(dataset.robot_file, another.constants, summary.data_checks);
  summary.notes.insert(summary.notes.begin(), another.notes.begin(), another.notes.end());
  for (const std::string& note : {unstated_payload_note(dataset), short_runs_note(dataset)})
    if (!note.empty()) summary.notes.push_back(note);
  std::ranges::move(motor_notes(dataset), std::back_inserter(summary.notes));
  std::ranges::move(pose_notes(dataset), std::back_inserter(summary.notes));
  if (brief || !summary.data_checks.empty() || !summary.question.empty() || runs.signals.empty())
    return summary;
  summary.isolability = isolability(dataset, with_estimated_payloads(std::move(runs)));
  std::ranges::copy(isolability_notes(summary.isolability), std::back_inserter(summary.notes));
  return summary;
}

FileSummary summary_of_log(const std::string& file) {
  RunLog log = read_run_log(file, Geometry{.wheel_radius_m = {1.0, 1.0}, .half_track_m = 1.0});
  const std::size_t samples = log.trajectory.size();
  const Run run{.log = std::move(log.trajectory), .clock_origin_s = log.clock_origin_s};
  for (const Implausible& clock : implausible_clock(run))
    throw ConfigError({{file, 0, 0},
                       "",
                       clock.found,
                       clock.accepted,
                       clock.hint + " `columns:` with scale, in a dataset that names the log, converts"});
  return {"run log", counted(samples, "sample"), notes_of(log.artifacts)};
}

FileSummary summary_of_path(const Path& path) {
  char length[32];
  std::snprintf(length, sizeof length, "%.4g m", path.distance_m());
  const auto curves = std::count_if(path.pieces.begin(), path.pieces.end(),
                                    [](const PathPiece& piece) { return !is_turn(piece); });
  return {"path", std::string(length) + " in " + counted(static_cast<std::size_t>(curves), "piece"), {}};
}

FileSummary summary_of_points(const std::string& file) {
  std::vector<std::string> notes;
  FileSummary summary = summary_of_path(read_waypoints(file, {}, {}, &notes));
  summary.notes = std::move(notes);
  return summary;
}

FileSummary summary_of_chain(const Document& document, const ReadOptions& options) {
  std::vector<std::string> notes;
  FileSummary summary = summary_of_path(path_from(document, options, &notes));
  summary.notes = std::move(notes);
  return summary;
}

FileSummary summary_of_output(const Document& document, const FileKind& kind) {
  check_document(document, kind.name, kind.schema());
  return {kind.name, document.root().text_or("status", document.root().text_or("verdict", "")), {}};
}

/// The kind of a document: from its schema line, else from a key that only one kind has.
std::string kind_of(const Document& document) {
  const Node root = document.root();
  if (root.kind() != Value::Kind::map) return "";
  if (const auto line = root.find("schema"); line && line->kind() == Value::Kind::scalar) {
    for (const auto& kind : file_kinds())
      if (line->text().rfind("joulepath/" + kind.name + "/", 0) == 0) return kind.name;
    const auto slash = line->text().find('/');
    if (slash != std::string::npos)
      refuse_absent_word("kind", line->text().substr(slash + 1, line->text().rfind('/') - slash - 1), *line);
    line->fail("one of: " +
               text_of_list(file_kinds(), [](const auto& kind) { return "joulepath/" + kind.name + "/1"; }));
  }
  return inferred_kind(root);
}

/// The reader of a given kind, else the first one that fits. Files are recognized before they are loaded.
template <class Fits>
const FileReader* reader_of(const std::string& given_kind, bool of_documents, const Fits& fits) {
  const auto found = std::ranges::find_if(registry().files, [&](const FileReader& reader) {
    if ((reader.recognizes_file == nullptr) != of_documents) return false;
    return given_kind.empty() ? fits(reader) : given_kind == reader.kind;
  });
  return found == registry().files.end() ? nullptr : &*found;
}

}  // namespace

std::string checked_kinds() {
  std::string names = "robot, map, mission, path, dataset, run log";
  std::set<std::string> told;
  for (const FileReader& reader : registry().files)
    if (told.insert(reader.kind).second) names += ", " + reader.kind;
  return names + ", plan or diagnosis; " + robot_source_names();
}

FileSummary read_any_file(const std::string& file, const std::string& given_kind, const ReadOptions& options,
                          bool brief) {
  if (const std::string_view needed = absent_extension("kind", given_kind); !needed.empty())
    throw ConfigError(
        {{file, 0, 0}, "", "kind " + given_kind, accepted_extension(needed), extension_hint(needed)});
  const std::string extension = std::filesystem::path(file).extension().string();
  if (is_waypoint_file(file) && (given_kind == "path" || (given_kind.empty() && has_waypoints(file))))
    return summary_of_points(file);
  if (given_kind == "run log" || given_kind == "log" || (given_kind.empty() && extension == ".csv"))
    return summary_of_log(file);
  const auto by_name = [&](const FileReader& reader) { return reader.recognizes_file(file); };
  if (const FileReader* reader = reader_of(given_kind, false, by_name)) return reader->check(file, options);
  if (const RobotSource* source = robot_source_of(file)) return summary_of_source(*source, file);
  refuse_absent_file(file);
  if (given_kind.empty() && extension == ".jsonl") return summary_of_mission_list(file, options);
  const Document document = Document::load(file);
  const std::string inferred = inferred_kind(document.root());
  const auto by_content = [&](const FileReader& reader) {
    return reader.recognizes_document ? reader.recognizes_document(document) : reader.kind == inferred;
  };
  if (const FileReader* reader = reader_of(given_kind, true, by_content)) return reader->check(file, options);
  refuse_absent_document(document);
  const std::string kind = given_kind.empty() ? kind_of(document) : given_kind;
  if (kind == "robot") return summary_of_robot(file);
  if (const RobotSource* source = robot_source_of(document)) return summary_of_source(*source, file);
  if (kind == "map") return summary_of_map(file, options);
  if (kind == "mission") return summary_of_mission(file, options);
  if (kind == "dataset") return summary_of_dataset(file, options, brief);
  if (kind == "path") return summary_of_chain(document, options);
  for (const auto& known : file_kinds())
    if (known.name == kind) return summary_of_output(document, known);
  const bool empty = document.root().kind() == Value::Kind::null;
  throw ConfigError({{file, 1, 1},
                     "",
                     empty                ? "an empty file"
                     : given_kind.empty() ? "a file of unknown kind"
                                          : "kind " + given_kind,
                     checked_kinds(),
                     "a first line like `schema: joulepath/robot/1` states the kind"});
}

}  // namespace joulepath
