#include "scenarios/result_files/diagnosis_sentence.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "diagnosis/thresholds.hpp"
#include "model/effects/catalog.hpp"
#include "model/effects/effect_label.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/text/three_digits.hpp"

namespace joulepath {
namespace {

std::string percent_text(double percent) { return three_digits(percent) + " %"; }

std::string plain_words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

/// "dragging wheel (left), 0.24 N m": the effect with its strength.
std::string strength_words(const Cause& cause) {
  std::string text = plain_words(effect_label(cause.effect));
  if (cause.parameters.empty()) return text;
  const FoundParameter& strength = cause.parameters.front();
  const EffectDescription* effect = find_effect(cause.effect.name);
  const ParameterDescription* described = effect ? effect->find(strength.name) : nullptr;
  const std::string unit = described && described->unit != "1" ? described->unit : "";
  return text + ", " + three_digits(strength.value) + (unit.empty() ? "" : " " + unit);
}

std::string others_words(const Cause& cause) {
  std::vector<std::string> others;
  for (const std::string& other : cause.indistinguishable_from) others.push_back(plain_words(other));
  return text_of_list(others);
}

/// "viscous friction, 0.01 N m s/rad (probability 0.29, not told from quadratic drag, stribeck friction)".
std::string cause_words(const Cause& cause) {
  const std::string others = others_words(cause);
  return strength_words(cause) + " (probability " + three_digits(cause.probability) +
         (others.empty() ? "" : ", not told from " + others) + ")";
}

std::string causes_words(const std::vector<Cause>& causes) {
  std::vector<std::string> words;
  for (const Cause& cause : causes) words.push_back(cause_words(cause));
  return text_of_list(words, "; ");
}

/// " The position gap shrinks from 68 mm to 12 mm.": of a pose, where the correction changes it by what
/// counts.
std::string pose_words(const char* subject, const SignalGap& gap, double scale, const char* unit) {
  if (!gap.present || std::max(gap.before_rms, gap.after_rms) <= gap.noise_floor_rms) return "";
  if (!is_notable_change(gap.before_rms, gap.after_rms)) return "";
  return std::string(" The ") + subject + " gap " + (gap.after_rms < gap.before_rms ? "shrinks" : "grows") +
         " from " + three_digits(scale * gap.before_rms) + " to " + three_digits(scale * gap.after_rms) +
         " " + unit + ".";
}

/// " shrinks from 26 % to 0.3 % (noise floor 0.1 %)": one gap of energy. A change that does not count is
/// none.
std::string size_words(const EnergyGap& e, bool named) {
  const std::string floor = " (noise floor " + percent_text(e.noise_floor_percent) + ")";
  const bool shrinks = named && e.after_percent < e.before_percent &&
                       is_notable_change(e.before_percent, e.after_percent) &&
                       e.before_percent > e.noise_floor_percent;
  if (!shrinks) return " is " + percent_text(e.before_percent) + floor;
  return " shrinks from " + percent_text(e.before_percent) + " to " + percent_text(e.after_percent) + floor;
}

/// "The energy gap shrinks from 26 % to 0.3 % (noise floor 0.1 %)."; of motors and battery, where both are
/// measured; and the gaps of the pose where they change.
std::string gap_words(const Diagnosis& d) {
  const bool named = !d.causes.empty();
  const std::optional<EnergyGap>& battery = d.gap.battery_energy;
  const std::string whose = d.simulator.runs > 0 ? " The simulator's " : " The ";
  std::string words;
  if (d.gap.energy.before_J > 0)
    words =
        whose + (battery ? "energy gap at the motors" : "energy gap") + size_words(d.gap.energy, named) + ".";
  if (battery && battery->before_J > 0)
    words += whose + "energy gap at the battery" + size_words(*battery, named) + ".";
  if (!named) return words;
  return words + pose_words("position", d.gap.position_m, 1000, "mm") +
         pose_words("heading", d.gap.heading_rad, 1, "rad");
}

/// "Beyond the robot file the simulator contains rolling resistance, 0.008 (probability 0.97).": told from
/// its predictions alone.
std::string contents_words(const SimulatorGap& simulator) {
  if (simulator.is_another_robots) return "The robot file does not describe the robot of the simulator.";
  if (simulator.contents == Verdict::no_gap) return "The simulator contains nothing beyond the robot file.";
  if (simulator.contents == Verdict::too_little_data)
    return "Its logs are too few to tell what the simulator contains beyond the robot file.";
  const bool whole = simulator.contents == Verdict::explained;
  if (simulator.contains.empty()) return "What the simulator contains beyond the robot file has no name.";
  return "Beyond the robot file the simulator contains " + causes_words(simulator.contains) +
         (whole ? "." : "; this is not all of it, or not sure.");
}

/// "5 of 12 runs are aligned by the path, 7 by the time.": by the time alone is nothing to tell.
std::string alignment_words(const SimulatorGap& simulator) {
  std::string words;
  const auto add = [&](std::size_t runs, const char* by) {
    if (runs > 0) append_item(words, std::to_string(runs) + " by " + by);
  };
  add(simulator.by_path, "the path");
  add(simulator.by_command, "the commands");
  if (words.empty()) return "";
  add(simulator.by_time, "the time");
  return " Of " + std::to_string(simulator.runs) + " predictions, which move otherwise, are aligned " +
         words + ".";
}

/// " above 2.3 % of the energy": what the runs would have shown, or what they show within calibration errors,
/// where more than what matters.
std::string size_not_seen(const Diagnosis& d) {
  const double percent = std::max(d.gap.energy.detectable_percent, d.gap.energy.before_percent);
  return percent > 100 * kMaterialEnergy ? " above " + three_digits(percent) + " % of the energy" : "";
}

/// With the share of each unknown cause in what is explained.
std::string unknown_words(const Diagnosis& d) {
  if (!d.leftover_significant || d.leftover_description.empty()) return "";
  std::vector<std::string> shares;
  for (const UnknownCause& unknown : d.unknowns)
    shares.push_back(unknown.depends_on + ", " + percent_text(100 * unknown.share) + " of the explained gap");
  return " What no effect explains " +
         (shares.empty() ? d.leftover_description : "depends on " + text_of_list(shares, "; then ")) + ".";
}

/// "these runs cannot tell viscous friction, 0.01 N m s/rad (probability 0.5) from quadratic drag": each
/// cause that has a group, then the others.
std::string group_words(const Diagnosis& d) {
  std::vector<std::string> groups;
  std::vector<Cause> single;
  for (const Cause& cause : d.causes) {
    if (cause.indistinguishable_from.empty())
      single.push_back(cause);
    else
      groups.push_back(strength_words(cause) + " (probability " + three_digits(cause.probability) +
                       ") from " + others_words(cause));
  }
  if (groups.empty()) return "the likeliest cause is uncertain: " + causes_words(single) + ".";
  return "these runs cannot tell " + text_of_list(groups, "; nor ") +
         (single.empty() ? "" : "; beside it " + causes_words(single)) + ".";
}

/// A sentence after a colon.
std::string clause(std::string sentence) {
  sentence.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(sentence.front())));
  return sentence;
}

