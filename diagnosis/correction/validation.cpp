#include "diagnosis/correction/validation.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/evidence/held_out.hpp"
#include "diagnosis/evidence/materiality.hpp"
#include "diagnosis/thresholds.hpp"
#include "diagnosis/where/gap.hpp"

namespace joulepath {
namespace {

/// Logs without any noise (a simulator's) have no floor to measure.
double finite_or_zero(double value) { return std::isfinite(value) ? value : 0.0; }

/// Gap that the calibrated and corrected model leaves on the runs it was fitted to, but at most
/// what the scatter between runs allows: the error of a wrong model must not count as noise.
double noise_floor_percent(const Examination& x, const Validation& v) {
  const ModelPoint point = x.point_of(v.state);
  const double left = energy_gap_percent(run_energies(v.fitted.signals, point));
  return std::min(left,
                  kScatterFactor * run_scatter_percent(v.fitted.signals, point, x.id.equations.run_variance,
                                                       x.id.equations.noise));
}

/// A constant far outside its uncertainty is an effect: as the rival of a named one it stays within its box.
ModelState within_calibration(const Examination& x, ModelState state) {
  for (std::size_t k = 0; k < x.id.nuisances.size(); ++k) {
    const double most = kCalibrationBox * x.id.nuisances[k].sigma;
    state.nuisance_fraction[k] = std::clamp(state.nuisance_fraction[k], -most, most);
  }
  return state;
}

/// The named effects lower the loss of held-out runs beyond what runs differ among themselves.
bool holds(const Examination& x, const std::vector<double>& base_loss, const ModelState& corrected) {
  const std::vector<double> loss = held_out_losses(x.runs.validation, x.id, corrected);
  double sum = 0, square = 0;
  const auto n = static_cast<double>(loss.size());
  for (std::size_t r = 0; r < loss.size(); ++r) sum += base_loss[r] - loss[r];
  for (std::size_t r = 0; r < loss.size(); ++r) square += std::pow(base_loss[r] - loss[r] - sum / n, 2);
  const double chance = kChanceLoss * x.id.dispersion;
  if (sum > 0 && (loss.size() < kFewHeldOut || sum * sum > square || sum > chance)) return true;
  // Held-out runs that hardly show a certain effect (for example no turn) must only not contradict it.
  return x.best().score > kCertainEvidence && sum > -std::sqrt(square) - chance;
}

/// Without any effect, whether the calibrated model leaves much of the held-out energy; yes if that is
/// unknown.
bool calibration_leaves_a_gap(const Examination& x, const Validation& calibrated) {
  const double left = energy_gap_percent(run_energies(read_signals(x.runs.validation, 0.0),
                                                      x.point_of(within_calibration(x, calibrated.state))));
  const double floor = finite_or_zero(noise_floor_percent(x, calibrated));
  return !(left <= kCautionFactor * std::max(kFloorsLeft * floor, kMaterialGap_percent));
}

/// One or two held-out runs show the scatter between runs as much as the model: twice the leftover counts.
double caution(const Examination& x) {
  return x.runs.validation.runs.size() < kFewHeldOut ? kCautionFactor : 1.0;
}

/// Whether the named effects change the motors' energy at all: others are judged by what they do change.
bool claims_energy(const Examination& x, const Validation& v) {
  ModelState without = v.state;
  without.effects.clear();
  const Impact impact = impact_between(v.fitted.signals, x.point_of(v.state), x.point_of(without));
  return impact.motor_power >= MaterialityFloor{}.motor_power;
}

/// Without voltages, energies rest on the robot file's winding, which is itself under examination.
bool energies_are_measured(const std::vector<RunSignals>& signals) {
  return std::any_of(signals.begin(), signals.end(), [](const RunSignals& run) {
    return run.motor_voltage_V.left.size() > 0 || run.motor_voltage_V.right.size() > 0 ||
           (!measures_motors(run) && measures_energy(run));
  });
}

/// Share of the held-out energy gap above the noise floor that the correction leaves; 0 where what it
/// leaves is small, 1 where it makes things worse than the nominal or the calibrated model.
double unexplained_energy_share(const Examination& x, const std::vector<RunSignals>& before_signals,
                                const ModelState& calibrated, const Validation& v) {
  if (!energies_are_measured(before_signals)) return 0.0;
  const std::vector<RunSignals> after_signals = read_signals(x.runs.validation, channel_delay_s(v.state));
  const double floor = noise_floor_percent(x, v);
  const double before = energy_gap_percent(run_energies(before_signals, x.nominal()));
  const double after = energy_gap_percent(run_energies(after_signals, x.point_of(v.state)));
  const bool claims = claims_energy(x, v);
  if (claims && after > before && x.best().score < kModestEvidence) return 1.0;
  if (after <= caution(x) * std::max(kFloorsLeft * floor, kMaterialGap_percent)) return 0.0;
  const double by_calibration = energy_gap_percent(run_energies(before_signals, x.point_of(calibrated)));
  if (!claims) return after > by_calibration + floor ? 1.0 : 0.0;
  if (after > kToleratedWorsening * std::min(before, by_calibration)) return 1.0;
  const double share = before > floor ? std::clamp((after - floor) / (before - floor), 0.0, 1.0) : 0.0;
  return share > kShareOfWrongForm && after > caution(x) * kFloorsOfWrongForm * floor ? 1.0 : share;
}

/// Withdraws all names and fits the calibration alone.
void withdraw(const Examination& x, Validation& v, const std::string& why) {
  v.judgment.notes.push_back(why);
  v.judgment.named.clear();
  v.state = refit_on_diagnosis(x.runs.diagnosis, x.id, {}, &v.fitted);
}

/// Constants are moved only where that brings the energy of the runs that it was fitted to nearer: an
/// effect that takes no energy of the motors needs none of it.
void keep_constants_that_fit(const Examination& x, Validation& v) {
  ModelState nominal = v.state;
  std::fill(nominal.nuisance_fraction.begin(), nominal.nuisance_fraction.end(), 0.0);
  const auto gap = [&](const ModelState& state) {
    return energy_gap_percent(run_energies(v.fitted.signals, x.point_of(state)));
  };
  if (gap(nominal) < gap(v.state)) v.state = nominal;
}

void fill_floors(const NoiseModel& noise, GapReport& gap) {
  gap.current_A.noise_floor_rms = noise.channel_sd[kCurrentLeft];
  gap.voltage_V.noise_floor_rms = noise.channel_sd[kWindingLeft];
  gap.position_m.noise_floor_rms = noise.channel_sd[kPositionX];
  gap.heading_rad.noise_floor_rms = noise.channel_sd[kHeading];
  gap.battery_W.noise_floor_rms = noise.channel_sd[kDriverPower];
}

}  // namespace

Validation validate(const Examination& x, const Judgment& by_diagnosis_runs) {
  Validation v{.judgment = by_diagnosis_runs};
  Verdict& verdict = v.judgment.verdict;
  const std::vector<ActiveEffect>& named = v.judgment.named;
  const bool leftover_significant = v.judgment.leftover.significant;
  const ModelState calibrated = within_calibration(x, refit_on_diagnosis(x.runs.diagnosis, x.id, {}));
  v.state = refit_on_diagnosis(x.runs.diagnosis, x.id, named, &v.fitted, 2);
  if (!named.empty() && !holds(x, held_out_losses(x.runs.validation, x.id, calibrated), v.state)) {
    withdraw(x, v, "the best explanation does not hold on the held-out runs and was withdrawn");
    verdict = leftover_significant ? Verdict::unexplained : Verdict::no_gap;
  }
  if (!named.empty()) {
    const double share = unexplained_energy_share(x, read_signals(x.runs.validation, 0.0), calibrated, v);
    if (share > kUnexplainedShare) {
      withdraw(x, v, "the best explanation leaves most of the held-out energy gap and was withdrawn");
      const bool modest = x.best().score < kModestEvidence && !leftover_significant;
      verdict = modest ? Verdict::no_gap : Verdict::unexplained;
    } else if (share > 0) {
      verdict = Verdict::partly_explained;
      v.energy_left_share = share;
    }
  }
  if (!named.empty()) keep_constants_that_fit(x, v);
  if (verdict == Verdict::no_gap && calibration_leaves_a_gap(x, v)) {
    verdict = Verdict::unexplained;
    v.judgment.notes.push_back(
        "calibration errors do not explain the gap, and no effect of the catalog holds");
  }
  return v;
}

GapReport held_out_gap(const Examination& x, const Validation& v, std::size_t bootstrap) {
  const bool correct_it = !v.judgment.named.empty();
  const std::vector<RunSignals> before = read_signals(x.runs.validation, 0.0);
  const std::vector<RunSignals> after =
      read_signals(x.runs.validation, correct_it ? channel_delay_s(v.state) : 0.0);
  GapReport gap = measure_gap({.before_signals = before,
                               .after_signals = after,
                               .before = x.nominal(),
                               .after = correct_it ? x.point_of(v.state) : x.nominal(),
                               .noise_floor_percent = finite_or_zero(noise_floor_percent(x, v)),
                               .bootstrap = bootstrap,
                               .fitted_signals = v.fitted.signals});
  if (!correct_it) gap.energy.shrink_interval_95 = {};  // nothing is claimed
  fill_floors(x.id.equations.noise, gap);
  return gap;
}

}  // namespace joulepath
