#include "planner/nlp/ipopt_solver.hpp"

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "planner/nlp/segment_jets.hpp"

namespace joulepath::nlp {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr Number kInfinity = 2e19;

Number bounded(double value) { return std::clamp(value, -kInfinity, kInfinity); }

/// Everything that a Problem says at one point, with derivatives; filled once per point.
struct Evaluation {
  std::vector<Jet> energy{};    ///< [segment][2]
  std::vector<Jet> duration{};  ///< [segment]
  std::vector<Jet> row{};       ///< [active row]
};

/// Unknowns: b at the inner nodes, then z by segment and channel. Rows: the active rows, E + z by segment
/// and channel, the duration.
class PathNlp : public Ipopt::TNLP {
 public:
  PathNlp(const Problem& problem, const std::vector<double>& guess, Solution& solution)
      : p_(problem),
        guess_(guess),
        solution_(solution),
        inner_(static_cast<Index>(problem.unknown_count())),
        segments_(static_cast<Index>(problem.segment_count())),
        channels_(static_cast<Index>(problem.channels)),
        rows_(static_cast<Index>(problem.rows.size())),
        has_duration_(problem.duration_row != DurationRow::none) {}

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac, Index& nnz_hess, IndexStyleEnum& style) override {
    n = inner_ + segments_ * channels_;
    m = rows_ + segments_ * channels_ + (has_duration_ ? 1 : 0);
    nnz_jac = nnz_hess = 0;
    for_jacobian([&](Index, Index, double) { ++nnz_jac; });
    for_hessian(nullptr, 0, [&](Index, Index, double) { ++nnz_hess; });
    style = TNLP::C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* low, Number* high, Index m, Number* g_low, Number* g_high) override {
    for (Index k = 0; k < inner_; ++k) {
      low[k] = 0;
      high[k] = bounded(p_.cap[static_cast<std::size_t>(k + 1)].squared);
    }
    for (Index i = inner_; i < n; ++i) {
      low[i] = 0;
      high[i] = kInfinity;
    }
    for (Index i = 0; i < rows_; ++i) {
      g_low[i] = bounded(p_.rows[static_cast<std::size_t>(i)].bounds.low);
      g_high[i] = bounded(p_.rows[static_cast<std::size_t>(i)].bounds.high);
    }
    for (Index i = rows_; i < m; ++i) {
      g_low[i] = 0;
      g_high[i] = kInfinity;
    }
    if (has_duration_) {
      g_low[m - 1] = p_.duration_row == DurationRow::equal ? p_.duration_s : -kInfinity;
      g_high[m - 1] = p_.duration_s;
    }
    return true;
  }

  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    for (Index k = 0; k < inner_; ++k) x[k] = guess_[static_cast<std::size_t>(k + 1)];
    for (Index k = 0; k < segments_; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const auto energy = Energy::both(plain_interval(p_.segments[at], guess_[at], guess_[at + 1]));
      for (Index c = 0; c < channels_; ++c)
        x[z_index(k, c)] = std::max(0.0, -energy[static_cast<std::size_t>(c)]) + 1e-2;
    }
    return true;
  }

  bool eval_f(Index, const Number* x, bool fresh, Number& value) override {
    update(x, fresh);
    value = 0;
    for (std::size_t k = 0; k < p_.segment_count(); ++k) value += cost(k).value;
    for (Index i = 0; i < segments_ * channels_; ++i) value += p_.recovery_weight * x[inner_ + i];
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool fresh, Number* gradient) override {
    update(x, fresh);
    std::fill(gradient, gradient + inner_, 0.0);
    std::fill(gradient + inner_, gradient + n, p_.recovery_weight);
    for (Index k = 0; k < segments_; ++k) {
      const Jet jet = cost(static_cast<std::size_t>(k));
      if (k > 0) gradient[k - 1] += jet.d0;
      if (k < inner_) gradient[k] += jet.d1;
    }
    return true;
  }

  bool eval_g(Index, const Number* x, bool fresh, Index m, Number* g) override {
    update(x, fresh);
    for (Index i = 0; i < rows_; ++i) g[i] = at_.row[static_cast<std::size_t>(i)].value;
    for (Index k = 0; k < segments_; ++k)
      for (Index c = 0; c < channels_; ++c)
        g[rows_ + k * channels_ + c] = energy(k, c).value + x[z_index(k, c)];
    if (has_duration_) {
      g[m - 1] = 0;
      for (const Jet& dt : at_.duration) g[m - 1] += dt.value;
    }
    return true;
  }

  bool eval_jac_g(Index, const Number* x, bool fresh, Index, Index, Index* row, Index* column,
                  Number* values) override {
    Index i = 0;
    if (values == nullptr) {
      for_jacobian([&](Index r, Index c, double) {
        row[i] = r;
        column[i++] = c;
      });
      return true;
    }
    update(x, fresh);
    for_jacobian([&](Index, Index, double value) { values[i++] = value; });
    return true;
  }

  bool eval_h(Index, const Number* x, bool fresh, Number factor, Index, const Number* lambda, bool, Index,
              Index* row, Index* column, Number* values) override {
    Index i = 0;
    if (values == nullptr) {
      for_hessian(nullptr, 0, [&](Index r, Index c, double) {
        row[i] = r;
        column[i++] = c;
      });
      return true;
    }
    update(x, fresh);
    for_hessian(lambda, factor, [&](Index, Index, double value) { values[i++] = value; });
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn status, Index, const Number* x, const Number*, const Number*,
                         Index m, const Number*, const Number* lambda, Number value, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution_.converged = status == Ipopt::SUCCESS || status == Ipopt::STOP_AT_ACCEPTABLE_POINT;
    solution_.b.assign(1, p_.b_start);
    for (Index k = 0; k < inner_; ++k)
      solution_.b.push_back(std::clamp(x[k], 0.0, p_.cap[static_cast<std::size_t>(k + 1)].squared));
    solution_.b.push_back(p_.b_end);
    solution_.z.assign(x + inner_, x + inner_ + segments_ * channels_);
    solution_.objective = value;
    solution_.row_multiplier.assign(lambda, lambda + rows_);
    solution_.recovery_multiplier.clear();
    for (Index i = 0; i < segments_ * channels_; ++i)
      solution_.recovery_multiplier.push_back(std::max(0.0, -lambda[rows_ + i]));
    solution_.price_W = has_duration_ ? lambda[m - 1] : 0.0;
  }

 private:
  Index z_index(Index segment, Index channel) const { return inner_ + segment * channels_ + channel; }
  const Jet& energy(Index k, Index c) const { return at_.energy[static_cast<std::size_t>(2 * k + c)]; }
  Jet cost(std::size_t k) const {
    return p_.energy_weight * (at_.energy[2 * k] + at_.energy[2 * k + 1]) +
           p_.time_weight_W * at_.duration[k];
  }

  void update(const Number* x, bool fresh) {
    if (!fresh && !at_.duration.empty()) return;
    const std::size_t count = p_.segment_count();
    at_.energy.resize(2 * count);
    at_.duration.resize(count);
    at_.row.resize(p_.rows.size());
    for (std::size_t k = 0; k < count; ++k) {
      const double b0 = k == 0 ? p_.b_start : x[k - 1], b1 = k + 1 == count ? p_.b_end : x[k];
      const SegmentJets jets = segment_jets(p_.segments[k], b0, b1);
      at_.energy[2 * k] = jets.energy_J[0];
      at_.energy[2 * k + 1] = jets.energy_J[1];
      at_.duration[k] = jets.duration_s;
      if (p_.first_row[k] == p_.first_row[k + 1]) continue;
      const Interval<Jet> interval = jet_interval(p_.segments[k], b0, b1);
      for (std::size_t i = p_.first_row[k]; i < p_.first_row[k + 1]; ++i)
        at_.row[i] = evaluate_row(p_, p_.rows[i], interval);
    }
  }

  template <class Function>
  void for_pair(Index row, Index segment, const Jet* jet, Function&& use) const {
    if (segment > 0) use(row, segment - 1, jet ? jet->d0 : 0.0);
    if (segment < inner_) use(row, segment, jet ? jet->d1 : 0.0);
  }

  /// Calls use(row, column, value); values are those of the last update.
  template <class Function>
  void for_jacobian(Function&& use) const {
    const bool known = !at_.duration.empty();
    for (Index i = 0; i < rows_; ++i) {
      const auto at = static_cast<std::size_t>(i);
      for_pair(i, static_cast<Index>(p_.rows[at].segment), known ? &at_.row[at] : nullptr, use);
    }
    for (Index k = 0; k < segments_; ++k)
      for (Index c = 0; c < channels_; ++c) {
        const Index row = rows_ + k * channels_ + c;
        for_pair(row, k, known ? &energy(k, c) : nullptr, use);
        use(row, z_index(k, c), 1.0);
      }
    if (!has_duration_) return;
    for (Index i = 0; i < inner_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      use(rows_ + segments_ * channels_, i, known ? at_.duration[k].d1 + at_.duration[k + 1].d0 : 0.0);
    }
  }

  /// Calls use(row, column, value) for the tridiagonal lower half of the Lagrangian's Hessian.
  template <class Function>
  void for_hessian(const Number* lambda, Number factor, Function&& use) const {
    std::vector<Jet> sum(static_cast<std::size_t>(segments_));
    if (lambda != nullptr) {
      for (std::size_t k = 0; k < sum.size(); ++k) {
        sum[k] = factor * cost(k);
        for (Index c = 0; c < channels_; ++c) {
          const auto segment = static_cast<Index>(k);
          sum[k] += lambda[rows_ + segment * channels_ + c] * energy(segment, c);
        }
        if (has_duration_) sum[k] += lambda[rows_ + segments_ * channels_] * at_.duration[k];
      }
      for (std::size_t i = 0; i < p_.rows.size(); ++i) sum[p_.rows[i].segment] += lambda[i] * at_.row[i];
    }
    for (Index k = 0; k < inner_; ++k) {
      const auto at = static_cast<std::size_t>(k);
      use(k, k, sum[at].d11 + sum[at + 1].d00);
      if (k + 1 < inner_) use(k + 1, k, sum[at + 1].d01);
    }
  }

  const Problem& p_;
  const std::vector<double>& guess_;
  Solution& solution_;
  Index inner_, segments_, channels_, rows_;
  bool has_duration_;
  Evaluation at_{};
};

}  // namespace

