#include "planner/nlp/fast_solver.hpp"

#include <algorithm>
#include <cmath>

#include "planner/nlp/segment_jets.hpp"
#include "planner/nlp/tridiagonal.hpp"

namespace joulepath::nlp {
namespace {

constexpr double kToBoundary = 0.995;
constexpr double kDualWeight = 1e-3;

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

/// One side of an active row: c = sign (bound - g) >= 0, with a slack.
struct RowSide {
  std::size_t row{};
  double sign{};
  double bound{};
  Pair pair{};
  double residual{};  ///< c - s
};

/// Energy recovered by one channel of one segment: z >= 0 and E + z >= 0, with a slack for the latter.
struct Recovery {
  Pair z{};
  Pair sum{};
  double residual{};       ///< E + z - s
  double inverse_sigma{};  ///< 1/(sum of both sigmas), of this iteration
};

/// Solver state and one Newton system; b of the inner nodes is the unknown.
class FastSolver {
 public:
  FastSolver(const Problem& problem, const std::vector<double>& guess) : p_(problem), b_(guess) {
    const std::size_t n = p_.unknown_count();
    jets_.resize(p_.segment_count());
    rows_.resize(p_.rows.size());
    for (auto* v : {&gradient_, &step_, &time_gradient_, &time_solved_, &dual_residual_}) v->assign(n, 0.0);
    low_.resize(n);
    high_.resize(n);
    hessian_ = Tridiagonal(n);
  }

  Solution solve(const FastOptions& options) {
    tolerance_ = options.tolerance;
    start();
    Solution solution;
    int& i = solution.iterations;
    for (; i < options.max_iterations; ++i) {
      measure();
      if (!std::isfinite(error_)) break;
      if (error_ <= options.tolerance) {
        solution.converged = true;
        break;
      }
      if (!iterate()) break;
    }
    if (!solution.converged)
      solution.message = i >= options.max_iterations ? "no convergence within its iterations" : "no descent";
    fill(solution);
    return solution;
  }

 private:
  bool has_duration() const { return p_.duration_row != DurationRow::none; }
  bool equality() const { return p_.duration_row == DurationRow::equal; }

  void evaluate() {
    objective_ = 0;
    duration_ = 0;
    for (std::size_t k = 0; k < p_.segment_count(); ++k) {
      jets_[k] = segment_jets(p_.segments[k], b_[k], b_[k + 1]);
      objective_ += p_.energy_weight * (jets_[k].energy_J[0].value + jets_[k].energy_J[1].value) +
                    p_.time_weight_W * jets_[k].duration_s.value;
      duration_ += jets_[k].duration_s.value;
    }
    for (std::size_t k = 0; k < p_.segment_count(); ++k) {
      if (p_.first_row[k] == p_.first_row[k + 1]) continue;
      if (rows_known_ && linear_rows_only(k)) {
        const double a = b_[k], c = b_[k + 1];
        for (std::size_t i = p_.first_row[k]; i < p_.first_row[k + 1]; ++i)
          rows_[i].value = rows_[i].d[0] * a + rows_[i].d[1] * c + constant_[i];
        continue;
      }
      const Interval<Jet> interval = jet_interval(p_.segments[k], b_[k], b_[k + 1]);
      for (std::size_t i = p_.first_row[k]; i < p_.first_row[k + 1]; ++i)
        rows_[i] = evaluate_row(p_, p_.rows[i], interval);
    }
    if (rows_known_) return;
    rows_known_ = true;
    constant_.resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::size_t k = p_.rows[i].segment;
      constant_[i] = rows_[i].value - rows_[i].d[0] * b_[k] - rows_[i].d[1] * b_[k + 1];
    }
  }

  /// Terms 0..2 of the formulation (the three accelerations) are linear in b.
  bool linear_rows_only(std::size_t k) const {
    for (std::size_t i = p_.first_row[k]; i < p_.first_row[k + 1]; ++i)
      if (p_.rows[i].term > 2) return false;
    return true;
  }

