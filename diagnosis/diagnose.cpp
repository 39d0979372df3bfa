#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/gap.hpp"
#include "diagnosis/groups.hpp"
#include "diagnosis/held_out.hpp"
#include "diagnosis/leftover.hpp"
#include "diagnosis/localize.hpp"
#include "diagnosis/materiality.hpp"
#include "diagnosis/next_run.hpp"
#include "diagnosis/resample.hpp"
#include "diagnosis/split.hpp"
#include "diagnosis/survey.hpp"

namespace joulepath {
namespace {

/// A leftover above this share of what could be explained takes the names away.
constexpr double kUnexplainedShare = 0.45;
constexpr double kSureEnough = 0.6;
constexpr double kCalibrationBox = 3.0;  ///< sigmas that a calibration may be off
/// Runs may come out a little worse on energy while the correction is right.
constexpr double kToleratedWorsening = 1.05;
/// A held-out gap above so many noise floors, and above this share of the energy, is not explained.
constexpr double kFloorsLeft = 2.0;
constexpr double kLeastGapLeft_percent = 2.0;
/// Effects that together come near a foreign cause leave both: a tenth of the gap and many noise floors.
constexpr double kShareOfWrongForm = 0.1;
constexpr double kFloorsOfWrongForm = 10.0;
/// Where nothing is named the bar is higher: the scatter of few rough runs is not well known.
constexpr double kFloorsUnnamed = 4.0;
constexpr double kLeastGapUnnamed_percent = 4.0;
/// A further effect below both shares (of the energy, of the gain) is not named beside a greater one;
/// how likely it is there all the same is anyone's guess.
constexpr double kFormErrorEnergy = 0.02;
constexpr double kFormErrorGain = 0.05;
constexpr double kFormErrorProbability = 0.3;
/// What a wrong model leaves is no noise: the floor is at most so many times the scatter between runs.
constexpr double kScatterFactor = 2.0;

/// One diagnosis under way.
class Examination {
 public:
  Examination(const Dataset& dataset, const DiagnoseOptions& options)
      : dataset_(dataset), options_(options) {}

  Diagnosis run() {
    collect_runs();
    report_.artifacts = artifact_texts(dataset_);
    if (usable_.empty()) return without_logs();
    const RunSplit split = split_runs(dataset_, usable_);
    few_ = usable_.size() < kLeastRuns || split.diagnosis.size() < kLeastRuns - 1;
    diagnosis_ = {.dataset = &dataset_, .runs = few_ ? usable_ : split.diagnosis, .options = sampling()};
    validation_ = {.dataset = &dataset_, .runs = few_ ? usable_ : split.validation, .options = sampling()};
    LogSet all{.dataset = &dataset_, .runs = usable_, .options = sampling()};
    all_signals_ = read_signals(all, 0.0);
    const Survey survey = survey_dataset(dataset_, all_signals_);
    report_.missing_channels = survey.missing_channels;
    report_.notes = survey.notes;

    id_ = identify(diagnosis_);
    nominal_ = {.robot = dataset_.robot};
    report_.where = localize_gap(all_signals_, nominal_, id_.equations.noise, options_.bootstrap);
    choose_names();
    rank();
    judge();
    validate();
    propose_next();
    return std::move(report_);
  }

 private:
  void collect_runs() {
    for (std::size_t r = 0; r < dataset_.runs.size(); ++r)
      if (has_usable_log(dataset_.runs[r])) usable_.push_back(r);
  }

  /// Long logs are thinned out more: rows, not seconds, cost time and memory.
  SignalOptions sampling() const {
    double duration_s = 0;
    for (std::size_t r : usable_)
      duration_s += dataset_.runs[r].log.time_s.back() - dataset_.runs[r].log.time_s.front();
    SignalOptions options;
    options.period_s = std::max(options.period_s, duration_s / 12000.0);
    return options;
  }

  Diagnosis without_logs() {
    report_.verdict = Verdict::too_little_data;
    report_.notes.push_back("no run has a log with wheel speeds: only energies can be compared");
    return std::move(report_);
  }

