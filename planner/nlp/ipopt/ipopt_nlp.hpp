#pragma once

// The adapter of a SegmentProgram to Ipopt; included by ipopt_solver.cpp alone.

#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>

#include "planner/nlp/transcription/segment_program.hpp"
#include "planner/nlp/transcription/solution.hpp"

namespace joulepath::nlp {

/// Unknowns: those of the program, then z by segment and recovered part of energy. Rows: the program's by
/// segment, E + z by segment and part, the duration. Ipopt sums entries of a node that two segments share.
template <SegmentProgram Program>
class IpoptNlp : public Ipopt::TNLP {
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;
  static constexpr std::size_t kLocal = Program::kLocal;
  using Real = JetOf<kLocal>;
  static constexpr Number kInfinity = 2e19;

 public:
  /// `first_mu`: the barrier parameter that Ipopt begins with (mu_init). `near` (may be null): a solution of
  /// another solver on the same problem, for its multipliers.
  IpoptNlp(const Program& program, ProgramSolution& solution, double first_mu, const Solution* near)
      : program_(program),
        p_(program.problem()),
        solution_(solution),
        near_(near),
        first_mu_(first_mu),
        values_(p_.segment_count()),
        recovered_(p_.channels * Program::kParts),
        unknowns_(static_cast<Index>(program.unknown_count())),
        recoveries_(static_cast<Index>(p_.segment_count() * recovered_)),
        has_duration_(p_.duration_row != DurationRow::none) {
    first_row_.push_back(0);
    for (std::size_t k = 0; k < p_.segment_count(); ++k)
      first_row_.push_back(first_row_.back() + static_cast<Index>(program.row_count(k)));
    for (std::size_t i = 0; i < program.unknown_count(); ++i) start_.push_back(program.start(i));
    update(start_.data(), true);
  }

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac, Index& nnz_hess, IndexStyleEnum& style) override {
    n = unknowns_ + recoveries_;
    m = row_count() + recoveries_ + (has_duration_ ? 1 : 0);
    nnz_jac = nnz_hess = 0;
    for_jacobian([&](Index, Index, double) { ++nnz_jac; });
    for_hessian(nullptr, 0, [&](Index, Index, double) { ++nnz_hess; });
    style = TNLP::C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* low, Number* high, Index m, Number* g_low, Number* g_high) override {
    std::fill(low, low + n, 0.0);
    std::fill(high, high + n, kInfinity);
    for (Index i = 0; i < unknowns_; ++i)
      set(program_.unknown_bounds(static_cast<std::size_t>(i)), low[i], high[i]);
    std::fill(g_low, g_low + m, 0.0);
    std::fill(g_high, g_high + m, kInfinity);
    for (std::size_t k = 0, row = 0; k < p_.segment_count(); ++k)
      for (std::size_t i = 0; i < program_.row_count(k); ++i, ++row)
        set(program_.row_bounds(k, i), g_low[row], g_high[row]);
    if (has_duration_)
      set({p_.duration_row == DurationRow::equal ? p_.duration_s : -kNoLimit, p_.duration_s}, g_low[m - 1],
          g_high[m - 1]);
    return true;
  }

  bool get_starting_point(Index, bool, Number* x, bool with_bounds, Number* z_low, Number* z_high, Index,
                          bool with_rows, Number* lambda) override {
    std::copy(start_.begin(), start_.end(), x);
    update(x, true);
    for_channels([&](std::size_t k, std::size_t c, Index i) {
      // On the central path of Ipopt's first barrier problem: mu/z + mu/(E + z) = weight.
      const double E = values_[k].energy_J[c].value, width = 2 * first_mu_ / p_.recovery_weight;
      x[unknowns_ + i] = 0.5 * (width - E + std::hypot(E, width));
    });
    if (with_rows) start_multipliers(lambda);
    if (with_rows && with_bounds) start_bound_multipliers(x, lambda, z_low, z_high);
    return true;
  }

