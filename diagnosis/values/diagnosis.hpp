#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/thresholds.hpp"
#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/dataset.hpp"
#include "diagnosis/values/foreign_constant.hpp"
#include "diagnosis/values/isolability.hpp"
#include "diagnosis/values/verdict.hpp"
#include "model/prescribed_motion.hpp"

namespace joulepath {

using Range95 = std::pair<double, double>;  ///< low and high end of a 95 % interval

/// An effect that changes the energy, and that these runs show only from a notable size on.
struct HardToSee {
  std::string effect{};
  double detectable_percent{};  ///< of the energy: seen in 90 % of cases; infinite where no size is
};

/// The energy gap of the validation runs: sum of |predicted - measured| over sum of |measured|.
struct EnergyGap {
  double before_percent{}, after_percent{};
  double bias_before_percent{}, bias_after_percent{};
  double noise_floor_percent{};
  double before_J{}, after_J{};
  double shrink_fraction{};
  Range95 shrink_interval_95{};
  double detectable_percent{};  ///< with no_gap: a gap of this size would have been seen in 90 % of cases
  std::vector<HardToSee> hard_to_see{};
};

/// Root mean squares over the validation runs.
struct SignalGap {
  double before_rms{}, after_rms{}, noise_floor_rms{};
  bool present{};
};

/// Whether a gap changes by what counts.
[[nodiscard]] inline bool is_notable_change(double before, double after) {
  return std::abs(after - before) >= kNotableShrink * before;
}

struct GapReport {
  EnergyGap energy{};  ///< of both motors, or at the battery's terminals where nothing measures the motors
  std::optional<EnergyGap> battery_energy{};  ///< at the battery's terminals, where both places are measured
  SignalGap current_A{}, voltage_V{}, position_m{}, heading_rad{}, battery_W{};
  std::map<std::string, std::pair<double, double>> energy_by_phase_J{};  ///< before, after
};

/// Whether the energy gap or a signal's shrinks by what counts.
[[nodiscard]] inline bool shrinks_notably(const GapReport& gap) {
  const auto shrinks = [](double before, double after) {
    return after < before && is_notable_change(before, after);
  };
  const auto signal = [&](const SignalGap& s) { return s.present && shrinks(s.before_rms, s.after_rms); };
  return shrinks(gap.energy.before_percent, gap.energy.after_percent) || signal(gap.current_A) ||
         signal(gap.voltage_V) || signal(gap.position_m) || signal(gap.heading_rad) || signal(gap.battery_W);
}

/// A run that no model of the other runs describes; nothing else of a diagnosis counts it.
struct RunApart {
  std::string run{};
  double over_model_percent{};  ///< measured energy over what the others' model predicts, less 100 %
  double share_of_gap{};        ///< of the file's model, over all runs
};

struct WhereCell {
  std::string axis{};
  std::string value{};
  double share_of_gap{};
  double energy_J{};
  Range95 interval_95{};
  std::optional<double> bias_percent{};  ///< predicted less measured, of the cell's |measured| energy
};

struct FoundParameter {
  std::string name{};
  double value{};
  Range95 interval_95{};
};

struct Cause {
  EffectSetting effect{};
  double probability{};
  std::vector<std::string> indistinguishable_from{};
  std::vector<FoundParameter> parameters{};
  double energy_share{};
  double shrink_fraction_alone{};
};

/// Two estimates of one fit that depend on each other; the second may be a calibration constant.
struct ParameterCorrelation {
  std::string parameter{};
  std::string other{};
  double correlation{};
};

/// A cause that no law of the catalog stands for: a smooth curve of what was measured.
struct UnknownCause {
  std::string depends_on{};  ///< and where it acts: "wheel speed (current)"
  double probability{};
  double share{};  ///< of what is explained beyond calibration errors, lost without it
};

/// An effect with evidence that changes less than a user would notice.
struct SmallEffect {
  std::string effect{};
  double probability{};
  double evidence{};  ///< natural log of the odds that the data give it
  double size{};      ///< over the materiality floor's
};

struct RankedEffect {
  std::string effect{};
  double probability{};
};

struct NextExperiment {
  std::vector<std::string> separates{};
  std::vector<PrescribedMotion> motions{};  ///< one after the other; empty = nothing to separate
  std::vector<double> payload_kg{};         ///< of each motion
  std::string why{};
  double expected_evidence{};    ///< log-likelihood between the closest pair
  double probability_settled{};  ///< that the run tells the true one from each other one
};

/// What the logs of the user's own simulator (`predicted:`) say: the whole diagnosis is then of the robot
/// against that simulator.
struct SimulatorGap {
  std::size_t runs{};     ///< that it predicts; 0: none, the diagnosis is on the robot file's model
  std::size_t of_runs{};  ///< of the dataset with a usable log
  double gap_percent{}, bias_percent{}, noise_floor_percent{};  ///< of the energy of the measured motion
  Verdict contents{};             ///< of its predictions alone against the robot file's model
  std::vector<Cause> contains{};  ///< effects that it has beyond the robot file
  double velocity_filter_s{};     ///< of the filter behind which its wheel speeds are; 0: none is told
  bool is_another_robots{};       ///< the robot file does not describe what it simulates
  std::size_t by_time{}, by_command{}, by_path{};          ///< runs by what aligns them
  double motion_difference_percent{};                      ///< of the wheel speeds after that, the greatest
  double clock_offset_s{};                                 ///< of its commands, the greatest
  std::vector<std::string> lacking_channels{};             ///< compared with this program's model instead
  Robot robot{};                                           ///< this program's model of what it simulates
  std::map<std::size_t, SimulatorDeviation> deviations{};  ///< of its predictions from that, by run

