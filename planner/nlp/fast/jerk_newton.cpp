#include "planner/nlp/fast/jerk_newton.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {
namespace {

constexpr std::size_t kLocal = JerkProgram::kLocal, kKinematics = Stage::kEqualities;

/// hessian += curvature jet'' + square jet' jet'^T
void add_hessian(Stage& stage, const JerkJet& jet, double curvature, double square) {
  for (std::size_t i = 0, at = 0; i < kLocal; ++i)
    for (std::size_t j = 0; j <= i; ++j, ++at) {
      const double h = curvature * jet.dd[at] + square * jet.d[i] * jet.d[j];
      stage.hessian[i][j] += h;
      if (i != j) stage.hessian[j][i] += h;
    }
}

void add_gradient(Stage& stage, const JerkJet& jet, double weight) {
  for (std::size_t i = 0; i < kLocal; ++i) stage.gradient[i] += weight * jet.d[i];
}

}  // namespace

JerkNewton::JerkNewton(const JerkProgram& program, JerkState& state)
    : program_(program),
      p_(program.problem()),
      state_(state),
      system_(p_.segment_count()),
      dx_(program.unknown_count()) {}

void JerkNewton::add_equalities(double& work, double& worst) const {
  for (std::size_t k = 0; k < state_.lambda.size(); ++k)
    for (std::size_t i = 0; i < kKinematics; ++i) {
      const double value = state_.values[k].rows[program_.first_kinematic_row(k) + i].value;
      work += std::abs(value * state_.lambda[k][i]);
      worst = std::max(worst, std::abs(value));
    }
}

bool JerkNewton::factor() {
  shift_ = 0;
  for (std::size_t k = 0; k < state_.values.size(); ++k) {
    system_.stages[k].hessian = {};
    system_.stages[k].border = state_.values[k].duration_s.d;
    assemble_energy(k);
    assemble_kinematics(k);
  }
  for (const RowSide& side : state_.sides)
    add_hessian(system_.stages[side.segment], state_.values[side.segment].rows[side.row],
                side.sign * side.pair.y, side.pair.sigma);
  for (const BoundSide& side : state_.bounds) {
    const auto [k, i] = program_.place_of(side.unknown);
    system_.stages[k].hessian[i][i] += side.pair.sigma;
  }
  return true;
}

void JerkNewton::assemble_energy(std::size_t k) {
  const std::vector<Jet>& energy_J = state_.values[k].energy_J;
  for (std::size_t c = 0; c < energy_J.size(); ++c) {
    double weight = p_.energy_weight, square = 0;
    if (c < parts()) {
      const Recovery& r = state_.recoveries[k * parts() + c];
      weight -= r.sum.y;
      square = r.curvature();
    }
    add_hessian(system_.stages[k], energy_J[c], weight, square);
  }
}

void JerkNewton::assemble_kinematics(std::size_t k) {
  Stage& stage = system_.stages[k];
  for (std::size_t i = 0; i < kKinematics; ++i) {
    const Jet& row = state_.values[k].rows[program_.first_kinematic_row(k) + i];
    add_hessian(stage, row, state_.lambda[k][i], 0);
    stage.equality[i] = row.d;
    stage.wanted[i] = -row.value;
  }
}

void JerkNewton::right_side() {
  for (std::size_t k = 0; k < state_.values.size(); ++k) {
    Stage& stage = system_.stages[k];
    stage.gradient = {};
    add_gradient(stage, state_.values[k].duration_s, p_.time_weight_W);
    for (std::size_t c = 0; c < state_.values[k].energy_J.size(); ++c) {
      double part = p_.energy_weight;
      if (c < parts()) part += state_.recoveries[k * parts() + c].slope(p_.recovery_weight);
      add_gradient(stage, state_.values[k].energy_J[c], part);
    }
  }
  for (const RowSide& side : state_.sides)
    add_gradient(system_.stages[side.segment], state_.values[side.segment].rows[side.row],
                 side.sign * (side.pair.corrected - side.pair.y * side.residual) * side.pair.inverse);
  for (const BoundSide& side : state_.bounds) {
    const auto [k, i] = program_.place_of(side.unknown);
    system_.stages[k].gradient[i] += side.sign * side.pair.corrected * side.pair.inverse;
  }
}

