#include "planner/profile/certification.hpp"

#include <algorithm>
#include <cmath>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/profile/certificate.hpp"
#include "planner/profile/first_guess.hpp"
#include "planner/values/profile.hpp"
#include "planner/values/profile_result.hpp"

namespace joulepath {
namespace {

void set_bound(const nlp::Certificate& certificate, double discretization, SolveSummary& summary) {
  const double size = std::max(1e-9, std::abs(certificate.objective));
  summary.lower_bound_J = certificate.lower_bound - discretization;
  summary.gap_percent = 100 * (certificate.objective - summary.lower_bound_J) / size;
  summary.local = !certificate.convex;
}

/// Where the Lagrangian is not convex at the solution's own price of time, another price is a bound too:
/// E(b) >= min (E + price T)(b) - price T wherever T(b) <= T, and with a price the problem is convex.
void raise_bound(const nlp::Problem& problem, const nlp::RateEnvelope& envelope, const std::vector<double>& b,
                 nlp::Certificate& certificate) {
  if (problem.duration_row == nlp::DurationRow::none) return;
  for (double price_W : {0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 4.0}) {
    nlp::Problem priced = problem;
    priced.duration_row = nlp::DurationRow::none;
    priced.time_weight_W = price_W;
    if (problem.duration_row == nlp::DurationRow::at_most && price_W < problem.time_weight_W) continue;
    const nlp::Solution solution = nlp::solve_fast(priced, b);
    if (!solution.converged) continue;
    const nlp::Certificate other = nlp::certify(priced, solution, envelope.fastest);
    const double bound = other.lower_bound + (problem.time_weight_W - price_W) * problem.duration_s;
    if (other.convex) certificate.lower_bound = std::max(certificate.lower_bound, bound);
  }
  certificate.lower_bound = std::min(certificate.lower_bound, certificate.objective);
}

/// By how much every second node alone costs more; the error of constant accelerations falls with the
/// square of the spacing, so a third of it is what this grid still costs too much.
double coarse_excess(const nlp::Problem& problem, const PathMotion& motion, const nlp::Solution& solution,
                     const Profile& profile) {
  std::vector<double> s, b;
  for (std::size_t k = 0; k < problem.node_count(); k += 2)
    s.push_back(problem.s[k]), b.push_back(solution.b[k]);
  if (problem.node_count() % 2 == 0) s.push_back(problem.s.back()), b.push_back(solution.b.back());
  if (s.size() < 4) return 0.0;
  const nlp::Problem coarse = nlp::transcribe(*problem.request, motion, s, {}, &profile);
  const nlp::Solution coarser = nlp::solve_fast(coarse, b);
  return coarser.converged ? std::max(0.0, coarser.objective - solution.objective) : 0.0;
}

}  // namespace

void certify_energy(const nlp::Problem& problem, const PathMotion& motion, const nlp::RateEnvelope& envelope,
                    const nlp::Solution& solution, const Profile& profile, SolveSummary& summary) {
  nlp::Certificate certificate = nlp::certify(problem, solution, envelope.fastest);
  if (!certificate.convex) raise_bound(problem, envelope, solution.b, certificate);
  set_bound(certificate, coarse_excess(problem, motion, solution, profile) / 3, summary);
}

void certify_time(const nlp::Problem& problem, const nlp::RateEnvelope& envelope, const Profile& profile,
                  SolveSummary& summary) {
  const double duration_s = profile.duration_s();
  const nlp::Problem timed = nlp::with_time_as_objective(problem);
  if (timed.unknown_count() == 0) return set_bound({duration_s, duration_s, true}, 0.0, summary);
  const nlp::Solution fastest = nlp::solve_fast(timed, blend(envelope, 0.95));
  nlp::Certificate certificate = nlp::certify(timed, fastest, envelope.fastest);
  certificate.objective = duration_s;
  certificate.lower_bound = std::min(certificate.lower_bound, duration_s);
  set_bound(certificate, 0.0, summary);
}

}  // namespace joulepath
