#include "diagnosis/checks/survey.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/checks/motor_notes.hpp"
#include "diagnosis/checks/plausible.hpp"
#include "diagnosis/checks/pose_notes.hpp"
#include "diagnosis/signals/manoeuvres.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/effects/catalog.hpp"
#include "model/limit_table.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
// Design: docs/decisions/0508-what-runs-can-show.md
namespace joulepath {
namespace {

constexpr double kFewest_Hz = 10.0;
constexpr double kCertainlyLong_s = 10.0;  ///< a log that is too short by its samples, not by its time

/// Share of the runs that have a channel.
template <class Has>
double share_of(const std::vector<RunSignals>& signals, Has&& has) {
  double count = 0;
  for (const RunSignals& run : signals) count += has(run) ? 1 : 0;
  return signals.empty() ? 0.0 : count / static_cast<double>(signals.size());
}

/// The runs that a finding concerns: up to three names, or their number.
std::string runs_text(const std::vector<std::string>& runs, std::size_t all) {
  constexpr std::size_t kMostNames = 3;
  if (runs.size() > kMostNames)
    return (runs.size() == all ? "all " : "") + std::to_string(runs.size()) + " runs: ";
  std::string text;
  for (const std::string& run : runs)
    if (!run.empty()) append_item(text, run);
  return text.empty() ? text : text + ": ";
}

bool never_moves(const Dataset& dataset) {
  return std::ranges::none_of(dataset.runs, [](const Run& run) {
    const Sided<std::vector<double>>& speed_rad_s = run.log.wheel_speed_rad_s;
    const auto moves = [](double speed) { return std::abs(speed) > kMovingWheel_rad_s; };
    return is_energy_run(run) || std::ranges::any_of(speed_rad_s.left, moves) ||
           std::ranges::any_of(speed_rad_s.right, moves);
  });
}

/// The effects that cannot be seen without a channel or motion.
std::vector<std::string> hidden_without(bool Needs::*need) {
  std::vector<std::string> effects;
  for (const EffectDescription& effect : effect_catalog())
    if (effect.info.needs.*need) effects.emplace_back(effect.info.name);
  return effects;
}

/// A constant of the robot that a pose shows: so does a yaw rate in turns, beside the other constants that it
/// depends on.
bool is_constant_in_a_pose(const std::string& name) {
  const EffectInfo& info = find_effect(name)->info;
  return info.needs.pose && info.stage == Stage::parameters;
}

std::string hidden_text(const std::vector<std::string>& effects) {
  return text_of_list(effects) + " cannot be seen";
}

/// A channel that runs may lack: the effects that need it, or another consequence.
struct Channel {
  const char* name{};
  bool (*is_in)(const RunSignals&){};
  bool Needs::*need{};
  const char* consequence{};
};

bool measures_pose(const RunSignals& run) { return run.x_m.size() > 0 && run.heading_measured; }
bool measures_gyro(const RunSignals& run) { return run.gyro_yaw_rate_rad_s.size() > 0; }
bool measures_yaw_rate(const RunSignals& run) { return measures_gyro(run) || measures_pose(run); }
bool measures_battery(const RunSignals& run) { return run.battery_power_W.size() > 0; }

constexpr Channel kChannels[] = {
    {"motor_current",
     [](const RunSignals& r) {
       return r.motor_current_A.left.size() > 0 && r.motor_current_A.right.size() > 0;
     },
     nullptr, "mechanics are visible in the voltage only, mixed with winding and sensor errors"},
    {"motor_voltage",
     [](const RunSignals& r) {
       return r.motor_voltage_V.left.size() > 0 && r.motor_voltage_V.right.size() > 0;
     },
     nullptr,
     "winding, driver and magnet errors cannot be separated from errors of the current sensor; energies are "
     "computed from the currents and the robot file's winding"},
    {"battery", measures_battery, &Needs::battery},
    {"pose", measures_pose, &Needs::pose},
    {"gyro", measures_gyro, nullptr, "yaw rates are visible in the pose only"},
    {"yaw_rate", measures_yaw_rate, &Needs::yaw_rate},
    {"start_time", [](const RunSignals& r) { return r.time_of_day_known; }, &Needs::time_of_day},
};

double log_length_s(const Trajectory& log) {
  return log.size() == 0 ? 0.0 : log.time_s.back() - log.time_s.front();
}

std::string length_text(const Trajectory& log) {
  return std::to_string(log.size()) + " samples in " + four_digits(log_length_s(log)) + " s";
}

std::string needed_text() {
  return std::to_string(kLeastSamples) + " samples and " + four_digits(kLeastLength_s) + " s";
}

}  // namespace

Survey survey_dataset(const Dataset& dataset, const std::vector<RunSignals>& signals) {
  Survey survey;
  const Manoeuvres manoeuvres = manoeuvres_of(signals);
  const bool shows_turns = turns(manoeuvres) && std::ranges::any_of(signals, measures_yaw_rate);
  const auto lacks = [&](const std::string& what, bool in_all_runs, bool Needs::*need) {
    std::vector<std::string> effects = hidden_without(need);
    if (shows_turns) std::erase_if(effects, is_constant_in_a_pose);
    survey.notes.push_back(what + ": " + hidden_text(effects));
    if (in_all_runs) survey.invisible_effects.insert(effects.begin(), effects.end());
  };
  for (const Channel& channel : kChannels) {
    const double share = share_of(signals, channel.is_in);
    if (share >= 1) continue;
    survey.missing_channels.push_back(channel.name);
    const std::string what = std::string(share > 0 ? "some runs have no " : "no ") + channel.name;
    if (channel.need)
      lacks(what, share == 0, channel.need);
    else
      survey.notes.push_back(what + ": " + channel.consequence);
  }
  if (!has_two_payloads(signals) && std::ranges::all_of(signals, &RunSignals::payload_known))
    survey.notes.push_back(
        "one payload only: losses that grow with the load cannot be separated from constant ones");
  std::ranges::move(motor_notes(dataset), std::back_inserter(survey.notes));
  std::ranges::move(pose_notes(dataset), std::back_inserter(survey.notes));
  if (never_moves(dataset))
    survey.notes.push_back(
        "no wheel turns in any run: only standby power and offsets can be seen; is it the log of a standing "
        "robot, or the wrong topic of the wheels?");
  if (!turns(manoeuvres)) lacks("no turns", true, &Needs::turns);
  if (!reverses(manoeuvres)) lacks("no reversing", true, &Needs::reversing);
  if (manoeuvres.still < kLeastManoeuvreShare)
    survey.notes.push_back("no standstill: sensor offsets are less visible");
  for (const std::string& note : {unstated_payload_note(dataset), short_runs_note(dataset)})
    if (!note.empty()) survey.notes.push_back(note);
  return survey;
}

std::string unstated_payload_note(const Dataset& dataset) {
  std::vector<std::string> runs;
  for (const Run& run : dataset.runs)
    if (!run.payload_known && has_usable_log(run)) runs.push_back(run.name);
  if (runs.empty() || payload_limit_kg(dataset.robot) <= 0) return "";
  return runs_text(runs, dataset.runs.size()) +
         "the payload is not stated. It is estimated from the log, and no mass is named on that ground. The "
         "dataset file states it per run: - {file: " +
         runs.front() + ", payload_kg: 0}";
}

std::string short_runs_note(const Dataset& dataset) {
  std::vector<std::string> runs;
  const Trajectory* longest = nullptr;
  for (const Run& run : dataset.runs) {
    if (is_energy_run(run) || has_usable_log(run)) continue;
    runs.push_back(run.name);
    if (!longest || log_length_s(run.log) > log_length_s(*longest)) longest = &run.log;
  }
  if (!longest) return "";
  return runs_text(runs, dataset.runs.size()) + "too short, left out: " + (runs.size() > 1 ? "up to " : "") +
         length_text(*longest) + ", where the smoothing needs " + needed_text();
}

void refuse_short_runs(const Dataset& dataset) {
  if (dataset.runs.empty() || std::ranges::any_of(dataset.runs, [](const Run& run) {
        return is_energy_run(run) || has_usable_log(run);
      }))
    return;
  const Run& longest =
      std::ranges::max(dataset.runs, {}, [](const Run& run) { return log_length_s(run.log); });
  std::string found = "no run that is long enough: " + longest.name + " has " + length_text(longest.log),
              hint;
  for (const Implausible& channel : implausible_channels(longest, dataset.robot))
    append_item(found, channel.found), append_item(hint, channel.hint);
  const double length_s = log_length_s(longest.log);
  if (hint.empty() && length_s > kCertainlyLong_s &&
      static_cast<double>(longest.log.size()) < kFewest_Hz * length_s)
    append_item(hint, "about " + four_digits(static_cast<double>(longest.log.size()) / length_s) +
                          " samples a second are too few: record at 20 to 100 Hz");
  throw ConfigError({longest.mark, "runs", found, "a log with wheel speeds and " + needed_text(), hint});
}

std::vector<std::string> artifact_texts(const Dataset& dataset) {
  std::vector<std::string> findings;                          // in the order of their first run
  std::map<std::string, std::vector<std::string>> runs_with;  // key: the finding
  for (const LogArtifact& artifact : dataset.artifacts) {
    const std::string finding = artifact.kind + (artifact.channel.empty() ? "" : " in " + artifact.channel) +
                                (artifact.description.empty() ? "" : ": " + artifact.description);
    std::vector<std::string>& runs = runs_with[finding];
    if (runs.empty()) findings.push_back(finding);
    runs.push_back(artifact.run);
  }
  std::vector<std::string> texts;
  for (const std::string& finding : findings)
    texts.push_back(runs_text(runs_with[finding], dataset.runs.size()) + finding);
  for (const Run& run : dataset.runs)
    if (run.current_sign_from_motion) {
      texts.push_back("currents are unsigned: they get the sign of the wheels' motion");
      break;
    }
  return texts;
}

}  // namespace joulepath
