#include "diagnosis/next_run/next_run.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "diagnosis/evidence/power.hpp"
#include "diagnosis/next_run/manoeuvres.hpp"
#include "diagnosis/next_run/rivals.hpp"
#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/config_error.hpp"
#include "model/effects/effect_label.hpp"
#include "model/kinematics.hpp"
#include "model/limit_table.hpp"
#include "model/motions.hpp"
#include "model/sampled_motion.hpp"
// Design: docs/decisions/0508-what-runs-can-show.md
namespace joulepath {
namespace {

constexpr double kLimitRounding = 1e-6;  ///< relative, of motions that were cut to limits

/// What limits a further run.
struct Circumstances {
  double heaviest_kg{};
  double time_of_day_s{};
  SignalOptions sampling{};
};

Circumstances circumstances_of(const Identification& id, const Robot& robot) {
  const double limit_kg = payload_limit_kg(robot);
  Circumstances c{.heaviest_kg = std::isfinite(limit_kg) ? limit_kg : 0.0};
  for (const RunSignals& run : id.signals) {
    if (run.size() == 0) continue;
    c.heaviest_kg = std::max(c.heaviest_kg, run.payload_kg.maxCoeff());
    c.time_of_day_s = std::max(c.time_of_day_s, run.time_of_day_s.maxCoeff());
    c.sampling.period_s = run.period_s;
  }
  return c;
}

/// Whether motors, battery and tires can drive it. A jerk limit is left out: motions of constant
/// accelerations keep none.
bool is_drivable(const Robot& robot, const Trajectory& motion) {
  const Plant plant = make_plant(robot);
  bool within_limits = true;
  for (std::size_t k = 0; k + 1 < motion.size() && within_limits; ++k) {
    const SampledState state = sampled_state(motion, std::midpoint(motion.time_s[k], motion.time_s[k + 1]));
    const BodyMotion<double>& body = state.motion;
    const double payload_kg = motion.payload_kg[k + 1],
                 gain_m_s2 = std::copysign(1.0, body.speed_m_s) * body.acceleration_m_s2;
    const Site site = site_of(robot.geometry, state.pose, payload_kg, body.speed_m_s, body.yaw_rate_rad_s);
    for_each_limit(limit_state(plant, body, site, gain_m_s2, 0.0), limits_for_payload(robot, payload_kg),
                   [&](const Limit&, double value, double limit) {
                     within_limits &= limit_fraction(value, limit) <= 1 + kLimitRounding;
                   });
  }
  return within_limits;
}

RunSignals signals_of(const Trajectory& motion, const Robot& robot, const Circumstances& circumstances) {
  const Run run{
      .name = "proposed", .log = motion, .payload_known = true, .start_time_s = circumstances.time_of_day_s};
  return make_run_signals(run, 0, robot, circumstances.sampling);
}

/// A manoeuvre within the robot's limits, and what it would tell.
struct Trial {
  Manoeuvre manoeuvre{};
  std::vector<PrescribedMotion> motions{};
  std::vector<double> payload_kg{};  ///< of each motion
  double least_ratio{-1.0};  ///< expected 2 ln LR between the closest pair; negative: it cannot be driven
  double probability_settled{};
};

Trial tried(const Identification& id, const Robot& robot, const std::vector<Rival>& rivals,
            const Circumstances& circumstances, const Manoeuvre& manoeuvre) {
  Trial trial{.manoeuvre = manoeuvre};
  try {
    for (std::size_t k = 0; k < manoeuvre.motions.size(); ++k) {
      trial.payload_kg.push_back(manoeuvre.loads[k] * circumstances.heaviest_kg);
      trial.motions.push_back(
          within(limits_for_payload(robot, trial.payload_kg.back()), manoeuvre.motions[k]));
    }
    const Trajectory drive =
        timed_motion(robot, trial.motions, {.payload_of_motion_kg = trial.payload_kg}).trajectory;
    if (!is_drivable(robot, drive)) return trial;
    const RunSignals motion = signals_of(drive, robot, circumstances);
    double least = 1e300, settled = 0;
    for (const Rival& truth : rivals) {
      const RunSignals shown = expected_signals(id, robot, motion, truth);
      double surest = 1;
      for (const Rival& other : rivals) {
        if (&other == &truth) continue;
        const double ratio = expected_ratio(id, robot, shown, other);
        least = std::min(least, ratio);
        surest = std::min(surest, probability_told_apart(ratio, other.loss - truth.loss));
      }
      settled += surest / static_cast<double>(rivals.size());
    }
    trial.least_ratio = least;
    trial.probability_settled = settled;
  } catch (const ConfigError&) {
    trial.least_ratio = -1;  // the robot's limits do not allow the manoeuvre
  }
  return trial;
}

/// The best of some manoeuvres, the first one of equals. A robot that carries nothing drives none twice.
Trial best_of(const Identification& id, const Robot& robot, const std::vector<Rival>& rivals,
              const Circumstances& circumstances, std::vector<Manoeuvre> manoeuvres) {
  if (circumstances.heaviest_kg == 0)
    std::erase_if(manoeuvres, [](const Manoeuvre& manoeuvre) { return manoeuvre.loads.back() > 0; });
  std::vector<Trial> trials(manoeuvres.size());
  parallel_for(trials.size(),
               [&](std::size_t k) { trials[k] = tried(id, robot, rivals, circumstances, manoeuvres[k]); });
  return *std::ranges::max_element(trials, {}, &Trial::least_ratio);
}

/// Effects that the present runs leave open: of the first group, else the likeliest ones of an open verdict.
std::vector<std::string> open_labels(const std::vector<Cause>& causes,
                                     const std::vector<RankedEffect>& ranking, Verdict verdict) {
  std::vector<std::string> labels;
  for (const Cause& cause : causes) {
    if (cause.indistinguishable_from.empty()) continue;
    labels.push_back(effect_label(cause.effect));
    std::ranges::copy(cause.indistinguishable_from, std::back_inserter(labels));
    break;
  }
  if (labels.empty() && (verdict == Verdict::ambiguous || verdict == Verdict::too_little_data))
    for (const RankedEffect& ranked : ranking)
      if (labels.size() < kMostOpenEffects) labels.push_back(ranked.effect);
  if (labels.size() > kMostSeparated) labels.resize(kMostSeparated);
  return labels;
}

}  // namespace

NextExperiment propose_run(const Identification& id, const Robot& robot, const std::vector<Cause>& causes,
                           const std::vector<RankedEffect>& ranking, Verdict verdict) {
  const std::vector<Rival> rivals = fitted_rivals(id, robot, open_labels(causes, ranking, verdict));
  if (rivals.size() < 2) return {};
  const Circumstances circumstances = circumstances_of(id, robot);
  Trial best = best_of(id, robot, rivals, circumstances, manoeuvre_library(robot));
  for (int round = 0; round < kRunRefinements && best.least_ratio > 0; ++round) {
    const Trial changed = best_of(id, robot, rivals, circumstances, variants_of(best.manoeuvre));
    if (changed.least_ratio <= best.least_ratio) break;
    best = changed;
  }
  NextExperiment next;
  for (const Rival& rival : rivals) next.separates.push_back(rival.label);
  if (best.least_ratio <= 0) return next;
  next.motions = best.motions;
  next.payload_kg = best.payload_kg;
  next.why = best.manoeuvre.why;
  if (best.payload_kg.front() != best.payload_kg.back())
    next.why += "; payload, taken on at the standstill between, shows what grows with the load";
  else if (best.payload_kg.front() > 0)
    next.why += "; payload shows what grows with the load";
  next.expected_evidence = 0.5 * best.least_ratio;
  next.probability_settled = best.probability_settled;
  return next;
}

}  // namespace joulepath
