#include <algorithm>
#include <cmath>

#include "planner/first_guess.hpp"
#include "planner/infeasibility_finder.hpp"
#include "planner/jerk_profile.hpp"
#include "planner/nlp/certificate.hpp"
#include "planner/nlp/dense_check.hpp"
#include "planner/nlp/fast_solver.hpp"
#include "planner/nlp/forward_backward.hpp"
#include "planner/nlp/grid.hpp"
#include "planner/nlp/ipopt_solver.hpp"
#include "planner/profile.hpp"
#include "planner/request_check.hpp"

namespace joulepath {
namespace {

using nlp::Problem;

constexpr int kRounds = 12;         ///< of tightening and refinement
constexpr double kSettled = 7e-7;   ///< relative violation that a plan may have, short of the replay's 1e-6
constexpr double kSameTime = 2e-6;  ///< a deadline this close to the minimum time leaves no choice

class ProfileSolver {
 public:
  explicit ProfileSolver(const ProfileRequest& request) : request_(request), motion_(path_motion(request)) {}

  ProfileResult solve() {
    std::vector<double> s =
        nlp::make_grid(motion_, request_, std::clamp<std::size_t>(request_.nodes, 4, 100000));
    std::vector<nlp::Tightening> tightenings;
    for (int round = 0; round < kRounds; ++round) {
      const Problem problem = nlp::transcribe(request_, motion_, s, tightenings, best_ ? &*best_ : nullptr);
      result_.summary.nodes = problem.node_count();
      if (!solve_on(problem)) return std::move(result_);
      if (request_.draft) return sketch();
      const nlp::DenseCheck check = nlp::check_densely(
          problem, motion_, *best_, nlp::counted_energy_J(problem, best_b_), request_.accuracy);
      const bool accurate =
          check.energy_error_J <= request_.accuracy * std::max(1e-9, std::abs(check.energy_J));
      const bool last = round + 1 == kRounds;
      if (check.worst_ratio <= 1 + kSettled && (accurate || last)) return finish(problem);
      last_ratio_ = check.worst_ratio;
      tightenings.insert(tightenings.end(), check.tighten.begin(), check.tighten.end());
      s = nlp::cut_segments(s, check.cut);
    }
    result_.summary.status = SolveStatus::failed;
    result_.summary.message =
        "limits do not settle between nodes (worst use " + std::to_string(last_ratio_) + ")";
    return std::move(result_);
  }

 private:
  /// Fills best_; false when the request is infeasible or the solver failed (result_ then says so).
  bool solve_on(const Problem& problem) {
    const nlp::RateEnvelope envelope = nlp::rate_envelope(problem);
    if (envelope.blocked) return give_up(explain_blocked(request_, problem, *envelope.blocked));
    const double minimum_s = duration_of(problem, envelope.fastest);
    const bool limited = problem.duration_row != nlp::DurationRow::none;
    if (std::isnan(problem.duration_s) || (limited && problem.duration_s < minimum_s * (1 - 1e-9)))
      return give_up(explain_duration(request_, minimum_s));
    const bool no_choice = limited && problem.duration_s <= minimum_s * (1 + kSameTime);
    if (request_.time.mode == TimeMode::minimum_time || no_choice || problem.unknown_count() == 0)
      return take(problem, envelope.fastest, "forward_backward");
    if (problem.duration_row == nlp::DurationRow::equal) {
      const double maximum_s = duration_of(problem, blend(envelope, 1e-12));
      if (problem.duration_s > maximum_s) return give_up(explain_duration(request_, maximum_s));
    }
    return optimize(problem, envelope, minimum_s);
  }

  bool optimize(const Problem& problem, const nlp::RateEnvelope& envelope, double minimum_s) {
    const bool equal = problem.duration_row == nlp::DurationRow::equal;
    const double aim_s =
        equal ? problem.duration_s : std::min(0.9 * problem.duration_s + 0.1 * minimum_s, 1.5 * minimum_s);
    const std::vector<double> start = first_guess(problem, envelope, aim_s);
    SolveSummary& summary = result_.summary;
    const char* solver = "fast";
    if (request_.solver == SolverChoice::fast && summary.handed_over.empty()) {
      solution_ = nlp::solve_fast(problem, start);
      summary.iterations += solution_.iterations;
      if (!solution_.converged) summary.handed_over = solution_.message;
    }
    if (request_.solver == SolverChoice::ipopt || !summary.handed_over.empty()) {
      solver = "ipopt";
      solution_ = nlp::solve_with_ipopt(problem, start);
      summary.iterations += solution_.iterations;
    }
    if (!solution_.converged) {
      summary.solver = solver;
      summary.status = SolveStatus::failed;
      summary.message = solution_.message;
      return false;
    }
    const bool priced = request_.time.mode == TimeMode::time_price;
    summary.price_of_time_W = solution_.price_W + (priced ? request_.time.price_W : 0.0);
    return take(problem, solution_.b, solver);
  }

  bool take(const Problem& problem, const std::vector<double>& b, const char* solver) {
    result_.summary.solver = solver;
    best_b_ = b;
    best_ = profile_from_squares(problem.s, b);
    return true;
  }

