#include "planner/profile/profile_solver.hpp"

#include <algorithm>
#include <cmath>

#include "model/stop.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/profile/certification.hpp"
#include "planner/profile/dense_check.hpp"
#include "planner/profile/first_guess.hpp"
#include "planner/profile/infeasibility_finder.hpp"
#include "planner/profile/jerk_profile.hpp"
#include "planner/profile/jerk_solver.hpp"
#include "planner/profile/request_check.hpp"
#include "planner/profile/solve_tolerances.hpp"
#include "planner/values/profile.hpp"
// Design: docs/decisions/0300-path-domain.md
// Method: [Verscheure2009]
namespace joulepath {
namespace {

using nlp::Problem;

constexpr int kRounds = 12;  ///< of tightening and refinement
/// From this round on a limit is tightened in the neighboring segments, too, in twice as many each round:
/// where it determines a stretch of the profile, a tightened segment moves the violation into the next one.
constexpr int kWidened = 5;
/// Relative: a deadline within this distance of the minimum time determines the profile.
constexpr double kSameTime = 2e-6;
constexpr int kSharpenings = 16;      ///< cuts of the grid for a deadline that is missed slightly
constexpr double kProvenTime = 0.01;  ///< target of the gap of least time, as a share of `accuracy`
/// Share of the previous gap: a finer grid that closes less is the last one.
constexpr double kWorthAProof = 0.7;
/// A grid with more nodes than this multiple of the requested ones, and than the limits alone needed, is not
/// refined for its bound.
constexpr std::size_t kMostNodes = 4;
/// A grid with more nodes is not refined for the energy: along a stretch where a wheel's power stays at zero,
/// the kink of its recovery, the error is of first order in h.
constexpr std::size_t kManyNodes = 1000;
/// Of Ipopt from the fast solver's solution: it takes a few, or hundreds that change nothing.
constexpr int kPolishIterations = 30;
/// A grid with more than this multiple of its first nodes settles no limit: the solve ends there.
constexpr std::size_t kMostGrowth = 100;
constexpr int kGridHalvings = 2;  ///< of a grid on which no solver converges: it does on most others
constexpr const char* kFastestSolver = "forward_backward";

/// Finds grid and profile together: solves, checks between the nodes, tightens and cuts, until a profile
/// keeps the limits and a finer grid does not improve its bound.
class ProfileSolver {
 public:
  /// `explains`: a path that no profile passes gets a verdict; otherwise the status alone says so.
  explicit ProfileSolver(const ProfileRequest& request, bool explains = true)
      : request_(request), motion_(path_motion(request)), explains_(explains) {}

  ProfileResult solve() {
    grid_.s = nlp::make_grid(motion_, request_, std::clamp<std::size_t>(request_.nodes, 4, 100000));
    const std::size_t most_nodes = kMostGrowth * grid_.s.size();
    for (int round = 0; stage_ != Stage::done && round < kRounds && grid_.s.size() <= most_nodes;) {
      const Problem problem =
          nlp::transcribe(request_, motion_, grid_.s, grid_.tightenings, best_ ? &best_->profile : nullptr);
      result_.summary.nodes = problem.node_count();
      if (late(problem))
        approach_least_time(problem);
      else
        improve(problem, round++);
    }
    if (stage_ != Stage::done)
      fail("limits do not settle between nodes (worst use " + std::to_string(grid_.worst_ratio) + ")");
    return incumbent_ ? std::move(*incumbent_) : std::move(result_);
  }

 private:
  enum class Stage {
    search,     ///< the fast solver solves on each grid
    fall_back,  ///< it did not converge: Ipopt solves on each grid
    polish,     ///< Ipopt solves on the last grid, from the fast solver's solution
    done
  };
  enum class Outcome { solved, failed, blocked, infeasible };

  struct Grid {
    std::vector<double> s{};
    std::vector<nlp::Tightening> tightenings{};
    double worst_ratio{};  ///< use of a limit between its nodes
    int sharpenings{}, halvings{};
  };
  struct Candidate {
    std::vector<double> b{};  ///< squares of the rate
    Profile profile{};
  };