  void start() {
    for (std::size_t k = 0; k < p_.unknown_count(); ++k) {
      const double cap = p_.cap[k + 1].squared;
      b_[k + 1] = std::clamp(b_[k + 1], std::min(1e-12, 1e-3 * cap), cap * (1 - 1e-6));
    }
    evaluate();
    const double size = std::max(1e-6, std::abs(objective_));
    const double mu = 1e-2 * size / static_cast<double>(p_.segment_count());
    for (std::size_t k = 0; k < p_.unknown_count(); ++k) {
      low_[k] = {.s = b_[k + 1], .y = mu / b_[k + 1]};
      const double room = p_.cap[k + 1].squared - b_[k + 1];
      high_[k] = std::isfinite(room) ? Pair{.s = room, .y = mu / room} : Pair{};
    }
    for (std::size_t i = 0; i < p_.rows.size(); ++i) {
      const Bounds& bounds = p_.rows[i].bounds;
      const double scale = std::isfinite(bounds.high) ? std::abs(bounds.high) : std::abs(bounds.low);
      for (double sign : {1.0, -1.0}) {
        const double bound = sign > 0 ? bounds.high : bounds.low;
        if (!std::isfinite(bound)) continue;
        const double s = std::max(sign * (bound - rows_[i].value), 1e-3 * scale);
        sides_.push_back({.row = i, .sign = sign, .bound = bound, .pair = {.s = s, .y = mu / s}});
      }
    }
    recoveries_.resize(p_.segment_count() * p_.channels);
    for (std::size_t r = 0; r < recoveries_.size(); ++r) {
      const double E = energy_of(r).value, half = 0.5 * p_.recovery_weight;
      const double z = std::max(0.0, -E) + 0.1 * std::abs(E) + mu / half;
      recoveries_[r].z = {.s = z, .y = std::clamp(mu / z, 0.05 * half, half)};
      const double s = E + z;
      recoveries_[r].sum = {.s = s, .y = p_.recovery_weight - recoveries_[r].z.y};
    }
    if (has_duration() && !equality()) {
      const double s = std::max(p_.duration_s - duration_, 1e-3 * p_.duration_s);
      time_ = {.s = s, .y = std::min(0.05 * size / s, 0.2 * size / p_.duration_s)};
    }
  }

  const Jet& energy_of(std::size_t r) const { return jets_[r / p_.channels].energy_J[r % p_.channels]; }

  template <class Function>
  void for_each_pair(Function&& use) {
    for (Pair& pair : low_) use(pair);
    for (Pair& pair : high_)
      if (pair.s > 0) use(pair);
    for (RowSide& side : sides_) use(side.pair);
    for (Recovery& recovery : recoveries_) {
      use(recovery.z);
      use(recovery.sum);
    }
    if (has_duration() && !equality()) use(time_);
  }

  void add_gradient(std::size_t segment, double g0, double g1, std::vector<double>& to) const {
    if (segment > 0) to[segment - 1] += g0;
    if (segment < to.size()) to[segment] += g1;
  }

  void add_hessian(std::size_t segment, double h00, double h01, double h11) {
    const std::size_t n = hessian_.diagonal.size();
    if (segment > 0) hessian_.diagonal[segment - 1] += h00;
    if (segment < n) hessian_.diagonal[segment] += h11;
    if (segment > 0 && segment < n) hessian_.below[segment - 1] += h01;
  }

  /// Residuals of the optimality conditions at the current point, relative to the objective.
  void measure() {
    double gap = 0;
    std::size_t count = 0;
    for_each_pair([&](Pair& pair) {
      gap += pair.s * pair.y;
      ++count;
    });
    mu_ = count > 0 ? gap / static_cast<double>(count) : 0.0;
    double primal = 0;
    for (RowSide& side : sides_) {
      side.residual = side.sign * (side.bound - rows_[side.row].value) - side.pair.s;
      primal += std::abs(side.residual) * side.pair.y;
    }
    double total = objective_;
    for (std::size_t r = 0; r < recoveries_.size(); ++r) {
      Recovery& recovery = recoveries_[r];
      recovery.residual = energy_of(r).value + recovery.z.s - recovery.sum.s;
      primal += std::abs(recovery.residual);
      total += p_.recovery_weight * recovery.z.s;
    }
    time_residual_ = has_duration() ? p_.duration_s - duration_ - (equality() ? 0.0 : time_.s) : 0.0;
    std::fill(dual_residual_.begin(), dual_residual_.end(), 0.0);
    lagrangian_gradient(dual_residual_);
    double dual = 0, dual_z = 0;
    for (std::size_t k = 0; k < dual_residual_.size(); ++k) {
      const double r = dual_residual_[k] - low_[k].y + high_[k].y;
      dual += std::abs(r) * b_[k + 1];
    }
    for (const Recovery& recovery : recoveries_)
      dual_z += std::abs(p_.recovery_weight - recovery.z.y - recovery.sum.y) * recovery.z.s;
    const double size = std::max(1e-9, std::abs(total));
    total_ = total;
    gap_ = gap / size;
    // A gradient's error counts in second order; it stops falling where slacks reach rounding.
    error_ = std::max({gap_, kDualWeight * dual / size, dual_z / size, primal / size,
                       has_duration() ? std::abs(time_residual_) / p_.duration_s : 0.0});
  }

