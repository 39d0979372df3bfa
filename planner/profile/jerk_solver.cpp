#include "planner/profile/jerk_solver.hpp"

#include <algorithm>
#include <cmath>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/fast/jerk_fast_solver.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/profile/dense_check.hpp"
#include "planner/profile/first_guess.hpp"
#include "planner/profile/solve_tolerances.hpp"

namespace joulepath {
namespace {

constexpr int kJerkRounds = 14;      ///< of tightening and refinement
constexpr int kJerkSharpenings = 4;  ///< of the grid at the switches of least time
constexpr double kNoOtherMotion =
    1e-4;  ///< a deadline this close to the least time may permit no other motion
constexpr double kLargestAcceleration_m_s2 = 20;  ///< if nothing limits it
constexpr double kWorthACut = 0.1;                ///< share of the largest misfit

/// Cost of each segment as the program counts it.
std::vector<double> counted_energy_J(const nlp::Problem& problem, const nlp::JerkMotion& motion) {
  std::vector<double> energy_J;
  for (std::size_t k = 0; k < problem.segment_count(); ++k)
    energy_J.push_back(nlp::kept_energy_J(nlp::JerkInterval<double>{
        problem.segments[k], motion.u[k], motion.a[k], motion.u[k + 1], motion.a[k + 1], motion.dt[k]}));
  return energy_J;
}

/// The motion in `factor` times the time. From rest to rest it keeps every limit on motion that the original
/// keeps.
nlp::JerkMotion slowed(nlp::JerkMotion motion, double factor) {
  for (double& u : motion.u) u /= factor;
  for (double& a : motion.a) a /= factor * factor;
  for (double& dt : motion.dt) dt *= factor;
  return motion;
}

/// Adds nodes at rest ends, where the grid ignores jerk: halved times (s grows with t^3) down to the time in
/// which jerk builds up the acceleration.
std::vector<double> with_graded_ends(std::vector<double> s, const ProfileRequest& request) {
  const Limits& limits = request.limits;
  const double a = std::min({limits.acceleration_m_s2, limits.deceleration_m_s2, kLargestAcceleration_m_s2});
  const double ramp_m = std::max(a * a * a / (6 * limits.jerk_m_s3 * limits.jerk_m_s3), 1e-9 * s.back());
  const double first_m = s[1], last_m = s.back() - s[s.size() - 2], length_m = s.back();
  if (request.start_rate == 0)
    for (double at_m = first_m / 8; at_m > ramp_m / 8; at_m /= 8) s.push_back(at_m);
  if (request.end_rate == 0)
    for (double at_m = last_m / 8; at_m > ramp_m / 8; at_m /= 8) s.push_back(length_m - at_m);
  std::sort(s.begin(), s.end());
  return s;
}

class JerkSolver {
 public:
  explicit JerkSolver(const ProfileRequest& request) : request_(request), motion_(path_motion(request)) {}

  ProfileResult solve() {
    s_ = with_graded_ends(
        nlp::make_grid(motion_, request_, std::clamp<std::size_t>(request_.nodes, 4, 100000)), request_);
    double worst_ratio = 0;
    bool solved = false;
    for (int round = 0; round < kJerkRounds; ++round) {
      if (!optimize() && !by_way_of_minimum_time()) break;
      solved = true;
      const nlp::DenseCheck check = nlp::check_densely(
          *problem_, motion_, *best_, counted_energy_J(*problem_, found_.motion), request_.accuracy);
      const bool accurate =
          check.energy_error_J <= request_.accuracy * std::max(1e-9, std::abs(check.energy_J));
      const bool within = check.worst_ratio <= 1 + kLimitTolerance;
      if (within) keep();
      std::vector<bool> cut = check.cut;
      if (!sharpen(cut) && within && accurate) {
        if (must_polish()) polish();
        break;
      }
      worst_ratio = check.worst_ratio;
      tightenings_.insert(tightenings_.end(), check.tighten.begin(), check.tighten.end());
      s_ = nlp::cut_segments(s_, cut);
    }
    if (incumbent_) {
      incumbent_->summary.status = SolveStatus::feasible;
      return std::move(*incumbent_);
    }
    if (solved)
      result_.summary.message =
          "limits do not settle between nodes (worst use " + std::to_string(worst_ratio) + ")";
    return result_;
  }

