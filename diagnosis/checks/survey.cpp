#include "diagnosis/checks/survey.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "diagnosis/thresholds.hpp"
#include "model/effects/catalog.hpp"

namespace joulepath {
namespace {

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
    if (!run.empty()) text += (text.empty() ? "" : ", ") + run;
  return text.empty() ? text : text + ": ";
}

/// A sentence that lists the effects that cannot be seen without a channel or motion.
std::string hidden_without(bool Needs::*need) {
  std::string text;
  for (const EffectDescription& effect : effect_catalog())
    if (effect.info.needs.*need) text += (text.empty() ? "" : ", ") + std::string(effect.info.name);
  return text + " cannot be seen";
}

}  // namespace

Survey survey_dataset(const Dataset& dataset, const std::vector<RunSignals>& signals) {
  Survey survey;
  const auto lacks = [&](const std::string& channel, const std::string& consequence, const auto& has) {
    const double share = share_of(signals, has);
    if (share >= 1) return;
    survey.missing_channels.push_back(channel);
    survey.notes.push_back(std::string(share > 0 ? "some runs have no " : "no ") + channel + ": " +
                           consequence);
  };
  lacks("motor_current", "mechanics are visible in the voltage only, mixed with winding and sensor errors",
        [](const RunSignals& r) {
          return r.motor_current_A.left.size() > 0 && r.motor_current_A.right.size() > 0;
        });
  lacks("motor_voltage",
        "winding, driver and magnet errors cannot be separated from errors of the current sensor; energies "
        "are computed from the currents and the robot file's winding",
        [](const RunSignals& r) {
          return r.motor_voltage_V.left.size() > 0 && r.motor_voltage_V.right.size() > 0;
        });
  lacks("battery", hidden_without(&Needs::battery),
        [](const RunSignals& r) { return r.battery_power_W.size() > 0; });
  lacks("pose", hidden_without(&Needs::pose),
        [](const RunSignals& r) { return r.x_m.size() > 0 && r.heading_measured; });
  lacks("gyro", "yaw rates are visible in the pose only",
        [](const RunSignals& r) { return r.gyro_yaw_rate_rad_s.size() > 0; });
  lacks("start_time", hidden_without(&Needs::time_of_day),
        [](const RunSignals& r) { return r.time_of_day_known; });
  std::set<double> payloads;
  double turning = 0, reverse = 0, still = 0, total = 0;
  for (const RunSignals& run : signals) {
    payloads.insert(run.payload_kg.begin(), run.payload_kg.end());
    for (Eigen::Index j = 0; j < run.size(); ++j) {
      const double left = run.wheel_speed_rad_s.left[j], right = run.wheel_speed_rad_s.right[j];
      total += 1;
      turning += std::abs(right - left) > kTurningShare * (std::abs(left) + std::abs(right)) &&
                 std::abs(right - left) > kMovingWheel_rad_s;
      reverse += left < -kMovingWheel_rad_s && right < -kMovingWheel_rad_s;
      still += std::abs(left) < kStillWheel_rad_s && std::abs(right) < kStillWheel_rad_s;
    }
  }
  if (payloads.size() < 2)
    survey.notes.push_back(
        "one payload only: losses that grow with the load cannot be separated from constant ones");
  if (total > 0 && turning < kLeastManoeuvreShare * total)
    survey.notes.push_back("no turns: " + hidden_without(&Needs::turns));
  if (total > 0 && reverse < kLeastManoeuvreShare * total)
    survey.notes.push_back("no reversing: " + hidden_without(&Needs::reversing));
  if (total > 0 && still < kLeastStandstillShare * total)
    survey.notes.push_back("no standstill: sensor offsets are less visible");
  for (const Run& run : dataset.runs)
    if (!run.payload_known) {
      survey.notes.push_back("payload unknown in some runs: 0 kg is assumed");
      break;
    }
  return survey;
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