bool JerkNewton::solve_shifted() {
  constexpr double kFirstShift = 1e-4;
  constexpr int kShifts = 14;
  for (int i = 0; i < kShifts; ++i) {
    if (system_.solve()) return true;
    const double next = shift_ == 0 ? kFirstShift : 10 * shift_;
    for (Stage& stage : system_.stages)
      for (std::size_t d = kLocal - 3; d < kLocal; ++d) stage.hessian[d][d] += next - shift_;
    shift_ = next;
  }
  return false;
}

std::optional<StepSizes> JerkNewton::solve() {
  right_side();
  if (!solve_shifted()) return std::nullopt;
  price_time();
  system_.multipliers(new_price_, new_lambda_);
  for (std::size_t i = 0; i < dx_.size(); ++i) {
    const auto [k, local] = program_.place_of(i);
    const auto& step = system_.step(k)[local];
    dx_[i] = step[0] + new_price_ * step[1];
  }
  return expand();
}

/// The multiplier for which the steps of all durations close the residual of the duration row.
void JerkNewton::price_time() {
  new_price_ = 0;
  if (!state_.time.exists()) return;
  double wanted_s = state_.time.residual, slope = 0;
  if (state_.time.is_budget()) {
    const Pair& slack = state_.time.slack;
    wanted_s -= slack.corrected / slack.y;
    slope -= slack.s / slack.y;
  }
  for (std::size_t k = 0; k < state_.values.size(); ++k)
    for (std::size_t i = 0; i < kLocal; ++i) {
      wanted_s -= system_.stages[k].border[i] * system_.step(k)[i][0];
      slope += system_.stages[k].border[i] * system_.step(k)[i][1];
    }
  new_price_ = wanted_s / slope;
}

double JerkNewton::change(std::size_t k, const Jet& jet) const {
  double sum = 0;
  for (std::size_t i = 0; i < kLocal; ++i)
    sum += jet.d[i] * (system_.step(k)[i][0] + new_price_ * system_.step(k)[i][1]);
  return sum;
}

StepSizes JerkNewton::expand() {
  StepSizes sizes;
  for (BoundSide& side : state_.bounds) sizes.move(side.pair, -side.sign * dx_[side.unknown]);
  expand_segments(
      *this, [&](std::size_t k, const Jet& jet) { return change(k, jet); }, new_price_, sizes);
  return sizes;
}

void JerkNewton::take(const StepSizes& sizes) {
  for (std::size_t i = 0; i < dx_.size(); ++i) state_.x[i] += sizes.primal * dx_[i];
  state_.for_each_pair([&](Pair& pair) { sizes.take(pair); });
  for (BoundSide& side : state_.bounds) side.pair.s = side.sign * (side.bound - state_.x[side.unknown]);
  for (std::size_t k = 0; k < new_lambda_.size(); ++k)
    for (std::size_t i = 0; i < kKinematics; ++i)
      state_.lambda[k][i] += sizes.dual * (new_lambda_[k][i] - state_.lambda[k][i]);
  state_.time.take(sizes, new_price_);
}

double JerkNewton::dual_error() const {
  std::vector<double> gradient(state_.x.size(), 0.0);
  const auto add = [&](std::size_t k, const Jet& jet, double weight) {
    const Columns<kLocal> columns = program_.columns(k);
    for (std::size_t i = 0; i < kLocal; ++i)
      if (columns[i] != kFixed) gradient[static_cast<std::size_t>(columns[i])] += weight * jet.d[i];
  };
  for (std::size_t k = 0; k < state_.values.size(); ++k) {
    const SegmentValues<kLocal>& values = state_.values[k];
    add(k, values.duration_s, p_.time_weight_W + state_.time.multiplier());
    for (std::size_t c = 0; c < values.energy_J.size(); ++c) {
      const bool recovers = c < parts();
      add(k, values.energy_J[c],
          p_.energy_weight - (recovers ? state_.recoveries[k * parts() + c].sum.y : 0.0));
    }
    for (std::size_t i = 0; i < kKinematics; ++i)
      add(k, values.rows[program_.first_kinematic_row(k) + i], state_.lambda[k][i]);
  }
  for (const RowSide& side : state_.sides)
    add(side.segment, state_.values[side.segment].rows[side.row], side.sign * side.pair.y);
  for (const BoundSide& side : state_.bounds) gradient[side.unknown] += side.sign * side.pair.y;
  double error = 0;
  for (std::size_t i = 0; i < gradient.size(); ++i) error += std::abs(gradient[i] * state_.x[i]);
  return error;
}

}  // namespace joulepath::nlp
