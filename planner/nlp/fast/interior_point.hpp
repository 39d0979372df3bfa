#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "planner/nlp/fast/narrowing_kinks.hpp"
#include "planner/nlp/fast/thread_clock.hpp"
#include "planner/nlp/transcription/problem.hpp"
// Design: docs/decisions/0301-solvers.md
// Method: [Mehrotra1992]
namespace joulepath::nlp {

/// A quantity that has to stay positive, its multiplier, and their steps.
struct Pair {
  double s{}, y{};
  double ds{}, dy{};
  double corrected{};  ///< what s y should become: mu less the predictor's second order term
  double inverse{};    ///< 1/s, of this iteration
  double sigma{};      ///< y/s, of this iteration

  void prepare() {
    inverse = 1 / s;
    sigma = y * inverse;
  }
  void dual_step() { dy = (corrected - y * ds) * inverse - y; }
};

/// Largest step lengths before a slack or a multiplier becomes zero.
struct StepSizes {
  double primal{1.0}, dual{1.0};

  /// Sets a pair's step, of which the dual part follows from the primal one.
  void move(Pair& pair, double ds) {
    pair.ds = ds;
    pair.dual_step();
    keep_positive(pair);
  }
  /// Sets the step of the duration's budget to a multiplier.
  void move_budget(Pair& time, double multiplier) {
    time.dy = multiplier - time.y;
    time.ds = (time.corrected - time.s * multiplier) / time.y;
    keep_positive(time);
  }
  /// Applies a pair's step.
  void take(Pair& pair) const {
    pair.s += primal * pair.ds;
    pair.y += dual * pair.dy;
  }

 private:
  void keep_positive(const Pair& pair) {
    constexpr double kToBoundary = 0.995;
    if (pair.s + primal * pair.ds < (1 - kToBoundary) * pair.s) primal = -kToBoundary * pair.s / pair.ds;
    if (pair.y + dual * pair.dy < (1 - kToBoundary) * pair.y) dual = -kToBoundary * pair.y / pair.dy;
  }
};

/// One side of an active row: c = sign (bound - g) >= 0, with a slack.
struct RowSide {
  std::size_t row{};
  std::size_t segment{};
  double sign{};
  double bound{};
  Pair pair{};
  double residual{};  ///< c - s
};

/// Energy recovered by one part of one segment: z >= 0 and E + z >= 0, with a slack for the latter. Both are
/// eliminated from the Newton system. `weight`: cost of z.
struct Recovery {
  Pair z{};
  Pair sum{};
  double residual{};       ///< E + z - s
  double inverse_sigma{};  ///< 1/(sum of both sigmas), of this iteration

  /// On the central path: z y = (E + z) (weight - y) = mu.
  static Recovery on_central_path(double E, double weight, double mu) {
    const double z = (2 * mu - weight * E + std::hypot(weight * E, 2 * mu)) / (2 * weight), y = mu / z;
    return {.z = {.s = z, .y = y}, .sum = {.s = E + z, .y = weight - y}};
  }
  /// Of the eliminated variables: the weight of E'E'^T in the Hessian, and of E' in the gradient.
  double curvature() const { return z.sigma * sum.sigma * inverse_sigma; }
  double slope(double weight) const {
    return -sum.corrected * sum.inverse + sum.sigma * (z.sigma * residual - excess(weight)) * inverse_sigma;
  }
  /// The remainder of z's stationarity: weight less both target multipliers.
  double excess(double weight) const {
    return weight - z.corrected * z.inverse - sum.corrected * sum.inverse;
  }
};

/// The row of the duration: a budget with a slack, or a fixed duration with a multiplier.
struct TimeRow {
  DurationRow kind{};
  Pair slack{};       ///< of a budget
  double price{};     ///< multiplier of a duration that is fixed, W
  double residual{};  ///< s

  bool exists() const { return kind != DurationRow::none; }
  bool is_budget() const { return kind == DurationRow::at_most; }
  double multiplier() const { return !exists() ? 0.0 : is_budget() ? slack.y : price; }