Solution solve_with_ipopt(const Problem& problem, const std::vector<double>& b_guess,
                          const IpoptOptions& options) {
  Solution solution{.b = b_guess};
  Ipopt::SmartPtr<Ipopt::IpoptApplication> app = new Ipopt::IpoptApplication(false);
  app->Options()->SetIntegerValue("print_level", 0);
  app->Options()->SetStringValue("sb", "yes");
  app->Options()->SetNumericValue("tol", options.tolerance);
  app->Options()->SetIntegerValue("max_iter", options.max_iterations);
  app->Options()->SetIntegerValue("mumps_pivot_order", 6);
  app->Options()->SetNumericValue("bound_relax_factor", 0.0);
  app->Options()->SetStringValue("honor_original_bounds", "yes");
  if (options.warm) {
    app->Options()->SetNumericValue("mu_init", 1e-6);
    app->Options()->SetNumericValue("bound_push", 1e-8);
    app->Options()->SetNumericValue("bound_frac", 1e-8);
    app->Options()->SetNumericValue("slack_bound_push", 1e-8);
    app->Options()->SetNumericValue("slack_bound_frac", 1e-8);
  }
  if (app->Initialize("") != Ipopt::Solve_Succeeded) {
    solution.message = "ipopt does not start";
    return solution;
  }
  Ipopt::SmartPtr<Ipopt::TNLP> nlp = new PathNlp(problem, b_guess, solution);
  static std::mutex one_at_a_time;  // MUMPS keeps state of its own between calls
  const std::lock_guard lock(one_at_a_time);
  const Ipopt::ApplicationReturnStatus status = app->OptimizeTNLP(nlp);
  if (Ipopt::IsValid(app->Statistics())) solution.iterations = app->Statistics()->IterationCount();
  if (!solution.converged)
    solution.message = "ipopt stopped with code " + std::to_string(static_cast<int>(status));
  return solution;
}

}  // namespace joulepath::nlp