std::string suspects_words(const std::vector<DataCheck>& checks) {
  std::vector<std::string> words;
  for (const DataCheck& check : checks)
    words.push_back(check.channel + " " + check.kind + (check.run.empty() ? "" : " in " + check.run));
  return text_of_list(words, "; ");
}

/// One factor on a quantity of the drive in all runs, or factors on several ones, may as well be the file of
/// a robot with another motor and mass.
std::string another_robots_words(const std::vector<DataCheck>& checks) {
  const auto scales_drive = [](const DataCheck& check) {
    return check.kind == "scaled" &&
           (check.channel.starts_with("motor_") || check.channel.starts_with("wheel_speed_"));
  };
  const bool in_all_runs = std::ranges::any_of(
      checks, [&](const DataCheck& check) { return scales_drive(check) && check.run.empty(); });
  return in_all_runs || std::ranges::count_if(checks, scales_drive) > 1
             ? " Another robot's file gives the same picture: compare its motor and mass with the robot's "
               "first."
             : "";
}

/// The meaning of a verdict on the robot file: without a gap, effects may be listed that are too small to
/// count.
std::string file_meaning(const Diagnosis& d) {
  if (d.verdict == Verdict::no_gap && !d.below_materiality.empty())
    return "Calibration errors, noise and effects too small to count explain the runs.";
  return words_of(d.verdict).meaning;
}