  bool eval_f(Index, const Number* x, bool fresh, Number& value) override {
    update(x, fresh);
    value = 0;
    for (std::size_t k = 0; k < values_.size(); ++k) value += cost(k).value;
    for (Index i = 0; i < recoveries_; ++i) value += p_.recovery_weight * x[unknowns_ + i];
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool fresh, Number* gradient) override {
    update(x, fresh);
    std::fill(gradient, gradient + unknowns_, 0.0);
    std::fill(gradient + unknowns_, gradient + n, p_.recovery_weight);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const Real jet = cost(k);
      for_gradient(k, jet, [&](Index column, double value) { gradient[column] += value; });
    }
    return true;
  }

  bool eval_g(Index, const Number* x, bool fresh, Index m, Number* g) override {
    update(x, fresh);
    for (const SegmentValues<kLocal>& values : values_)
      for (const Real& row : values.rows) *g++ = row.value;
    for_channels([&](std::size_t k, std::size_t c, Index i) {
      g[i] = values_[k].energy_J[c].value + x[unknowns_ + i];
    });
    if (!has_duration_) return true;
    Number& duration = g[m - 1 - row_count()];
    duration = 0;
    for (const SegmentValues<kLocal>& values : values_) duration += values.duration_s.value;
    return true;
  }

  bool eval_jac_g(Index, const Number* x, bool fresh, Index, Index, Index* row, Index* column,
                  Number* values) override {
    if (values != nullptr) update(x, fresh);
    for_jacobian([&](Index r, Index c, double value) {
      if (values != nullptr)
        *values++ = value;
      else
        *row++ = r, *column++ = c;
    });
    return true;
  }

  bool eval_h(Index, const Number* x, bool fresh, Number factor, Index, const Number* lambda, bool, Index,
              Index* row, Index* column, Number* values) override {
    if (values != nullptr) update(x, fresh);
    for_hessian(values != nullptr ? lambda : nullptr, factor, [&](Index r, Index c, double value) {
      if (values != nullptr)
        *values++ = value;
      else
        *row++ = r, *column++ = c;
    });
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn status, Index n, const Number* x, const Number*, const Number*,
                         Index m, const Number*, const Number* lambda, Number value, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution_.converged = status == Ipopt::SUCCESS || status == Ipopt::STOP_AT_ACCEPTABLE_POINT;
    solution_.x.assign(x, x + unknowns_);
    solution_.z.assign(x + unknowns_, x + n);
    solution_.objective = value;
    solution_.row_multiplier.assign(lambda, lambda + row_count());
    for (Index i = 0; i < recoveries_; ++i)
      solution_.recovery_multiplier.push_back(std::max(0.0, -lambda[row_count() + i]));
    solution_.price_W = has_duration_ ? lambda[m - 1] : 0.0;
  }

 private:
  static void set(const Bounds& bounds, Number& low, Number& high) {
    low = std::max(bounds.low, -kInfinity);
    high = std::min(bounds.high, kInfinity);
  }

  /// Those of `near_`, in Ipopt's signs: L = f + lambda g.
  void start_multipliers(Number* lambda) const {
    lambda = std::copy(near_->row_multiplier.begin(), near_->row_multiplier.end(), lambda);
    for (const double multiplier : near_->recovery_multiplier) *lambda++ = -multiplier;
    if (has_duration_) *lambda = near_->price_W;
  }

  /// Those that make the Lagrangian stationary, and no less than on the central path.
  void start_bound_multipliers(const Number* x, const Number* lambda, Number* z_low, Number* z_high) const {
    std::vector<double> slope(static_cast<std::size_t>(unknowns_), 0.0);
    for (std::size_t k = 0; k < values_.size(); ++k)
      for_gradient(k, lagrangian(lambda, 1.0, k),
                   [&](Index column, double value) { slope[static_cast<std::size_t>(column)] += value; });
    const auto on_path = [&](double room) { return first_mu_ / std::max(room, first_mu_); };
    for (Index i = 0; i < unknowns_; ++i) {
      const auto [low, high] = program_.unknown_bounds(static_cast<std::size_t>(i));
      const double own = slope[static_cast<std::size_t>(i)];
      z_low[i] = std::max(own, on_path(x[i] - low));
      z_high[i] = std::isfinite(high) ? std::max(-own, on_path(high - x[i])) : 0.0;
    }
    for (Index i = 0; i < recoveries_; ++i) {
      z_low[unknowns_ + i] =
          std::max(p_.recovery_weight + lambda[row_count() + i], on_path(x[unknowns_ + i]));
      z_high[unknowns_ + i] = 0.0;
    }
  }

  Index row_count() const { return first_row_.back(); }

  Real cost(std::size_t k) const {
    const SegmentValues<kLocal>& values = values_[k];
    Real sum = p_.time_weight_W * values.duration_s;
    for (const Real& part_J : values.energy_J) sum += p_.energy_weight * part_J;
    return sum;
  }

  void update(const Number* x, bool fresh) {
    if (!fresh) return;
    for (std::size_t k = 0; k < values_.size(); ++k) program_.evaluate(x, k, values_[k]);
  }

  /// Calls use(segment, part of energy, index of its z).
  template <class Function>
  void for_channels(Function&& use) const {
    for (std::size_t k = 0, i = 0; k < values_.size(); ++k)
      for (std::size_t c = 0; c < recovered_; ++c, ++i) use(k, c, static_cast<Index>(i));
  }

  /// Calls use(column, derivative) for the unknowns.
  template <class Function>
  void for_gradient(std::size_t k, const Real& jet, Function&& use) const {
    const Columns<kLocal> columns = program_.columns(k);
    for (std::size_t i = 0; i < kLocal; ++i)
      if (columns[i] != kFixed) use(columns[i], jet.d[i]);
  }

  /// Calls use(row, column, value) with the values of the last update.
  template <class Function>
  void for_jacobian(Function&& use) const {
    for (std::size_t k = 0; k < values_.size(); ++k) {
      Index row = first_row_[k];
      for (const Real& jet : values_[k].rows) {
        for_gradient(k, jet, [&](Index column, double value) { use(row, column, value); });
        ++row;
      }
    }
    for_channels([&](std::size_t k, std::size_t c, Index i) {
      const Index row = row_count() + i;
      for_gradient(k, values_[k].energy_J[c], [&](Index column, double value) { use(row, column, value); });
      use(row, unknowns_ + i, 1.0);
    });
    if (!has_duration_) return;
    const Index row = row_count() + recoveries_;
    for (std::size_t k = 0; k < values_.size(); ++k)
      for_gradient(k, values_[k].duration_s, [&](Index column, double value) { use(row, column, value); });
  }

  /// Calls use(row, column, value) for the lower half of the Lagrangian's Hessian.
  template <class Function>
  void for_hessian(const Number* lambda, Number factor, Function&& use) const {
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const Real sum = lambda != nullptr ? lagrangian(lambda, factor, k) : Real{};
      const Columns<kLocal> columns = program_.columns(k);
      for (std::size_t i = 0, at = 0; i < kLocal; ++i)
        for (std::size_t j = 0; j <= i; ++j, ++at) {
          if (columns[i] == kFixed || columns[j] == kFixed) continue;
          use(std::max(columns[i], columns[j]), std::min(columns[i], columns[j]), sum.dd[at]);
        }
    }
  }

  Real lagrangian(const Number* lambda, Number factor, std::size_t k) const {
    const SegmentValues<kLocal>& values = values_[k];
    Real sum = factor * cost(k);
    for (std::size_t i = 0; i < values.rows.size(); ++i)
      sum += lambda[first_row_[k] + static_cast<Index>(i)] * values.rows[i];
    for (std::size_t c = 0; c < recovered_; ++c)
      sum += lambda[row_count() + static_cast<Index>(k * recovered_ + c)] * values.energy_J[c];
    if (has_duration_) sum += lambda[row_count() + recoveries_] * values.duration_s;
    return sum;
  }

  const Program& program_;
  const Problem& p_;
  ProgramSolution& solution_;
  const Solution* near_;
  double first_mu_;
  std::vector<SegmentValues<kLocal>> values_;  ///< of the last point
  std::vector<double> start_{};
  std::vector<Index> first_row_{};  ///< per segment, and one past the last
  std::size_t recovered_;           ///< separately recovered parts of energy per segment
  Index unknowns_, recoveries_;
  bool has_duration_;
};

}  // namespace joulepath::nlp