  /// `objective`: its size at the start.
  static TimeRow at_start(const Problem& problem, double duration_s, double objective) {
    TimeRow row{.kind = problem.duration_row};
    if (!row.is_budget()) return row;
    const double s = std::max(problem.duration_s - duration_s, 1e-3 * problem.duration_s);
    row.slack = {.s = s, .y = std::min(0.05 * objective / s, 0.2 * objective / problem.duration_s)};
    return row;
  }
  void take(const StepSizes& sizes, double new_price) {
    if (exists() && !is_budget()) price += sizes.dual * (new_price - price);
  }
};

/// The pairs of rows and recoveries, and the duration, that every state of an iteration has.
struct SegmentPairs {
  std::vector<RowSide> sides{};        ///< by segment
  std::vector<Recovery> recoveries{};  ///< [segment][part]
  TimeRow time{};

  template <class Function>
  void for_each_segment_pair(Function&& use) {
    for (RowSide& side : sides) use(side.pair);
    for (Recovery& recovery : recoveries) use(recovery.z), use(recovery.sum);
    if (time.is_budget()) use(time.slack);
  }
};

struct FastOptions {
  double tolerance{1e-9};  ///< relative to the objective: duality gap and residuals
  int max_iterations{80};
  double until_cpu_s{kNoLimit};  ///< of this thread's clock: no iteration begins later
};

enum class FastOutcome { converged, no_descent, iterations_used, time_used };

/// What is open of the optimality conditions at a point, relative to the objective.
struct OpenConditions {
  std::size_t pairs{};
  double mu{};         ///< mean complementarity
  double objective{};  ///< recovery included
  double size{1.0};    ///< of the objective
  double open{};       ///< gap, rows, recoveries, equalities, duration
  double gradient{};   ///< of the Lagrangian, weighted: it has a second-order effect

  double error() const { return std::max(open, gradient); }
};

/// A primal-dual interior-point loop with Mehrotra's predictor and corrector. `System`, a Newton system:
///   problem(), state() (SegmentPairs with for_each_pair()), objective() without recovery, duration_s();
///   row(side), energy(segment, part), both with value and derivatives; parts() recovered by segment;
///   add_equalities(work, worst) of the residuals of equalities; dual_error(), sum of |gradient x unknown|;
///   factor(), solve() towards Pair::corrected, take(sizes), evaluate().
template <class System>
class InteriorPoint {
 public:
  /// `kinks`, if given, are narrowed with the iterations; without them kinks of the power stay sharp.
  InteriorPoint(System& system, NarrowingKinks* kinks) : system_(system), kinks_(kinks) {}

  FastOutcome run(const FastOptions& options) {
    int at_rest = 0;
    for (iterations_ = 0; iterations_ < options.max_iterations; ++iterations_) {
      const double before = open_.objective;
      measure();
      const double change = std::abs(open_.objective - before);
      at_rest = rests(change, options.tolerance) ? at_rest + 1 : 0;
      if (!std::isfinite(open_.error())) return FastOutcome::no_descent;
      const bool smooth_enough = !kinks_ || kinks_->has_converged();
      if (smooth_enough && (open_.error() <= options.tolerance || at_rest >= kAtRest))
        return FastOutcome::converged;
      if (std::isfinite(options.until_cpu_s) && thread_cpu_s() >= options.until_cpu_s)
        return FastOutcome::time_used;
      if (!iterate(options.tolerance)) return FastOutcome::no_descent;
    }
    return FastOutcome::iterations_used;
  }

  const OpenConditions& open() const { return open_; }
  int iterations() const { return iterations_; }

 private:
  /// A gradient stops falling where slacks reach rounding: a solve is at its end when nothing else is open
  /// and its objective has stood still for this many iterations.
  static constexpr int kAtRest = 6;
  static constexpr double kMostRounding = 1e-5;  ///< of the weighted gradient, relative to the objective
  /// Residuals of the stationarity conditions are much larger numbers than the gap.
  static constexpr double kDualWeight = 1e-3;
  static constexpr double kDefectWeight = 0.1;
  static constexpr double kLeastStep = 1e-8;

  bool rests(double change, double tolerance) const {
    return open_.open <= tolerance && open_.gradient <= kMostRounding && change <= tolerance * open_.size;
  }

