#include "diagnosis/next_run/next_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "model/config_error.hpp"
#include "model/limit_table.hpp"
#include "model/motions.hpp"

namespace joulepath {
namespace {

/// A safe manoeuvre and its purpose.
struct Manoeuvre {
  std::string why{};
  std::vector<PrescribedMotion> motions{};
  double load{};  ///< share of the greatest payload
};

double usual_speed_m_s(const Robot& robot) {
  const double limit = robot.limits ? robot.limits->speed_m_s : kNoLimit;
  return std::isfinite(limit) ? 0.6 * limit : 0.5;
}

PrescribedMotion straight(double speed_m_s, double distance_m, double acceleration_m_s2, bool reverse) {
  PrescribedMotion motion{.profile = MotionProfile::trapezoid};
  motion.speed_m_s = speed_m_s;
  motion.distance_m = distance_m;
  motion.acceleration_m_s2 = acceleration_m_s2;
  motion.reverse = reverse;
  return motion;
}

PrescribedMotion spin(double angle_rad, double yaw_rate_rad_s) {
  PrescribedMotion motion{.profile = MotionProfile::spin};
  motion.angle_rad = angle_rad;
  motion.yaw_rate_rad_s = yaw_rate_rad_s;
  motion.yaw_acceleration_rad_s2 = 1.0;
  return motion;
}

PrescribedMotion arc(double radius_m, double angle_rad, double speed_m_s) {
  PrescribedMotion motion{.profile = MotionProfile::arc};
  motion.radius_m = radius_m;
  motion.angle_rad = angle_rad;
  motion.speed_m_s = speed_m_s;
  motion.acceleration_m_s2 = 0.25;
  return motion;
}

PrescribedMotion stand(double duration_s) {
  PrescribedMotion motion{.profile = MotionProfile::stand};
  motion.duration_s = duration_s;
  return motion;
}

std::vector<Manoeuvre> library(const Robot& robot) {
  const double v = usual_speed_m_s(robot), pi = std::numbers::pi;
  return {
      {"a standstill shows the power and the sensor readings without motion", {stand(20)}, 0},
      {"the same lane in both directions separates losses that depend on the direction from others",
       {straight(v, 3, 0.25, false), stand(1), straight(v, 3, 0.25, true)},
       0},
      {"the same lane with the greatest payload shows losses that grow with the load",
       {straight(v, 3, 0.25, false), stand(1), straight(v, 3, 0.25, true)},
       1},
      {"spins in both directions show the resistance to turning without travel",
       {spin(2 * pi, 0.8), stand(1), spin(-2 * pi, 0.8)},
       0},
      {"spins with the greatest payload separate resistance to turning that grows with the load from "
       "constant resistance",
       {spin(2 * pi, 0.8), stand(1), spin(-2 * pi, 0.8)},
       1},
      {"arcs in both directions show losses that grow with speed times yaw rate",
       {arc(0.8, pi, v), stand(1), arc(0.8, -pi, v)},
       1},
      {"a crawl shows friction that decreases with speed",
       {straight(0.1 * v, 0.5, 0.25, false), stand(1), straight(0.25 * v, 1, 0.25, false)},
       0},
      {"a fast run separates losses that are linear in speed from losses that are quadratic",
       {straight(1.5 * v, 8, 0.4, false)},
       0},
      {"hard starts and stops show effects of acceleration",
       {straight(v, 1.5, 0.5, false), straight(v, 1.5, 0.5, true), straight(v, 1.5, 0.5, false)},
       1},
  };
}

void cap(std::optional<double>& value, double limit) {
  if (value) value = std::min(*value, limit);
}

/// The manoeuvre's motions, slower where the robot's limits with this payload require it. An arc of radius r
/// at speed v has lateral acceleration v^2/r, yaw rate v/r and yaw acceleration a/r.
std::vector<PrescribedMotion> within(const Limits& limits, std::vector<PrescribedMotion> motions) {
  for (PrescribedMotion& motion : motions) {
    cap(motion.speed_m_s, limits.speed_m_s);
    cap(motion.acceleration_m_s2, std::min(limits.acceleration_m_s2, limits.deceleration_m_s2));
    cap(motion.yaw_rate_rad_s, limits.yaw_rate_rad_s);
    cap(motion.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2);
    if (!motion.radius_m) continue;
    cap(motion.speed_m_s, std::min(limits.yaw_rate_rad_s * *motion.radius_m,
                                   std::sqrt(limits.lateral_acceleration_m_s2 * *motion.radius_m)));
    cap(motion.acceleration_m_s2, limits.yaw_acceleration_rad_s2 * *motion.radius_m);
  }
  return motions;
}

RunSignals signals_of(const std::vector<PrescribedMotion>& motions, const Robot& robot, double payload_kg,
                      double time_of_day_s) {
  const TimedMotion timed = timed_motion(robot, motions, {.payload_kg = payload_kg});
  Run run{.name = "proposed", .log = timed.trajectory, .payload_known = true, .start_time_s = time_of_day_s};
  run.log.payload_kg.assign(run.log.size(), payload_kg);
  // Currents and voltages count as present: the proposed run will measure them.
  for (Side side : kSides) {
    run.log.motor_current_A[side].assign(run.log.size(), 0.0);
    run.log.motor_voltage_V[side].assign(run.log.size(), 0.0);
  }
  return make_run_signals(run, 0, robot);
}

/// The state with one candidate only, fitted to the present data.
std::optional<ModelState> fitted_state(const Identification& id, const std::string& label) {
  for (const Explanation& e : id.explanations) {
    if (e.candidates.size() != 1) continue;
    const Candidate& candidate = id.equations.candidates[static_cast<std::size_t>(e.candidates[0])];
    if (candidate.label() != label) continue;
    std::vector<std::size_t> runs(id.equations.runs.size());
    std::iota(runs.begin(), runs.end(), std::size_t{0});
    const Eigen::VectorXd parameters = fit_parameters(id.equations, runs, e.columns, id.dispersion);
    return adopt(id.equations, id.nuisances, {.nuisance_fraction = id.state.nuisance_fraction}, e,
                 parameters);
  }
  return std::nullopt;
}

/// Expected log evidence between two models: half the squared difference of their predictions in units of the
/// noise.
double evidence_between(const Identification& id, const Robot& robot, const RunSignals& signals,
                        const ModelState& a, const ModelState& b) {
  const ModelPoint first = model_point(robot, id.nuisances, a), second = model_point(robot, id.nuisances, b);
  const Prediction p = predict(signals, first), q = predict(signals, second);
  const ResidualRows rows = residual_rows(signals, first, p);
  const Whitener whiten(id.equations.noise, rows.present);
  return 0.5 * whiten(signature_rows(signals, first, p, q)).squaredNorm() / id.dispersion;
}

/// Effects that the next run is to separate: the members of each group, else the first of the ranking.
std::vector<std::string> rivals_of(const std::vector<Cause>& causes, const std::vector<RankedEffect>& ranking,
                                   Verdict verdict) {
  std::vector<std::string> rivals;
  for (const Cause& cause : causes) {
    if (cause.indistinguishable_from.empty()) continue;
    rivals.push_back(cause.effect.name);
    rivals.insert(rivals.end(), cause.indistinguishable_from.begin(), cause.indistinguishable_from.end());
  }
  if (rivals.empty() && (verdict == Verdict::ambiguous || verdict == Verdict::too_little_data))
    for (const RankedEffect& ranked : ranking)
      if (rivals.size() < 3) rivals.push_back(ranked.effect);
  return rivals;
}

double heaviest_payload_kg(const Identification& id, const Robot& robot) {
  const double limit_kg = payload_limit_kg(robot);
  double heaviest_kg = std::isfinite(limit_kg) ? limit_kg : 0.0;
  for (const RunSignals& run : id.signals) heaviest_kg = std::max(heaviest_kg, run.payload_kg.maxCoeff());
  return heaviest_kg;
}

/// Expected log evidence between the two states that a run separates least.
double least_evidence(const Identification& id, const Robot& robot, const RunSignals& signals,
                      const std::vector<ModelState>& states) {
  double least = 1e300;
  for (std::size_t a = 0; a < states.size(); ++a)
    for (std::size_t b = a + 1; b < states.size(); ++b)
      least = std::min(least, evidence_between(id, robot, signals, states[a], states[b]));
  return least;
}

}  // namespace

RunSignals ideal_signals(const PrescribedMotion& motion, const Robot& robot, double payload_kg,
                         double time_of_day_s) {
  return signals_of({motion}, robot, payload_kg, time_of_day_s);
}

NextExperiment propose_run(const Identification& id, const Robot& robot, const std::vector<Cause>& causes,
                           const std::vector<RankedEffect>& ranking, Verdict verdict) {
  NextExperiment next;
  std::vector<ModelState> states;
  for (const std::string& label : rivals_of(causes, ranking, verdict))
    if (std::optional<ModelState> state = fitted_state(id, label)) {
      states.push_back(std::move(*state));
      next.separates.push_back(label);
    }
  if (states.size() < 2) return {};
  const double heaviest_kg = heaviest_payload_kg(id, robot);
  for (const Manoeuvre& manoeuvre : library(robot)) {
    try {
      const double payload_kg = manoeuvre.load * heaviest_kg;
      const std::vector<PrescribedMotion> motions =
          within(limits_for_payload(robot, payload_kg), manoeuvre.motions);
      const double evidence = least_evidence(id, robot, signals_of(motions, robot, payload_kg, 0.0), states);
      if (evidence <= next.expected_evidence) continue;
      next.expected_evidence = evidence;
      next.motions = motions;
      next.payload_kg = payload_kg;
      next.why = manoeuvre.why;
    } catch (const ConfigError&) {
      continue;  // the robot's limits do not allow the manoeuvre
    }
  }
  return next;
}

}  // namespace joulepath