  /// Gradient of the Lagrangian by b with the current multipliers, bounds left out.
  void lagrangian_gradient(std::vector<double>& to) const {
    const double weight = p_.time_weight_W + multiplier_of_time();
    for (std::size_t k = 0; k < p_.segment_count(); ++k) {
      const SegmentJets& j = jets_[k];
      double g0 = weight * j.duration_s.d[0], g1 = weight * j.duration_s.d[1];
      for (std::size_t c = 0; c < 2; ++c) {
        const double part =
            p_.energy_weight - (c < p_.channels ? recoveries_[k * p_.channels + c].sum.y : 0.0);
        g0 += part * j.energy_J[c].d[0];
        g1 += part * j.energy_J[c].d[1];
      }
      add_gradient(k, g0, g1, to);
    }
    for (const RowSide& side : sides_) {
      const Jet& g = rows_[side.row];
      const double y = side.sign * side.pair.y;
      add_gradient(p_.rows[side.row].segment, y * g.d[0], y * g.d[1], to);
    }
  }

  double multiplier_of_time() const { return !has_duration() ? 0.0 : equality() ? lambda_ : time_.y; }

  void prepare() {
    for_each_pair([](Pair& pair) { pair.prepare(); });
    for (Recovery& r : recoveries_) r.inverse_sigma = 1 / (r.z.sigma + r.sum.sigma);
  }

  bool assemble() {
    prepare();
    std::fill(hessian_.diagonal.begin(), hessian_.diagonal.end(), 0.0);
    std::fill(hessian_.below.begin(), hessian_.below.end(), 0.0);
    const double weight = p_.time_weight_W + multiplier_of_time();
    for (std::size_t k = 0; k < p_.segment_count(); ++k) {
      const SegmentJets& j = jets_[k];
      double h00 = weight * j.duration_s.dd[0], h01 = weight * j.duration_s.dd[1],
             h11 = weight * j.duration_s.dd[2];
      for (std::size_t c = 0; c < 2; ++c) {
        const Jet& E = j.energy_J[c];
        double part = p_.energy_weight;
        if (c < p_.channels) {
          const Recovery& r = recoveries_[k * p_.channels + c];
          part -= r.sum.y;
          const double sigma = r.z.sigma * r.sum.sigma * r.inverse_sigma;
          h00 += sigma * E.d[0] * E.d[0];
          h01 += sigma * E.d[0] * E.d[1];
          h11 += sigma * E.d[1] * E.d[1];
        }
        h00 += part * E.dd[0];
        h01 += part * E.dd[1];
        h11 += part * E.dd[2];
      }
      add_hessian(k, h00, h01, h11);
    }
    for (const RowSide& side : sides_) {
      const Jet& g = rows_[side.row];
      const double sigma = side.pair.sigma, y = side.sign * side.pair.y;
      add_hessian(p_.rows[side.row].segment, sigma * g.d[0] * g.d[0] + y * g.dd[0],
                  sigma * g.d[0] * g.d[1] + y * g.dd[1], sigma * g.d[1] * g.d[1] + y * g.dd[2]);
    }
    for (std::size_t k = 0; k < low_.size(); ++k) {
      hessian_.diagonal[k] += low_[k].sigma;
      if (high_[k].s > 0) hessian_.diagonal[k] += high_[k].sigma;
    }
    return factor_regularized();
  }