  /// Residuals of rows, recoveries and the duration are kept for the next step.
  void measure() {
    auto& state = system_.state();
    const Problem& p = system_.problem();
    double gap = 0, primal = 0, dual = 0, defect = 0;
    open_ = {.objective = system_.objective()};
    state.for_each_pair([&](const Pair& pair) { gap += pair.s * pair.y, ++open_.pairs; });
    open_.mu = open_.pairs > 0 ? gap / static_cast<double>(open_.pairs) : 0.0;
    for (RowSide& side : state.sides) {
      side.residual = side.sign * (side.bound - system_.row(side).value) - side.pair.s;
      primal += std::abs(side.residual) * side.pair.y;
    }
    system_.add_equalities(primal, defect);
    for (std::size_t i = 0; i < state.recoveries.size(); ++i) {
      Recovery& r = state.recoveries[i];
      r.residual = system_.energy(i / system_.parts(), i % system_.parts()).value + r.z.s - r.sum.s;
      primal += std::abs(r.residual);
      open_.objective += p.recovery_weight * r.z.s;
      dual += std::abs(p.recovery_weight - r.z.y - r.sum.y) * r.z.s;
    }
    open_.size = std::max(1e-9, std::abs(open_.objective));
    open_.open = std::max({gap / open_.size, dual / open_.size, primal / open_.size, kDefectWeight * defect});
    TimeRow& time = state.time;
    if (time.exists()) {
      time.residual = p.duration_s - system_.duration_s() - (time.is_budget() ? time.slack.s : 0.0);
      open_.open = std::max(open_.open, std::abs(time.residual) / p.duration_s);
    }
    open_.gradient = kDualWeight * system_.dual_error() / open_.size;
  }

  /// False where no step is left.
  bool iterate(double tolerance) {
    auto& state = system_.state();
    state.for_each_pair([](Pair& pair) { pair.prepare(); });
    for (Recovery& r : state.recoveries) r.inverse_sigma = 1 / (r.z.sigma + r.sum.sigma);
    if (!system_.factor()) return false;
    state.for_each_pair([](Pair& pair) { pair.corrected = 0; });
    const std::optional<StepSizes> affine = system_.solve();
    if (!affine) return false;
    correct(*affine, tolerance);
    const std::optional<StepSizes> sizes = system_.solve();
    if (!sizes) return false;
    system_.take(*sizes);
    if (kinks_) kinks_->narrow(open_.error());
    system_.evaluate();
    return sizes->primal > kLeastStep;
  }

  void correct(const StepSizes& affine, double tolerance) {
    auto& state = system_.state();
    const auto pairs = static_cast<double>(open_.pairs);
    double after = 0;
    state.for_each_pair([&](const Pair& pair) {
      after += (pair.s + affine.primal * pair.ds) * (pair.y + affine.dual * pair.dy);
    });
    const double ratio = open_.pairs > 0 ? after / pairs / open_.mu : 0.0;
    const double least = 0.1 * tolerance * open_.size / (pairs + 1);
    const double target = std::max(least, open_.mu * std::max(1e-4, ratio * ratio));
    const double trust = std::min(affine.primal, affine.dual);
    state.for_each_pair([&](Pair& pair) {
      const double second = trust * trust * pair.ds * pair.dy, most = 10 * target + pair.s * pair.y;
      pair.corrected = target - std::clamp(second, -most, most);
    });
  }

  System& system_;
  NarrowingKinks* kinks_{};
  OpenConditions open_{};
  int iterations_{};
};

/// Steps of the rows, recoveries and the duration's slack, which were eliminated: `change(segment, jet)` is
/// the step of a function, `price` the new multiplier of the duration.
template <class System, class Change>
void expand_segments(System& system, const Change& change, double price, StepSizes& sizes) {
  auto& state = system.state();
  for (RowSide& side : state.sides)
    sizes.move(side.pair, side.residual - side.sign * change(side.segment, system.row(side)));
  for (std::size_t i = 0; i < state.recoveries.size(); ++i) {
    Recovery& r = state.recoveries[i];
    const std::size_t segment = i / system.parts();
    const double moved = change(segment, system.energy(segment, i % system.parts())) + r.residual;
    sizes.move(r.z, -(r.excess(system.problem().recovery_weight) + r.sum.sigma * moved) * r.inverse_sigma);
    sizes.move(r.sum, moved + r.z.ds);
  }
  if (state.time.is_budget()) sizes.move_budget(state.time.slack, price);
}

}  // namespace joulepath::nlp