  /// The best set's effects, less those that may only make up for the inexact form of a greater one.
  void choose_names() {
    probabilities_ = effect_probabilities(id_.equations, id_.explanations);
    std::vector<std::string> doubted;
    for (std::size_t e = 0; e < id_.state.effects.size(); ++e) {
      if (may_be_form_error(e))
        doubted.push_back(id_.state.effects[e].candidate.label());
      else
        named_.push_back(id_.state.effects[e]);
    }
    if (named_.empty()) {  // none is the greater one
      named_ = id_.state.effects;
      return;
    }
    for (const std::string& label : doubted) {
      probabilities_[label] = std::min(probabilities_[label], kFormErrorProbability);
      report_.notes.push_back(
          label + " is not named: small beside a greater effect, it may stand for that one's form");
    }
  }

  /// A further effect of the mechanics with little energy and little of the evidence.
  bool may_be_form_error(std::size_t e) const {
    const ModelState& state = id_.state;
    if (state.effects.size() < 2 || is_instrument(state.effects[e].candidate.shape.name)) return false;
    ModelState without = state;
    without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(e));
    Impact impact = impact_between(id_.signals, model_point(dataset_.robot, id_.nuisances, state),
                                   model_point(dataset_.robot, id_.nuisances, without));
    impact.motor_power = impact.battery_power = 0;  // what is left shows outside the mechanics
    if (materiality(impact) >= 1) return false;
    const EnergyShare energy = energy_of_effect(id_.signals, dataset_.robot, id_.nuisances, state, e);
    if (energy.effect_J > kFormErrorEnergy * energy.total_J) return false;
    return gain_share_of(state.effects[e].candidate.label()) < kFormErrorGain;
  }

  /// Share of the best set's gain in loss that is lost when one of its effects is left out.
  double gain_share_of(const std::string& label) const {
    const Explanation& best = id_.explanations.front();
    const LinearProblem problem =
        without_calibration(id_.equations, every(diagnosis_.runs.size()), id_.dispersion);
    std::vector<int> columns;
    for (int c : best.candidates)
      if (id_.equations.candidates[static_cast<std::size_t>(c)].label() != label)
        for (int k : id_.equations.columns_of_candidate(c, true)) columns.push_back(k);
    const double nothing = solve(problem, {}, id_.dispersion).loss,
                 others = solve(problem, columns, id_.dispersion).loss;
    return nothing > best.loss ? (others - best.loss) / (nothing - best.loss) : 0.0;
  }

  void rank() {
    for (const auto& [label, probability] : probabilities_)
      if (probability > 1e-4) report_.ranking.push_back({label, probability});
    std::stable_sort(
        report_.ranking.begin(), report_.ranking.end(),
        [](const RankedEffect& a, const RankedEffect& b) { return a.probability > b.probability; });
    if (report_.ranking.size() > 12) report_.ranking.resize(12);
  }

  /// Verdict and names, before the held-out runs have a say.
  void judge() {
    const Explanation& best = id_.explanations.front();
    const Leftover leftover = find_leftover(id_, best.columns);
    report_.leftover_significant = leftover.significant;
    report_.leftover_share = leftover.share;
    report_.leftover_description = leftover.description;
    if (few_) {
      report_.verdict = Verdict::too_little_data;
      named_.clear();
      report_.notes.push_back(
          "fewer than " + std::to_string(kLeastRuns) +
          " runs: candidates only; add runs with two payloads, both directions and turns");
    } else if (named_.empty()) {
      report_.verdict = leftover.significant ? Verdict::unexplained : Verdict::no_gap;
    } else if (leftover.significant && leftover.share > kUnexplainedShare) {
      report_.verdict = Verdict::unexplained;
      named_.clear();
    } else {
      report_.verdict = leftover.significant ? Verdict::partly_explained : Verdict::explained;
    }
    bool sure = false;
    for (const ActiveEffect& effect : named_) sure |= probability_of(effect) >= kSureEnough;
    if (!named_.empty() && !sure && report_.verdict == Verdict::explained)
      report_.verdict = Verdict::ambiguous;
  }