/// The sentence on the model of the robot file.
std::string model_sentence(const Diagnosis& d) {
  const VerdictWords& words = words_of(d.verdict);
  const std::string title = std::string(words.title) + ": ";
  switch (d.verdict) {
    case Verdict::no_gap:
      return std::string(words.title) + (d.simulator.runs > 0 ? " of the simulator" : "") + size_not_seen(d) +
             ": " + clause(file_meaning(d)) + gap_words(d);
    case Verdict::explained:
      return title + causes_words(d.causes) + "." + gap_words(d);
    case Verdict::partly_explained:
      return title + causes_words(d.causes) + "." + gap_words(d) + unknown_words(d);
    case Verdict::ambiguous:
      return title + group_words(d) + gap_words(d);
    case Verdict::data_suspect:
      return title + suspects_words(d.data_checks) + ". " + words.next_step +
             another_robots_words(d.data_checks);
    case Verdict::unexplained:
      return title + clause(words.meaning) + gap_words(d) + unknown_words(d);
    case Verdict::too_little_data:
      return title + clause(words.meaning) + gap_words(d);
  }
  return {};
}

/// "The robot file does not describe this robot: winding resistance 2.7 ohm in the file, 0.5 ohm in the
/// runs."
std::string foreign_words(const std::vector<ForeignConstant>& constants) {
  std::vector<std::string> words;
  for (const ForeignConstant& one : constants)
    words.push_back(one.name + " " + three_digits(one.in_file) + " " + one.unit + " in the file, " +
                    three_digits(one.in_runs) + " " + one.unit + " in the runs");
  return "The robot file does not describe this robot: " + text_of_list(words, "; ") + ".";
}

std::string verdict_sentence(const Diagnosis& d) {
  if (d.foreign_constants.empty()) return model_sentence(d);
  return std::string(words_of(d.verdict).title) + ": " + clause(foreign_words(d.foreign_constants));
}

}  // namespace

std::string velocity_filter_words(const Diagnosis& d) {
  if (d.velocity_filter_s == 0) return "";
  return "The wheel speeds are behind a filter of " + three_digits(d.velocity_filter_s) +
         " s; all channels are compared behind it.";
}

std::string runs_apart_words(const Diagnosis& d) {
  std::vector<std::string> words;
  for (const RunApart& apart : d.runs_apart)
    words.push_back(apart.run + ", whose energy is " + percent_text(std::abs(apart.over_model_percent)) +
                    (apart.over_model_percent < 0 ? " below" : " above") + " the model of the others (" +
                    percent_text(100 * apart.share_of_gap) + " of the gap of all runs)");
  return words.empty() ? "" : "Left out: " + text_of_list(words, "; ") + ".";
}

std::string simulator_words(const Diagnosis& d) {
  const SimulatorGap& simulator = d.simulator;
  if (simulator.runs == 0) return "";
  std::string words = contents_words(simulator) + alignment_words(simulator);
  if (simulator.runs < simulator.of_runs)
    words +=
        " " + std::to_string(simulator.of_runs - simulator.runs) + " runs without a prediction are left out.";
  if (!simulator.lacking_channels.empty())
    words += " What predictions lack is compared with this program's model: " +
             text_of_list(simulator.lacking_channels) + ".";
  return words;
}

std::string right_robot_question(const std::string& robot_file, const std::vector<ForeignConstant>& constants,
                                 const std::vector<DataCheck>& checks) {
  const std::string why = constants.empty() ? another_robots_words(checks) : " " + foreign_words(constants);
  return why.empty() ? "" : "is " + robot_file + " the right robot file?" + why;
}

std::string diagnosis_sentence(const Diagnosis& d) {
  std::string sentence = verdict_sentence(d);
  for (const std::string& more : {simulator_words(d), velocity_filter_words(d), runs_apart_words(d)})
    if (!more.empty()) sentence += " " + more;
  return sentence;
}

std::string diagnosis_meaning(const Diagnosis& d) {
  return d.foreign_constants.empty() ? file_meaning(d) : foreign_words(d.foreign_constants);
}

}  // namespace joulepath