  bool factor_regularized() {
    const Tridiagonal original = hessian_;
    double shift = 0;
    for (int i = 0; i < 12; ++i) {
      if (hessian_.factor()) return true;
      shift = shift == 0 ? 1e-3 : 10 * shift;
      hessian_ = original;
      for (std::size_t k = 0; k < low_.size(); ++k)
        hessian_.diagonal[k] += shift * (std::abs(original.diagonal[k]) + 1e-6);
    }
    return false;
  }

  /// Newton step for the complementarities wanted (Pair::corrected).
  void newton() {
    std::fill(gradient_.begin(), gradient_.end(), 0.0);
    for (std::size_t k = 0; k < p_.segment_count(); ++k) {
      const SegmentJets& j = jets_[k];
      double g0 = p_.time_weight_W * j.duration_s.d[0], g1 = p_.time_weight_W * j.duration_s.d[1];
      for (std::size_t c = 0; c < 2; ++c) {
        double part = p_.energy_weight;
        if (c < p_.channels) {
          const Recovery& r = recoveries_[k * p_.channels + c];
          const double wanted = r.sum.corrected * r.sum.inverse;
          const double excess = p_.recovery_weight - r.z.corrected * r.z.inverse - wanted;
          part += -wanted + r.sum.sigma * (r.z.sigma * r.residual - excess) * r.inverse_sigma;
        }
        g0 += part * j.energy_J[c].d[0];
        g1 += part * j.energy_J[c].d[1];
      }
      add_gradient(k, g0, g1, gradient_);
    }
    for (const RowSide& side : sides_) {
      const Jet& g = rows_[side.row];
      const double y = side.sign * (side.pair.corrected - side.pair.y * side.residual) * side.pair.inverse;
      add_gradient(p_.rows[side.row].segment, y * g.d[0], y * g.d[1], gradient_);
    }
    for (std::size_t k = 0; k < low_.size(); ++k) {
      gradient_[k] -= low_[k].corrected * low_[k].inverse;
      if (high_[k].s > 0) gradient_[k] += high_[k].corrected * high_[k].inverse;
    }
    for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = -gradient_[k];
    hessian_.solve(step_);
    border();
    expand();
  }

  /// The duration row: one more unknown, its multiplier.
  void border() {
    new_lambda_ = 0;
    if (!has_duration()) return;
    std::fill(time_gradient_.begin(), time_gradient_.end(), 0.0);
    for (std::size_t k = 0; k < p_.segment_count(); ++k)
      add_gradient(k, jets_[k].duration_s.d[0], jets_[k].duration_s.d[1], time_gradient_);
    time_solved_ = time_gradient_;
    hessian_.solve(time_solved_);
    double curvature = equality() ? 0.0 : time_.s / time_.y, along = 0;
    for (std::size_t k = 0; k < step_.size(); ++k) {
      curvature += time_gradient_[k] * time_solved_[k];
      along += time_gradient_[k] * step_[k];
    }
    const double centering = equality() ? 0.0 : time_.corrected / time_.y;
    new_lambda_ = (along + centering - time_residual_) / curvature;
    for (std::size_t k = 0; k < step_.size(); ++k) step_[k] -= new_lambda_ * time_solved_[k];
  }

  /// Steps of everything that was eliminated.
  void expand() {
    const auto step_at = [&](std::size_t node) {
      return node == 0 || node == b_.size() - 1 ? 0.0 : step_[node - 1];
    };
    for (std::size_t k = 0; k < low_.size(); ++k) {
      low_[k].ds = step_[k];
      low_[k].dual_step();
      if (!(high_[k].s > 0)) continue;
      high_[k].ds = -step_[k];
      high_[k].dual_step();
    }
    for (RowSide& side : sides_) {
      const Jet& g = rows_[side.row];
      const std::size_t k = p_.rows[side.row].segment;
      side.pair.ds = -side.sign * (g.d[0] * step_at(k) + g.d[1] * step_at(k + 1)) + side.residual;
      side.pair.dual_step();
    }
    for (std::size_t i = 0; i < recoveries_.size(); ++i) {
      Recovery& r = recoveries_[i];
      const Jet& E = energy_of(i);
      const std::size_t k = i / p_.channels;
      const double moved = E.d[0] * step_at(k) + E.d[1] * step_at(k + 1) + r.residual;
      const double excess =
          p_.recovery_weight - r.z.corrected * r.z.inverse - r.sum.corrected * r.sum.inverse;
      r.z.ds = -(excess + r.sum.sigma * moved) * r.inverse_sigma;
      r.sum.ds = moved + r.z.ds;
      r.z.dual_step();
      r.sum.dual_step();
    }
    if (has_duration() && !equality()) {
      time_.dy = new_lambda_ - time_.y;
      time_.ds = (time_.corrected - time_.s * new_lambda_) / time_.y;
    }
  }