  /// Whether its gap is more than noise.
  [[nodiscard]] bool exceeds() const {
    return runs > 0 && gap_percent > std::max(noise_floor_percent, 100 * kMaterialEnergy);
  }
};

/// The result of `diagnose`.
struct Diagnosis {
  GapReport gap{};
  SimulatorGap simulator{};
  double velocity_filter_s{};  ///< of the filter behind which the wheel speeds are; 0: none is told
  std::vector<RunApart> runs_apart{};
  std::vector<WhereCell> where{};
  Verdict verdict{Verdict::too_little_data};
  std::vector<Cause> causes{};
  std::vector<RankedEffect> ranking{};
  std::vector<UnknownCause> unknowns{};
  std::vector<SmallEffect> below_materiality{};
  bool leftover_significant{};
  double leftover_share{};
  std::string leftover_description{};
  NextExperiment next{};
  double ceiling_shrink_fraction{};
  std::string control_effect{};
  double control_shrink_fraction{};
  std::string pinned_combination{};
  std::vector<ParameterCorrelation> correlations{};  ///< of the causes' strengths, the strongest first
  std::vector<DataCheck> data_checks{};  ///< channels that contradict physics: nothing else is examined
  std::vector<ForeignConstant> foreign_constants{};  ///< the file's is another robot: no cause is sought
  Isolability isolability{};  ///< of the diagnosis runs; empty where no log can be used
  std::map<std::size_t, double> estimated_payload_kg{};  ///< of runs that state none, by index
  std::vector<std::string> artifacts{};
  std::vector<std::string> missing_channels{};
  std::vector<std::string> notes{};  ///< what the runs cannot show
  std::size_t decision_missions{};   ///< planned with both models; filled by the caller
  double joules_lost_percent{};      ///< by planning with the nominal model
  std::vector<std::string> validation_runs{};
  std::string validation_method{};
  std::optional<Robot> corrected_robot{};          ///< where a correction holds on held-out runs
  std::vector<EffectSetting> corrected_effects{};  ///< that it has beside those of the robot file
  std::vector<EffectSetting> corrected_instruments{};
  std::string refused_correction{};  ///< why a correction that shrinks the gap is not written; empty: none
};

/// Why a robot file with these values would be refused; empty: it reads back.
using RobotRefusal = std::function<std::string(const Robot&)>;

struct DiagnoseOptions {
  std::size_t bootstrap{400};
  RobotRefusal refusal{};           ///< without it every correction counts as one that reads back
  std::set<std::string> without{};  ///< effects taken out of the catalog
};

/// Where the gap lies, which effect of the catalog causes it, how far it shrinks with it. The same
/// dataset gives the same answer to the last bit. Throws ConfigError where no run can be used at all.
[[nodiscard]] Diagnosis diagnose(const Dataset& dataset, const DiagnoseOptions& options = {});

}  // namespace joulepath