 private:
  bool minimum_time() const { return request_.time.mode == TimeMode::minimum_time; }

  void keep() {
    incumbent_ = result_;
    incumbent_->profile = best_;
  }

  /// The fast solver finds the grid; if Ipopt is requested, it solves again on that grid.
  bool must_polish() const {
    return request_.solver == SolverChoice::ipopt && result_.summary.solver == std::string("fast");
  }

  /// Runs Ipopt from the fast solver's solution on the same grid; its result is used if it keeps the limits.
  void polish() {
    if (!take(nlp::solve_with_ipopt(program(found_.motion), {.warm = true}), "ipopt")) return;
    const nlp::DenseCheck check = nlp::check_densely(
        *problem_, motion_, *best_, counted_energy_J(*problem_, found_.motion), request_.accuracy);
    if (check.worst_ratio <= 1 + kLimitTolerance) keep();
  }

  /// Jerk switches at places between the nodes: cuts the segments there as long as that lowers the objective.
  /// False when it no longer does. The least time consists of switches only and decides about deadlines, so
  /// it gets more cuts.
  bool sharpen(std::vector<bool>& cut) {
    if (sharpened_ == kJerkSharpenings) return false;
    const double worth = (minimum_time() ? 0.05 : 1.0) * request_.accuracy * std::abs(found_.objective);
    const bool gains = found_.objective < least_objective_ - worth;
    least_objective_ = std::min(least_objective_, found_.objective);
    if (!gains) return false;
    ++sharpened_;
    const nlp::JerkMotion& motion = found_.motion;
    std::vector<double> misfit(cut.size(), 0.0);  // of the rate, for a switch of jerk within the segment
    for (std::size_t k = 0; k + 1 < cut.size(); ++k) {
      const double jump = std::abs(best_->jerk[k + 1] - best_->jerk[k]);
      for (std::size_t at : {k, k + 1})
        misfit[at] = std::max(misfit[at], jump * motion.dt[at] * motion.dt[at]);
    }
    const double most = *std::max_element(misfit.begin(), misfit.end());
    for (std::size_t k = 0; k < cut.size(); ++k)
      if (misfit[k] > kWorthACut * most) cut[k] = true;
    return true;
  }

  bool optimize() {
    transcribe();
    if (best_ && take(nlp::solve_fast(program(resampled(*best_)), nlp::JerkStart::near), "fast")) return true;
    const nlp::RateEnvelope envelope = nlp::rate_envelope(*problem_);
    if (envelope.blocked) {
      result_.summary.message = "no profile passes " + std::string(envelope.blocked->limit);
      return false;
    }
    const nlp::JerkMotion guess = from_envelope(envelope);
    if (take(nlp::solve_fast(program(guess)), "fast")) return true;
    if (is_too_soon()) return false;
    if (request_.solver == SolverChoice::fast) result_.summary.handed_over = result_.summary.message;
    if (best_ && take(nlp::solve_with_ipopt(program(resampled(*best_)), {.warm = true}), "ipopt"))
      return true;
    return take(nlp::solve_with_ipopt(program(guess)), "ipopt");
  }

  nlp::JerkProgram program(nlp::JerkMotion guess) const {
    return {*problem_, tightenings_, std::move(guess)};
  }

  void transcribe() {
    problem_ = nlp::transcribe(request_, motion_, s_, tightenings_, best_ ? &*best_ : nullptr);
    result_.summary.nodes = problem_->node_count();
  }

  bool take(nlp::JerkSolution solution, const char* solver) {
    result_.summary.iterations += solution.iterations;
    result_.summary.message = solution.message;
    if (!solution.converged) return false;
    result_.summary.solver = solver;
    found_ = std::move(solution);
    const bool priced = request_.time.mode == TimeMode::time_price;
    result_.summary.price_of_time_W = found_.price_W + (priced ? request_.time.price_W : 0.0);
    best_ = nlp::profile_from_motion(problem_->s, found_.motion);
    return true;
  }