  /// One round: solves on the grid, then takes the profile or makes the next grid.
  void improve(const Problem& problem, int round) {
    if (const Outcome outcome = solve_on(problem); outcome != Outcome::solved) return retry(problem, outcome);
    if (request_.draft) return finish_draft();
    const double accuracy = problem.node_count() > kManyNodes ? kNoLimit : request_.accuracy;
    const nlp::DenseCheck check = nlp::check_densely(problem, motion_, best_->profile,
                                                     nlp::counted_energy_J(problem, best_->b), accuracy);
    const bool accurate = check.energy_error_J <= accuracy * std::max(1e-9, std::abs(check.energy_J));
    if (check.worst_ratio <= 1 + kLimitTolerance && (accurate || round + 1 == kRounds))
      accept(problem, check.energy_J);
    else
      tighten(check, round);
  }

  /// Another grid after one without a profile, unless there is an answer.
  void retry(const Problem& problem, Outcome outcome) {
    if (incumbent_ || outcome == Outcome::infeasible || grid_.halvings++ == kGridHalvings) {
      stage_ = Stage::done;
      return;
    }
    stage_ = Stage::search;
    if (outcome == Outcome::blocked) grid_.tightenings.clear();
    grid_.s = halved(problem);
  }

  /// Keeps a profile within the limits; then a finer grid for its bound, Ipopt on this one, or the end.
  void accept(const Problem& problem, double driving_J) {
    std::vector<double> finer = prove(problem, driving_J);
    keep();
    if (!finer.empty())
      grid_.s = std::move(finer);
    else
      stage_ = must_polish() ? Stage::polish : Stage::done;
  }

  void tighten(const nlp::DenseCheck& check, int round) {
    grid_.worst_ratio = check.worst_ratio;
    for (nlp::Tightening limit : check.tighten) {
      const double reach = round < kWidened ? 0.0 : (limit.to - limit.from) * (1 << (round - kWidened));
      limit.from -= reach, limit.to += reach;
      grid_.tightenings.push_back(limit);
    }
    grid_.s = nlp::cut_segments(grid_.s, check.cut);
  }

  void fail(std::string message) {
    result_.summary.status = SolveStatus::failed;
    result_.summary.message = std::move(message);
  }

  Outcome refuse(Infeasibility verdict) {
    result_.summary.status = SolveStatus::infeasible;
    result_.summary.message = verdict.message;
    result_.infeasibility = std::move(verdict);
    return Outcome::infeasible;
  }

  /// True if the fastest profile of a grid is after the deadline.
  static bool late(const Problem& problem) {
    if (problem.duration_row == nlp::DurationRow::none) return false;
    const nlp::RateEnvelope envelope = nlp::rate_envelope(problem);
    return !envelope.blocked && duration_of(problem, envelope.fastest) > problem.duration_s * (1 + kMetTime);
  }

  /// A grid with a faster fastest profile: where the limit that determines the profile changes within a
  /// segment, the profile is slower than the path requires. The end where the deadline is before the least
  /// time, or where no grid comes close enough to it; result_ then contains the reason.
  void approach_least_time(const Problem& problem) {
    const LeastTime bound = least_time(CostModel(request_, motion_), problem.s);
    const Profile fastest = profile_from_squares(problem.s, nlp::rate_envelope(problem).fastest);
    if (problem.duration_s < bound.lower_s) {
      refuse(explain_late(request_, bound.lower_s));
      stage_ = Stage::done;
    } else if (grid_.sharpenings++ == kSharpenings) {
      fail("the fastest profile found takes " + std::to_string(fastest.duration_s()) +
           " s; the proven least time is " + std::to_string(bound.lower_s) + " s");
      stage_ = Stage::done;
    } else {
      const double late_s = fastest.duration_s() - problem.duration_s;
      grid_.s =
          nlp::cut_by_excess(problem.s, time_excess_s(fastest, bound),
                             0.5 * late_s / static_cast<double>(problem.segment_count()), bound.switches);
    }
  }

  static std::vector<double> time_excess_s(const Profile& fastest, const LeastTime& bound) {
    std::vector<double> excess_s;
    for (std::size_t k = 0; k + 1 < fastest.s.size(); ++k)
      excess_s.push_back(fastest.time_s[k + 1] - fastest.time_s[k] - bound.of_segment_s[k]);
    return excess_s;
  }

  static std::vector<double> halved(const Problem& problem) {
    return nlp::cut_segments(problem.s, std::vector<bool>(problem.segment_count(), true));
  }