  double probability_of(const ActiveEffect& effect) const {
    const auto found = probabilities_.find(effect.candidate.label());
    return found == probabilities_.end() ? 0.0 : (1 - energy_left_share_) * std::min(0.995, found->second);
  }

  /// Fits on the diagnosis runs, judges on the held-out ones, and takes back what does not hold there.
  void validate() {
    for (std::size_t r : validation_.runs) report_.validation_runs.push_back(dataset_.runs[r].name);
    report_.validation_method =
        few_ ? "the same runs: too few to hold any out" : "held-out runs, never used to choose or fit";
    const ModelState calibrated = within_calibration(refit_on_diagnosis(diagnosis_, id_, {}));
    Refit fitted;
    ModelState corrected = refit_on_diagnosis(diagnosis_, id_, named_, &fitted, 2);
    const std::vector<double> base_loss = held_out_losses(validation_, id_, calibrated);
    const auto withdraw = [&](const std::string& why) {
      report_.notes.push_back(why);
      named_.clear();
      corrected = refit_on_diagnosis(diagnosis_, id_, {}, &fitted);
    };
    if (!named_.empty() && !holds(base_loss, corrected)) {
      withdraw("the best explanation does not hold on the held-out runs and was withdrawn");
      report_.verdict = report_.leftover_significant ? Verdict::unexplained : Verdict::no_gap;
    }
    const std::vector<RunSignals> before = read_signals(validation_, 0.0);
    if (!named_.empty()) {
      const double share = unexplained_energy_share(before, fitted, corrected);
      if (share > kUnexplainedShare) {
        withdraw("the best explanation leaves most of the held-out energy gap and was withdrawn");
        report_.verdict = Verdict::unexplained;
      } else if (share > 0) {
        report_.verdict = Verdict::partly_explained;
        energy_left_share_ = share;
      }
    }
    if (report_.verdict == Verdict::no_gap && calibration_leaves_a_gap(fitted, corrected)) {
      report_.verdict = Verdict::unexplained;
      report_.notes.push_back("calibration errors do not make up the gap, and no known effect holds");
    }
    const bool correct_it = !named_.empty();
    const std::vector<RunSignals> after =
        read_signals(validation_, correct_it ? channel_delay_s(corrected) : 0.0);
    const ModelPoint corrected_point = model_point(dataset_.robot, id_.nuisances, corrected);
    report_.gap =
        measure_gap({.before_signals = before,
                     .after_signals = after,
                     .before = nominal_,
                     .after = correct_it ? corrected_point : nominal_,
                     .noise_floor_percent = finite_or_zero(noise_floor_percent(fitted, corrected_point)),
                     .bootstrap = options_.bootstrap});
    fill_floors();
    name_causes(fitted, corrected, before);
    find_control(before);
    if (!correct_it) return;
    const EnergyGap& energy = report_.gap.energy;
    if (energy.after_J > kToleratedWorsening * energy.before_J &&
        energy.after_percent > kFloorsLeft * energy.noise_floor_percent)
      report_.notes.push_back("the correction does not shrink the held-out energy gap: none is written");
    else
      write_correction(corrected);
  }

  /// Gap that the calibrated and corrected model leaves on the runs it was fitted to, yet no more than
  /// the scatter between runs allows: a wrong model must not pass its own error for noise.
  /// Logs without any noise (a simulator's) have no floor to measure.
  static double finite_or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

  double noise_floor_percent(const Refit& fitted, const ModelPoint& corrected) const {
    const double left = energy_gap_percent(run_energies(fitted.signals, corrected));
    return std::min(
        left, kScatterFactor * run_scatter_percent(fitted.signals, corrected, id_.equations.run_variance,
                                                   id_.equations.noise));
  }

