#include "planner/profile/certification.hpp"

#include <algorithm>
#include <cmath>

#include "planner/motion/motion_energy.hpp"
#include "planner/nlp/fast/fast_solver.hpp"

namespace joulepath {
namespace {

/// Relative to the value itself, without the cost of its time.
void set_gap(double value, double gap, const DualGap& parts, SolveSummary& summary) {
  summary.gap_percent = 100 * gap / std::max(1e-9, std::abs(value));
  summary.local = parts.is_elsewhere();
}

void set_energy_bound(double energy_J, double gap_J, const DualGap& parts, SolveSummary& summary) {
  summary.lower_bound_J = energy_J - gap_J;
  set_gap(energy_J, gap_J, parts, summary);
}

/// The bound (J) for exactly the requested time if a second has a negative value: near standstill the
/// integrand is below any bound. The proof is for the least energy without a price, plus the standby of that
/// time.
double bound_without_price_J(const nlp::Problem& problem, const PathMotion& motion,
                             const nlp::Solution& solution) {
  nlp::Problem free = problem;
  free.time_weight_W = 0;
  free.duration_row = nlp::DurationRow::none;
  const nlp::Solution cheapest = nlp::solve_fast(free, solution.b);
  if (!cheapest.converged) return -kNoLimit;
  const Profile profile = profile_from_squares(free.s, cheapest.b);
  const CostModel model(*free.request, motion);
  const DualGap gap = dual_gap(model, costate_of(free, cheapest, profile, model), profile);
  const double standby_W = motion.plant().robot.power.standby_W, duration_s = profile.duration_s();
  return planned_energy_J(motion, profile) - gap.total() + standby_W * (problem.duration_s - duration_s);
}

}  // namespace

DualGap certify_energy(const nlp::Problem& problem, const PathMotion& motion, const nlp::Solution& solution,
                       const Profile& profile, double driving_J, SolveSummary& summary) {
  const double value_J = driving_J + motion.plant().robot.power.standby_W * profile.duration_s();
  const CostModel model(*problem.request, motion, problem.time_weight_W + solution.price_W);
  DualGap gap = dual_gap(model, costate_of(problem, solution, profile, model), profile);
  if (gap.is_elsewhere()) {
    const DualGap other = dual_gap(model, costate_of(problem, solution, profile, model, true), profile);
    if (other.total() < gap.total()) gap = other;
  }
  const bool timed = problem.duration_row != nlp::DurationRow::none;
  const double unused_s = timed ? std::max(0.0, problem.duration_s - profile.duration_s()) : 0.0;
  double gap_J = gap.total() + std::max(0.0, solution.price_W) * unused_s;
  if (gap.is_elsewhere() && problem.duration_row == nlp::DurationRow::equal)
    gap_J = std::min(gap_J, value_J - bound_without_price_J(problem, motion, solution));
  set_energy_bound(value_J, gap_J, gap, summary);
  return gap;
}

LeastTime certify_time(const nlp::Problem& problem, const PathMotion& motion, const Profile& profile,
                       SolveSummary& summary) {
  LeastTime bound = least_time(CostModel(*problem.request, motion), problem.s);
  summary.lower_bound_s = std::min(bound.lower_s, profile.duration_s());
  set_gap(profile.duration_s(), profile.duration_s() - summary.lower_bound_s, {}, summary);
  return bound;
}

}  // namespace joulepath