  bool give_up(Infeasibility verdict) {
    result_.summary.status = SolveStatus::infeasible;
    result_.summary.message = verdict.message;
    result_.infeasibility = std::move(verdict);
    return false;
  }

  ProfileResult sketch() {
    result_.summary.status = SolveStatus::feasible;
    result_.profile = std::move(best_);
    return std::move(result_);
  }

  /// The certificate: dual bound on this grid, and what half of the nodes cost more.
  ProfileResult finish(const Problem& problem) {
    SolveSummary& summary = result_.summary;
    summary.status = SolveStatus::feasible;
    const nlp::RateEnvelope envelope = nlp::rate_envelope(problem);
    if (summary.solver == "forward_backward")
      certify_time(problem, envelope);
    else
      certify_energy(problem, envelope);
    if (summary.gap_percent <= 100 * request_.accuracy && !summary.local)
      summary.status = SolveStatus::optimal;
    result_.profile = std::move(best_);
    return std::move(result_);
  }

  void certify_energy(const Problem& problem, const nlp::RateEnvelope& envelope) {
    nlp::Certificate certificate = nlp::certify(problem, solution_, envelope.fastest);
    if (!certificate.convex) raise_bound(problem, envelope, certificate);
    set_bound(certificate, coarse_excess(problem) / 3);
  }

  /// Where the Lagrangian is not convex at the solution's own price of time, another price is a bound too:
  /// E(b) >= min (E + price T)(b) - price T wherever T(b) <= T, and with a price the problem is convex.
  void raise_bound(const Problem& problem, const nlp::RateEnvelope& envelope,
                   nlp::Certificate& certificate) const {
    if (problem.duration_row == nlp::DurationRow::none) return;
    for (double price_W : {0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0}) {
      Problem priced = problem;
      priced.duration_row = nlp::DurationRow::none;
      priced.time_weight_W = price_W;
      if (problem.duration_row == nlp::DurationRow::at_most && price_W < problem.time_weight_W) continue;
      const nlp::Solution solution = nlp::solve_fast(priced, solution_.b);
      if (!solution.converged) continue;
      const nlp::Certificate other = nlp::certify(priced, solution, envelope.fastest);
      const double bound = other.lower_bound + (problem.time_weight_W - price_W) * problem.duration_s;
      if (other.convex) certificate.lower_bound = std::max(certificate.lower_bound, bound);
    }
    certificate.lower_bound = std::min(certificate.lower_bound, certificate.objective);
  }

  /// Least time: certified by the dual bound of the same problem with time as its objective.
  void certify_time(const Problem& problem, const nlp::RateEnvelope& envelope) {
    Problem timed = problem;
    timed.channels = 0;
    timed.energy_weight = 0;
    timed.time_weight_W = 1;
    timed.duration_row = nlp::DurationRow::none;
    if (timed.unknown_count() == 0) return set_bound({best_->duration_s(), best_->duration_s(), true}, 0.0);
    nlp::Solution fastest = nlp::solve_fast(timed, blend(envelope, 0.95));
    nlp::Certificate certificate = nlp::certify(timed, fastest, envelope.fastest);
    certificate.objective = best_->duration_s();
    certificate.lower_bound = std::min(certificate.lower_bound, certificate.objective);
    set_bound(certificate, 0.0);
  }

  void set_bound(const nlp::Certificate& certificate, double discretization) {
    SolveSummary& summary = result_.summary;
    const double size = std::max(1e-9, std::abs(certificate.objective));
    summary.lower_bound_J = certificate.lower_bound - discretization;
    summary.gap_percent = 100 * (certificate.objective - summary.lower_bound_J) / size;
    summary.local = !certificate.convex;
  }

  /// By how much every second node alone costs more; the error of constant accelerations falls with the
  /// square of the spacing, so a third of it is what this grid still costs too much.
  double coarse_excess(const Problem& problem) const {
    std::vector<double> s, b;
    for (std::size_t k = 0; k < problem.node_count(); k += 2)
      s.push_back(problem.s[k]), b.push_back(solution_.b[k]);
    if (problem.node_count() % 2 == 0) s.push_back(problem.s.back()), b.push_back(solution_.b.back());
    if (s.size() < 4) return 0.0;
    const Problem coarse = nlp::transcribe(request_, motion_, s, {}, &*best_);
    const nlp::Solution solution = nlp::solve_fast(coarse, b);
    return solution.converged ? std::max(0.0, solution.objective - solution_.objective) : 0.0;
  }

  const ProfileRequest& request_;
  PathMotion motion_;
  ProfileResult result_{};
  std::vector<double> best_b_{};  ///< squares of the rate
  std::optional<Profile> best_{};
  nlp::Solution solution_{};
  double last_ratio_{};
};

}  // namespace

ProfileResult solve_profile(const ProfileRequest& request) {
  if (std::optional<Infeasibility> verdict = senseless(request)) {
    ProfileResult result;
    result.summary.status = SolveStatus::infeasible;
    result.summary.message = verdict->message;
    result.infeasibility = std::move(verdict);
    return result;
  }
  if (std::isfinite(request.limits.jerk_m_s3) && !is_turn(request.piece) && !request.draft)
    return solve_with_jerk_limit(request);
  return ProfileSolver(request).solve();
}

}  // namespace joulepath