  /// A grid that nothing passes is a verdict only with the limits as they are, and if nothing passes a finer
  /// grid either.
  Outcome stop_at(const Problem& problem, const nlp::Blocked& blocked) {
    const auto passes_finer = [&] {
      const Problem finer = nlp::transcribe(request_, motion_, halved(problem), {}, nullptr);
      return !nlp::rate_envelope(finer).blocked;
    };
    if (!grid_.tightenings.empty() || (!request_.draft && passes_finer())) {
      fail("no profile passes " + std::string(blocked.limit.empty() ? "the path" : blocked.limit) +
           " on the grids tried; whether there is one is not known");
      return Outcome::blocked;
    }
    if (explains_) return refuse(explain_blocked(request_, problem, blocked));
    result_.summary.status = SolveStatus::infeasible;
    return Outcome::infeasible;
  }

  /// Sets best_, or result_ contains the reason.
  Outcome solve_on(const Problem& problem) {
    const nlp::RateEnvelope envelope = nlp::rate_envelope(problem);
    if (envelope.blocked) return stop_at(problem, *envelope.blocked);
    const double minimum_s = duration_of(problem, envelope.fastest);
    const bool limited = problem.duration_row != nlp::DurationRow::none;
    if (std::isnan(problem.duration_s)) return refuse(explain_late(request_, minimum_s));
    const bool no_choice = limited && problem.duration_s <= minimum_s * (1 + kSameTime);
    if (request_.time.mode == TimeMode::minimum_time || no_choice || problem.unknown_count() == 0)
      return take(problem, envelope.fastest, kFastestSolver);
    if (problem.duration_row == nlp::DurationRow::equal) {
      const double maximum_s = duration_of(problem, blend(envelope, 1e-12));
      if (problem.duration_s > maximum_s) return refuse(explain_long(request_, maximum_s));
    }
    return optimize(problem, envelope, minimum_s);
  }

  Outcome optimize(const Problem& problem, const nlp::RateEnvelope& envelope, double minimum_s) {
    const bool equal = problem.duration_row == nlp::DurationRow::equal;
    const double aim_s =
        equal ? problem.duration_s : std::min(0.9 * problem.duration_s + 0.1 * minimum_s, 1.5 * minimum_s);
    const std::vector<double> start = first_guess(problem, envelope, aim_s);
    SolveSummary& summary = result_.summary;
    if (stage_ == Stage::search) solution_ = by_fast_solver(problem, start);
    if (stage_ != Stage::search) solution_ = by_ipopt(problem, start);
    const char* solver = stage_ == Stage::search ? "fast" : "ipopt";
    if (!solution_.converged) {
      summary.solver = solver;
      fail(solution_.message);
      return Outcome::failed;
    }
    const bool priced = request_.time.mode == TimeMode::time_price;
    summary.price_of_time_W = solution_.price_W + (priced ? request_.time.price_W : 0.0);
    return take(problem, solution_.b, solver);
  }

  nlp::Solution by_fast_solver(const Problem& problem, const std::vector<double>& guess) {
    nlp::Solution found = nlp::solve_fast(problem, guess);
    result_.summary.iterations += found.iterations;
    if (found.converged) return found;
    stage_ = Stage::fall_back;
    if (request_.solver == SolverChoice::fast) result_.summary.handed_over = found.message;
    return found;
  }

  /// From the fast solver's solution, which stays the answer where that takes long, else from a guess.
  nlp::Solution by_ipopt(const Problem& problem, const std::vector<double>& guess) {
    const bool near = stage_ == Stage::polish && solution_.b.size() == problem.node_count() &&
                      solution_.row_multiplier.size() == problem.rows.size();
    const nlp::IpoptOptions from_near{.max_iterations = kPolishIterations, .warm = true, .near = &solution_};
    nlp::Solution found =
        near ? nlp::solve_with_ipopt(problem, solution_.b, from_near) : nlp::solve_with_ipopt(problem, guess);
    result_.summary.iterations += found.iterations;
    return found;
  }

  /// True if Ipopt must solve again on the final grid, which the fast solver found.
  bool must_polish() const {
    return request_.solver == SolverChoice::ipopt && result_.summary.solver == std::string("fast");
  }

  Outcome take(const Problem& problem, const std::vector<double>& b, const char* solver) {
    result_.summary.solver = solver;
    result_.summary.message.clear();
    best_ = {b, profile_from_squares(problem.s, b)};
    return Outcome::solved;
  }