  /// A constant that is far out is an effect: as the rival of a named one it stays within its box.
  ModelState within_calibration(ModelState state) const {
    for (std::size_t k = 0; k < id_.nuisances.size(); ++k) {
      const double most = kCalibrationBox * id_.nuisances[k].sigma;
      state.nuisance_fraction[k] = std::clamp(state.nuisance_fraction[k], -most, most);
    }
    return state;
  }

  /// Without any effect, whether the calibrated model leaves much of the held-out energy; yes where nobody
  /// can tell.
  bool calibration_leaves_a_gap(const Refit& fitted, const ModelState& calibrated) const {
    const ModelPoint point = model_point(dataset_.robot, id_.nuisances, calibrated);
    const double left = energy_gap_percent(run_energies(read_signals(validation_, 0.0), point));
    return !(left <= std::max(kFloorsUnnamed * finite_or_zero(noise_floor_percent(fitted, point)),
                              kLeastGapUnnamed_percent));
  }

  /// Share of the held-out energy gap above the noise floor that the correction leaves; 0 where what it
  /// leaves is small, 1 where it makes things worse.
  double unexplained_energy_share(const std::vector<RunSignals>& before_signals, const Refit& fitted,
                                  const ModelState& corrected) const {
    const ModelPoint point = model_point(dataset_.robot, id_.nuisances, corrected);
    const std::vector<RunSignals> after_signals = read_signals(validation_, channel_delay_s(corrected));
    const double floor = noise_floor_percent(fitted, point);
    const double before = energy_gap_percent(run_energies(before_signals, nominal_));
    const double after = energy_gap_percent(run_energies(after_signals, point));
    if (after <= std::max(kFloorsLeft * floor, kLeastGapLeft_percent)) return 0.0;
    if (after > kToleratedWorsening * before) return 1.0;
    const double share = before > floor ? std::clamp((after - floor) / (before - floor), 0.0, 1.0) : 0.0;
    return share > kShareOfWrongForm && after > kFloorsOfWrongForm * floor ? 1.0 : share;
  }

  /// The named effects lower the loss of held-out runs beyond what runs differ among themselves.
  bool holds(const std::vector<double>& base_loss, const ModelState& corrected) const {
    const std::vector<double> loss = held_out_losses(validation_, id_, corrected);
    double sum = 0, square = 0;
    const auto n = static_cast<double>(loss.size());
    for (std::size_t r = 0; r < loss.size(); ++r) sum += base_loss[r] - loss[r];
    for (std::size_t r = 0; r < loss.size(); ++r) square += std::pow(base_loss[r] - loss[r] - sum / n, 2);
    return sum > 0 && (n < 3 || sum * sum > square * 1.0 || sum > 6 * id_.dispersion);
  }

  void fill_floors() {
    const NoiseModel& noise = id_.equations.noise;
    report_.gap.current_A.noise_floor_rms = noise.channel_sd[kCurrentLeft];
    report_.gap.voltage_V.noise_floor_rms = noise.channel_sd[kWindingLeft];
    report_.gap.position_m.noise_floor_rms = noise.channel_sd[kPositionX];
    report_.gap.heading_rad.noise_floor_rms = noise.channel_sd[kHeading];
    report_.gap.battery_W.noise_floor_rms = noise.channel_sd[kDriverPower];
  }

