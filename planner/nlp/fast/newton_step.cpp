#include "planner/nlp/fast/newton_step.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {

void NewtonStep::reserve(std::size_t nodes) {
  for (auto* v : {&gradient_, &step_, &time_gradient_, &time_solved_, &dual_residual_}) v->reserve(nodes);
  for (Tridiagonal* matrix : {&hessian_, &original_}) matrix->reserve(nodes);
}

void NewtonStep::set_problem() {
  p_ = &model_.problem();
  const std::size_t n = p_->unknown_count();
  for (auto* v : {&gradient_, &step_, &time_gradient_, &time_solved_, &dual_residual_}) v->assign(n, 0.0);
  hessian_.resize(n);
}

void NewtonStep::add_gradient(std::size_t segment, double g0, double g1, std::vector<double>& to) const {
  if (segment > 0) to[segment - 1] += g0;
  if (segment < to.size()) to[segment] += g1;
}

void NewtonStep::add_hessian(std::size_t segment, double h00, double h01, double h11) {
  const std::size_t n = hessian_.diagonal.size();
  if (segment > 0) hessian_.diagonal[segment - 1] += h00;
  if (segment < n) hessian_.diagonal[segment] += h11;
  if (segment > 0 && segment < n) hessian_.below[segment - 1] += h01;
}

/// At the current multipliers, bounds left out.
void NewtonStep::lagrangian_gradient(std::vector<double>& to) const {
  const double weight = p_->time_weight_W + state_.time.multiplier();
  for (std::size_t k = 0; k < p_->segment_count(); ++k) {
    const SegmentJets& j = model_.jets(k);
    double g0 = weight * j.duration_s.d[0], g1 = weight * j.duration_s.d[1];
    for (std::size_t c = 0; c < 2; ++c) {
      const double recovered = c < p_->channels ? state_.recoveries[k * p_->channels + c].sum.y : 0.0;
      g0 += (p_->energy_weight - recovered) * j.energy_J[c].d[0];
      g1 += (p_->energy_weight - recovered) * j.energy_J[c].d[1];
    }
    add_gradient(k, g0, g1, to);
  }
  for (const RowSide& side : state_.sides) {
    const Jet& g = model_.row(side.row);
    const double y = side.sign * side.pair.y;
    add_gradient(side.segment, y * g.d[0], y * g.d[1], to);
  }
}

/// Gradient of the Lagrangian, times b.
double NewtonStep::dual_error() {
  std::fill(dual_residual_.begin(), dual_residual_.end(), 0.0);
  lagrangian_gradient(dual_residual_);
  double error = 0;
  for (std::size_t k = 0; k < dual_residual_.size(); ++k)
    error += std::abs(dual_residual_[k] - state_.low[k].y + state_.high[k].y) * state_.b[k + 1];
  return error;
}

bool NewtonStep::factor() {
  for (std::size_t k = 0; k < state_.low.size(); ++k)
    hessian_.diagonal[k] = state_.low[k].sigma + (state_.high[k].s > 0 ? state_.high[k].sigma : 0.0);
  std::fill(hessian_.below.begin(), hessian_.below.end(), 0.0);
  add_segments();
  add_rows();
  if (!factor_shifted()) return false;
  factor_border();
  return true;
}