  /// The profile of least time within the jerk limit.
  const ProfileResult& fastest() {
    if (!fastest_) {
      ProfileRequest request = request_;
      request.time = {.mode = TimeMode::minimum_time};
      fastest_ = find_profile_with_jerk_limit(request);
    }
    return *fastest_;
  }

  /// Whether the requested time is before that of the fastest motion found.
  bool is_too_soon() {
    if (minimum_time() || problem_->duration_row == nlp::DurationRow::none || !fastest().profile)
      return false;
    if (fastest().profile->duration_s() * (1 - kMetTime) <= problem_->duration_s) return false;
    result_.summary.message = "the fastest motion found arrives after the deadline";
    return true;
  }

  /// The fastest motion, on its own grid, slowed down to the available time.
  bool by_way_of_minimum_time() {
    if (minimum_time() || is_too_soon() || !fastest().profile) return false;
    const Profile& profile = *fastest().profile;
    const bool timed = problem_->duration_row != nlp::DurationRow::none;
    const double slower = timed ? problem_->duration_s / profile.duration_s() : 1.3;
    s_ = profile.s;
    transcribe();
    const nlp::JerkMotion guess = slowed(resampled(profile), slower);
    if (take(nlp::solve_fast(program(guess)), "fast") || take(nlp::solve_with_ipopt(program(guess)), "ipopt"))
      return true;
    if (!timed || slower > 1 + kNoOtherMotion) return false;
    found_.motion = resampled(profile);
    best_ = profile;
    return true;
  }

  /// Rates between the slowest and the fastest, and accelerations, averaged over the time that the jerk
  /// limit takes to build them up.
  nlp::JerkMotion from_envelope(const nlp::RateEnvelope& envelope) const {
    const nlp::Problem& problem = *problem_;
    const double fastest_s = duration_of(problem, envelope.fastest);
    const Profile fastest = profile_from_squares(problem.s, envelope.fastest);
    double most = 0;
    for (double a : fastest.acceleration) most = std::max(most, std::abs(a));
    const double window_s = std::clamp(most / request_.limits.jerk_m_s3, 1e-3 * fastest_s, 0.5 * fastest_s);
    double aim_s = minimum_time() ? fastest_s : 1.5 * fastest_s;
    if (problem.duration_row == nlp::DurationRow::at_most)
      aim_s = std::min(aim_s, problem.duration_s - window_s);
    if (problem.duration_row == nlp::DurationRow::equal) aim_s = problem.duration_s - window_s;
    const std::vector<double> b = first_guess(problem, envelope, std::max(aim_s, 1.001 * fastest_s));
    return nlp::averaged_motion(profile_from_squares(problem.s, b), window_s);
  }

  nlp::JerkMotion resampled(const Profile& profile) const {
    nlp::JerkMotion motion;
    double before_s = 0;
    for (std::size_t k = 0; k < s_.size(); ++k) {
      const bool end = k == 0 || k + 1 == s_.size();
      const ProfileState state = profile.at_s(s_[k]);
      motion.u.push_back(state.rate);
      motion.a.push_back(end ? 0.0 : state.acceleration);
      if (k > 0) motion.dt.push_back(state.time_s - before_s);
      before_s = state.time_s;
    }
    return motion;
  }

  const ProfileRequest& request_;
  PathMotion motion_;
  ProfileResult result_{};
  std::vector<double> s_{};
  std::vector<nlp::Tightening> tightenings_{};
  std::optional<nlp::Problem> problem_{};
  nlp::JerkSolution found_{};
  std::optional<Profile> best_{};
  std::optional<ProfileResult> incumbent_{};  ///< the last within the limits
  std::optional<ProfileResult> fastest_{};    ///< once computed
  double least_objective_{kNoLimit};
  int sharpened_{};
};

}  // namespace

ProfileResult find_profile_with_jerk_limit(const ProfileRequest& request) {
  return JerkSolver(request).solve();
}

}  // namespace joulepath