  void name_causes(const Refit& fitted, const ModelState& corrected, const std::vector<RunSignals>& before) {
    const Explanation& best = id_.explanations.front();
    const double base_J = report_.gap.energy.before_J;
    double impact_sum = 0;
    std::vector<double> impacts;
    for (std::size_t e = 0; e < named_.size(); ++e) {
      impacts.push_back(
          energy_of_effect(fitted.signals, dataset_.robot, id_.nuisances, corrected, e).effect_J);
      impact_sum += impacts.back();
    }
    for (std::size_t e = 0; e < named_.size(); ++e) {
      const ActiveEffect& effect = corrected.effects[e];
      Cause cause{.effect = setting_of(effect.candidate, effect.amplitude, dataset_.robot),
                  .probability = probability_of(effect),
                  .energy_share = impact_sum > 0 ? impacts[e] / impact_sum : 0.0};
      for (int c : best.candidates) {
        const std::string label = id_.equations.candidates[static_cast<std::size_t>(c)].label();
        if (label != effect.candidate.label()) continue;
        cause.indistinguishable_from = stand_ins(id_.equations, id_.explanations, c);
        if (!cause.indistinguishable_from.empty() && report_.pinned_combination.empty())
          report_.pinned_combination = pinned_combination(
              without_calibration(id_.equations, every(diagnosis_.runs.size()), id_.dispersion),
              id_.equations, best, label, cause.indistinguishable_from.front(), id_.dispersion);
      }
      cause.parameters = parameters_of(fitted, e);
      const ModelState alone = refit_on_diagnosis(diagnosis_, id_, {effect});
      const std::vector<RunSignals> signals =
          channel_delay_s(alone) == 0 ? before : read_signals(validation_, channel_delay_s(alone));
      double after_J = 0;
      for (const RunEnergy& run : run_energies(signals, model_point(dataset_.robot, id_.nuisances, alone)))
        after_J += std::abs(run.gap_J());
      cause.shrink_fraction_alone = base_J > 0 ? 1 - after_J / base_J : 0.0;
      report_.causes.push_back(std::move(cause));
    }
    std::stable_sort(report_.causes.begin(), report_.causes.end(),
                     [](const Cause& a, const Cause& b) { return a.energy_share > b.energy_share; });
  }

  std::vector<FoundParameter> parameters_of(const Refit& fitted, std::size_t effect) const {
    const ActiveEffect& active = fitted.state.effects[effect];
    const EffectSetting setting = setting_of(active.candidate, active.amplitude, dataset_.robot);
    std::vector<FoundParameter> found;
    for (const ParameterDescription& parameter : find_effect(setting.name)->parameters) {
      const auto at = setting.parameters.find(parameter.name);
      if (at == setting.parameters.end()) continue;
      const double sd = parameter_sd(fitted, effect, parameter.name);
      Range95 interval{at->second - 1.96 * sd, at->second + 1.96 * sd};
      if (setting.name == "wheel_slip") {  // symmetric in the compliance
        const double compliance = 1 / at->second;
        interval = {1 / (compliance + 1.96 * sd), 1 / std::max(1e-9, compliance - 1.96 * sd)};
      }
      found.push_back({parameter.name, at->second, interval});
    }
    return found;
  }

  /// Standard deviation of a parameter from the refit's covariance.
  double parameter_sd(const Refit& fitted, std::size_t effect, const std::string& name) const {
    const ActiveEffect& active = fitted.state.effects[effect];
    std::vector<Eigen::Index> rows;
    const std::vector<std::string> shapes = shape_parameters(active.candidate.shape.name);
    for (std::size_t i = 0; i < fitted.columns.size(); ++i) {
      const Column& column = fitted.equations.columns[static_cast<std::size_t>(fitted.columns[i])];
      if (column.kind == Column::Kind::nuisance || column.owner != static_cast<int>(effect)) continue;
      const bool shape =
          column.kind == Column::Kind::shape && shapes[static_cast<std::size_t>(column.part)] == name;
      const bool amplitude = column.kind == Column::Kind::amplitude &&
                             std::find(shapes.begin(), shapes.end(), name) == shapes.end();
      if (shape || amplitude) rows.push_back(static_cast<Eigen::Index>(i));
    }
    if (rows.empty()) return 0.05;  // an edge of a floor patch: half a step of the scan
    if (active.candidate.shape.name != "floor_slope") return std::sqrt(fitted.covariance(rows[0], rows[0]));
    const double x = active.amplitude[0], y = active.amplitude[1], grade = std::max(1e-9, std::hypot(x, y));
    const bool direction = name != "grade";
    const double gx = direction ? -y / (grade * grade) : x / grade,
                 gy = direction ? x / (grade * grade) : y / grade;
    return std::sqrt(std::max(0.0, gx * gx * fitted.covariance(rows[0], rows[0]) +
                                       gy * gy * fitted.covariance(rows[1], rows[1]) +
                                       2 * gx * gy * fitted.covariance(rows[0], rows[1])));
  }

