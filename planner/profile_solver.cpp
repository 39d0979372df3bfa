#include <algorithm>
#include <cmath>

#include "planner/infeasibility_finder.hpp"
#include "planner/nlp/dense_check.hpp"
#include "planner/nlp/forward_backward.hpp"
#include "planner/nlp/grid.hpp"
#include "planner/nlp/ipopt_solver.hpp"
#include "planner/profile.hpp"

namespace joulepath {
namespace {

using nlp::Problem;

constexpr int kRounds = 8;          ///< of tightening and refinement
constexpr double kSettled = 1e-6;   ///< relative violation that a plan may have
constexpr double kSameTime = 2e-6;  ///< a deadline this close to the minimum time leaves no choice

std::vector<double> blend(const nlp::RateEnvelope& envelope, double share) {
  std::vector<double> b(envelope.fastest.size());
  for (std::size_t k = 0; k < b.size(); ++k)
    b[k] = share * envelope.fastest[k] + (1 - share) * envelope.slowest[k];
  b.front() = envelope.fastest.front();
  b.back() = envelope.fastest.back();
  return b;
}

/// A profile between the slowest and the fastest that takes about `duration_s`.
std::vector<double> guess(const Problem& problem, const nlp::RateEnvelope& envelope, double duration_s) {
  double low = 1e-12, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double share = std::sqrt(low * high);
    (duration_of(problem, blend(envelope, share)) > duration_s ? low : high) = share;
  }
  return blend(envelope, std::min(high, 0.9999));
}

std::optional<Infeasibility> senseless(const ProfileRequest& request) {
  const double length = piece_length(request.piece);
  if (!(std::isfinite(length) && length > 0))
    return explain_request(request, "path", "the path has no length: nothing to drive");
  if (!(request.start_rate >= 0) || !(request.end_rate >= 0) ||
      !std::isfinite(request.start_rate + request.end_rate))
    return explain_request(request, "start_speed", "start and end speed must be 0 or more");
  if (!(request.time.duration_s > 0)) return explain_duration(request, 0.0);
  return std::nullopt;
}

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
      const nlp::DenseCheck check = nlp::check_densely(problem, motion_, *best_, request_.accuracy);
      const bool accurate =
          check.energy_error_J <= request_.accuracy * std::max(1e-9, std::abs(check.energy_J));
      if (check.worst_ratio <= 1 + kSettled && accurate) return finish(problem, check);
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
    if (limited && problem.duration_s < minimum_s * (1 - 1e-9))
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
    nlp::Solution solution = nlp::solve_with_ipopt(problem, guess(problem, envelope, aim_s));
    result_.summary.iterations += solution.iterations;
    if (!solution.converged) {
      result_.summary.solver = "ipopt";
      result_.summary.status = SolveStatus::failed;
      result_.summary.message = solution.message;
      return false;
    }
    result_.summary.price_of_time_W =
        solution.price_W + (request_.time.mode == TimeMode::time_price ? request_.time.price_W : 0.0);
    solution_ = solution;
    return take(problem, solution.b, "ipopt");
  }

  bool take(const Problem& problem, const std::vector<double>& b, const char* solver) {
    result_.summary.solver = solver;
    best_ = profile_from_squares(problem.s, b);
    return true;
  }

  bool give_up(Infeasibility verdict) {
    result_.summary.status = SolveStatus::infeasible;
    result_.summary.message = verdict.message;
    result_.infeasibility = std::move(verdict);
    return false;
  }

  ProfileResult finish(const Problem&, const nlp::DenseCheck&) {
    result_.summary.status = SolveStatus::feasible;
    result_.profile = std::move(best_);
    return std::move(result_);
  }

  const ProfileRequest& request_;
  PathMotion motion_;
  ProfileResult result_{};
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
  return ProfileSolver(request).solve();
}

}  // namespace joulepath