  void finish_draft() {
    const bool priced = request_.time.mode == TimeMode::time_price;
    result_.summary.status = SolveStatus::feasible;
    result_.summary.counted_J =
        solution_.objective - (priced ? request_.time.price_W * best_->profile.duration_s() : 0.0);
    result_.profile = std::move(best_->profile);
    stage_ = Stage::done;
  }

  /// Computes the bound and returns a grid with a tighter one; empty where refinement is not worth its cost.
  std::vector<double> prove(const Problem& problem, double driving_J) {
    SolveSummary& summary = result_.summary;
    const Profile& profile = best_->profile;
    const bool fastest = summary.solver == kFastestSolver;
    LeastTime least{};
    DualGap gap{};
    if (fastest)
      least = certify_time(problem, motion_, profile, summary);
    else
      gap = certify_energy(problem, motion_, solution_, profile, driving_J, summary);
    const double share = 0.01 * summary.gap_percent;
    const double aim = (fastest ? kProvenTime : request_.proven) * request_.accuracy;
    const bool better = share < kWorthAProof * least_gap_;
    if (std::isinf(least_gap_)) first_proof_nodes_ = problem.node_count();
    least_gap_ = std::min(least_gap_, share);
    if (share <= aim || !better || stage_ == Stage::polish || summary.local ||
        problem.node_count() > std::max(kMostNodes * request_.nodes, first_proof_nodes_))
      return {};
    const std::vector<double> excess = fastest ? time_excess_s(profile, least) : gap.of_segment;
    if (excess.empty()) return {};
    const double total = fastest ? profile.duration_s() - least.lower_s : gap.total();
    return nlp::cut_by_excess(problem.s, excess, total * aim / share / static_cast<double>(excess.size()),
                              least.switches);
  }

  /// Stores a profile within the limits, with the status that follows from its bound.
  void keep() {
    const bool closed = result_.summary.gap_percent <= 100 * request_.accuracy;
    incumbent_ = result_;
    incumbent_->summary.status = closed ? SolveStatus::optimal : SolveStatus::feasible;
    incumbent_->profile = best_->profile;
  }

  const ProfileRequest& request_;
  const PathMotion motion_;
  const bool explains_{};
  Stage stage_{Stage::search};
  Grid grid_{};
  nlp::Solution solution_{};
  std::optional<Candidate> best_{};
  std::optional<ProfileResult> incumbent_{};  ///< the last within the limits, whatever a finer grid gives
  ProfileResult result_{};
  double least_gap_{kNoLimit};
  std::size_t first_proof_nodes_{};  ///< of the grid that the limits need
};

bool jerk_limited(const ProfileRequest& request) {
  return std::isfinite(request.limits.jerk_m_s3) && !is_turn(request.piece) && !request.draft;
}

}  // namespace

std::optional<double> least_time_found_s(ProfileRequest request) {
  if (senseless(request)) return std::nullopt;
  request.time = {.mode = TimeMode::minimum_time};
  request.solver = SolverChoice::fast;
  const ProfileResult found =
      jerk_limited(request) ? find_profile_with_jerk_limit(request) : ProfileSolver(request, false).solve();
  return found.profile ? std::optional(found.profile->duration_s()) : std::nullopt;
}

std::optional<double> driving_time_s(const ProfileRequest& request) {
  const bool open = std::isinf(request.time.duration_s) && request.time.mode != TimeMode::minimum_time;
  ProfileResult found;
  if (open && jerk_limited(request) && request.limits.jerk_m_s3 > 0 && !senseless(request))
    found = find_profile_with_jerk_limit(request);
  if (!found.profile) found = solve_profile(request);
  return found.profile ? std::optional(found.profile->duration_s()) : std::nullopt;
}

ProfileResult solve_profile(const ProfileRequest& request) {
  stop_if_asked();
  if (std::optional<Infeasibility> verdict = senseless(request)) {
    ProfileResult result;
    result.summary.status = SolveStatus::infeasible;
    result.summary.message = verdict->message;
    result.infeasibility = std::move(verdict);
    return result;
  }
  if (jerk_limited(request)) return solve_with_jerk_limit(request);
  return ProfileSolver(request).solve();
}

}  // namespace joulepath