  /// A wrong candidate fitted the same way, and the most flexible model: what the shrink is held against.
  void find_control(const std::vector<RunSignals>& before) {
    const double base_J = report_.gap.energy.before_J;
    report_.ceiling_shrink_fraction =
        base_J > 0 ? std::clamp(1 - report_.gap.energy.noise_floor_percent /
                                        std::max(1e-9, report_.gap.energy.before_percent),
                                0.0, 1.0)
                   : 0.0;
    if (named_.empty()) return;
    std::set<std::string> spoken_for;
    for (const Cause& cause : report_.causes) {
      for (const std::string& label : cause.indistinguishable_from) spoken_for.insert(label);
    }
    for (const ActiveEffect& effect : named_) spoken_for.insert(effect.candidate.label());
    for (const Explanation& e : id_.explanations) {
      if (e.candidates.size() != 1) continue;
      const Candidate& candidate = id_.equations.candidates[static_cast<std::size_t>(e.candidates.front())];
      if (spoken_for.contains(candidate.label()) || candidate.shape.name == "time_misalignment") continue;
      std::vector<double> amplitude;
      for (std::size_t k = 0; k < e.columns.size() && amplitude.size() < candidate.amplitude.size(); ++k)
        amplitude.push_back(e.mean[static_cast<Eigen::Index>(k)]);
      const ModelState wrong = refit_on_diagnosis(diagnosis_, id_, {{candidate, amplitude}});
      double after_J = 0;
      for (const RunEnergy& run : run_energies(before, model_point(dataset_.robot, id_.nuisances, wrong)))
        after_J += std::abs(run.gap_J());
      report_.control_effect = candidate.label();
      report_.control_shrink_fraction = base_J > 0 ? 1 - after_J / base_J : 0.0;
      return;
    }
  }

  /// The robot as it seems to be: calibration constants moved, effects added.
  void write_correction(const ModelState& corrected) {
    ModelState constants = corrected;
    constants.effects.clear();
    Robot robot = model_point(dataset_.robot, id_.nuisances, constants).robot;
    bool physical = false;
    for (const ActiveEffect& effect : corrected.effects) {
      const EffectSetting setting = setting_of(effect.candidate, effect.amplitude, dataset_.robot);
      if (is_instrument(setting.name))
        report_.corrected_instruments.push_back(setting);
      else
        robot.effects.push_back(setting), physical = true;
    }
    if (physical) report_.corrected_robot = robot;
  }

  void propose_next() {
    std::vector<std::string> rivals;
    for (const Cause& cause : report_.causes)
      if (!cause.indistinguishable_from.empty()) {
        rivals.push_back(cause.effect.name);
        for (const std::string& label : cause.indistinguishable_from) rivals.push_back(label);
      }
    report_.next = propose_run(id_, dataset_.robot, rivals, report_.ranking, report_.verdict);
  }

  static std::vector<std::size_t> every(std::size_t count) {
    std::vector<std::size_t> indices(count);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    return indices;
  }

  const Dataset& dataset_;
  DiagnoseOptions options_;
  Diagnosis report_{};
  std::vector<std::size_t> usable_{};
  bool few_{};
  LogSet diagnosis_{}, validation_{};
  std::vector<RunSignals> all_signals_{};
  Identification id_{};
  ModelPoint nominal_{};
  std::map<std::string, double> probabilities_{};
  std::vector<ActiveEffect> named_{};
  double energy_left_share_{};  ///< of the held-out gap, where the names explain a part only
};

}  // namespace

Diagnosis diagnose(const Dataset& dataset, const DiagnoseOptions& options) {
  return Examination(dataset, options).run();
}

}  // namespace joulepath