void NewtonStep::add_segments() {
  const double weight = p_->time_weight_W + state_.time.multiplier();
  for (std::size_t k = 0; k < p_->segment_count(); ++k) {
    const SegmentJets& j = model_.jets(k);
    const Jet& dt = j.duration_s;
    double h00 = weight * dt.dd[0], h01 = weight * dt.dd[1], h11 = weight * dt.dd[2];
    for (std::size_t c = 0; c < 2; ++c) {
      const Jet& E = j.energy_J[c];
      double part = p_->energy_weight;
      if (c < p_->channels) {
        const Recovery& r = state_.recoveries[k * p_->channels + c];
        part -= r.sum.y;
        const double sigma = r.curvature();
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
}

void NewtonStep::add_rows() {
  for (const RowSide& side : state_.sides) {
    const Jet& g = model_.row(side.row);
    const double sigma = side.pair.sigma, y = side.sign * side.pair.y;
    add_hessian(side.segment, sigma * g.d[0] * g.d[0] + y * g.dd[0], sigma * g.d[0] * g.d[1] + y * g.dd[1],
                sigma * g.d[1] * g.d[1] + y * g.dd[2]);
  }
}

bool NewtonStep::factor_shifted() {
  original_ = hessian_;
  double shift = 0;
  for (int i = 0; i < 12; ++i) {
    if (hessian_.factor()) return true;
    shift = shift == 0 ? 1e-3 : 10 * shift;
    hessian_ = original_;
    for (double& diagonal : hessian_.diagonal) diagonal += shift * (std::abs(diagonal) + 1e-6);
  }
  return false;
}

std::optional<StepSizes> NewtonStep::solve() {
  right_side();
  hessian_.solve(step_);
  border();
  return expand();
}

void NewtonStep::right_side() {
  for (std::size_t k = 0; k < state_.low.size(); ++k) {
    const Pair &low = state_.low[k], &high = state_.high[k];
    gradient_[k] = (high.s > 0 ? high.corrected * high.inverse : 0.0) - low.corrected * low.inverse;
  }
  for (std::size_t k = 0; k < p_->segment_count(); ++k) {
    const SegmentJets& j = model_.jets(k);
    double g0 = p_->time_weight_W * j.duration_s.d[0], g1 = p_->time_weight_W * j.duration_s.d[1];
    for (std::size_t c = 0; c < 2; ++c) {
      double part = p_->energy_weight;
      if (c < p_->channels) part += state_.recoveries[k * p_->channels + c].slope(p_->recovery_weight);
      g0 += part * j.energy_J[c].d[0];
      g1 += part * j.energy_J[c].d[1];
    }
    add_gradient(k, g0, g1, gradient_);
  }
  for (const RowSide& side : state_.sides) {
    const Jet& g = model_.row(side.row);
    const double y = side.sign * (side.pair.corrected - side.pair.y * side.residual) * side.pair.inverse;
    add_gradient(side.segment, y * g.d[0], y * g.d[1], gradient_);
  }
  for (std::size_t k = 0; k < step_.size(); ++k) step_[k] = -gradient_[k];
}

/// The duration row's part of the system, the same for every right side.
void NewtonStep::factor_border() {
  if (!state_.time.exists()) return;
  std::fill(time_gradient_.begin(), time_gradient_.end(), 0.0);
  for (std::size_t k = 0; k < p_->segment_count(); ++k)
    add_gradient(k, model_.jets(k).duration_s.d[0], model_.jets(k).duration_s.d[1], time_gradient_);
  time_solved_ = time_gradient_;
  hessian_.solve(time_solved_);
  border_pivot_ = state_.time.is_budget() ? state_.time.slack.s / state_.time.slack.y : 0.0;
  for (std::size_t k = 0; k < step_.size(); ++k) border_pivot_ += time_gradient_[k] * time_solved_[k];
}

/// The duration row: one more unknown, its multiplier.
void NewtonStep::border() {
  new_price_ = 0;
  if (!state_.time.exists()) return;
  const TimeRow& time = state_.time;
  double along = 0;
  for (std::size_t k = 0; k < step_.size(); ++k) along += time_gradient_[k] * step_[k];
  const double centering = time.is_budget() ? time.slack.corrected / time.slack.y : 0.0;
  new_price_ = (along + centering - time.residual) / border_pivot_;
  for (std::size_t k = 0; k < step_.size(); ++k) step_[k] -= new_price_ * time_solved_[k];
}

/// Steps of all eliminated variables, and the largest admissible step lengths.
StepSizes NewtonStep::expand() {
  StepSizes sizes;
  const auto step_at = [&](std::size_t node) {
    return node == 0 || node == state_.b.size() - 1 ? 0.0 : step_[node - 1];
  };
  for (std::size_t k = 0; k < state_.low.size(); ++k) {
    sizes.move(state_.low[k], step_[k]);
    if (state_.high[k].s > 0) sizes.move(state_.high[k], -step_[k]);
  }
  const auto change = [&](std::size_t k, const Jet& jet) {
    return jet.d[0] * step_at(k) + jet.d[1] * step_at(k + 1);
  };
  expand_segments(*this, change, new_price_, sizes);
  return sizes;
}

void NewtonStep::take(const StepSizes& sizes) {
  for (std::size_t k = 0; k < step_.size(); ++k) state_.b[k + 1] += sizes.primal * step_[k];
  state_.for_each_pair([&](Pair& pair) { sizes.take(pair); });
  state_.time.take(sizes, new_price_);
  for (std::size_t k = 0; k < step_.size(); ++k) state_.low[k].s = state_.b[k + 1];
}

}  // namespace joulepath::nlp