  struct StepSizes {
    double primal{1.0}, dual{1.0};
  };

  StepSizes longest_steps() {
    StepSizes longest;
    for_each_pair([&](Pair& pair) {
      if (pair.s + longest.primal * pair.ds < (1 - kToBoundary) * pair.s)
        longest.primal = -kToBoundary * pair.s / pair.ds;
      if (pair.y + longest.dual * pair.dy < (1 - kToBoundary) * pair.y)
        longest.dual = -kToBoundary * pair.y / pair.dy;
    });
    return longest;
  }

  bool iterate() {
    if (!assemble()) return false;
    for_each_pair([](Pair& pair) { pair.corrected = 0; });
    newton();
    const StepSizes affine = longest_steps();
    double after = 0;
    std::size_t count = 0;
    for_each_pair([&](Pair& pair) {
      after += (pair.s + affine.primal * pair.ds) * (pair.y + affine.dual * pair.dy);
      ++count;
    });
    const double ratio = count > 0 ? after / static_cast<double>(count) / mu_ : 0.0;
    const double least = 0.1 * tolerance_ * std::max(1e-9, std::abs(total_)) / static_cast<double>(count + 1);
    const double target = std::max(least, mu_ * std::max(1e-4, ratio * ratio * ratio));
    const double trust = std::min(affine.primal, affine.dual);
    for_each_pair([&](Pair& pair) {
      const double second = trust * trust * pair.ds * pair.dy;
      pair.corrected =
          target - std::clamp(second, -10 * target - pair.s * pair.y, 10 * target + pair.s * pair.y);
    });
    newton();
    const StepSizes steps = longest_steps();
    take(steps);
    return steps.primal > 1e-8;
  }

  void take(const StepSizes& steps) {
    for (std::size_t k = 0; k < step_.size(); ++k) b_[k + 1] += steps.primal * step_[k];
    for_each_pair([&](Pair& pair) {
      pair.s += steps.primal * pair.ds;
      pair.y += steps.dual * pair.dy;
    });
    if (equality()) lambda_ += steps.dual * (new_lambda_ - lambda_);
    for (std::size_t k = 0; k < low_.size(); ++k) low_[k].s = b_[k + 1];
    evaluate();
  }

  void fill(Solution& solution) const {
    solution.b = b_;
    solution.objective = total_;
    solution.price_W = multiplier_of_time();
    solution.row_multiplier.assign(p_.rows.size(), 0.0);
    for (const RowSide& side : sides_) solution.row_multiplier[side.row] += side.sign * side.pair.y;
    for (const Recovery& recovery : recoveries_) {
      solution.z.push_back(recovery.z.s);
      solution.recovery_multiplier.push_back(recovery.sum.y);
    }
  }

  const Problem& p_;
  std::vector<double> b_;
  std::vector<SegmentJets> jets_{};
  std::vector<Jet> rows_{};
  std::vector<double> constant_{};
  bool rows_known_{};
  std::vector<Pair> low_{}, high_{};
  std::vector<RowSide> sides_{};
  std::vector<Recovery> recoveries_{};
  Pair time_{};
  double lambda_{}, new_lambda_{};
  double objective_{}, total_{}, duration_{}, time_residual_{};
  double mu_{}, gap_{}, error_{}, tolerance_{};
  std::vector<double> gradient_{}, step_{}, time_gradient_{}, time_solved_{}, dual_residual_{};
  Tridiagonal hessian_{};
};

}  // namespace

Solution solve_fast(const Problem& problem, const std::vector<double>& b_guess, const FastOptions& options) {
  return FastSolver(problem, b_guess).solve(options);
}

}  // namespace joulepath::nlp
