#include "planner/joint/bordered_system.hpp"

#include <cmath>
#include <utility>

namespace joulepath::joint {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

BorderedSystem::BorderedSystem(std::vector<Part> parts, Index squares, Index parameters)
    : hessian(parameters, parameters),
      parts_(std::move(parts)),
      diagonal_(squares),
      beside_(squares),
      border_(parts_.size()) {
  for (UnknownVector* gradient : {&g, &lagrangian}) {
    gradient->squares.resize(squares);
    gradient->parameters.resize(parameters);
  }
}

void BorderedSystem::clear() {
  for (VectorXd* zero :
       {&g.squares, &g.parameters, &lagrangian.squares, &lagrangian.parameters, &diagonal_, &beside_})
    zero->setZero();
  for (Eigen::Matrix<double, 2, 3>& border : border_) border.setZero();
  hessian.setZero();
}

void BorderedSystem::add(std::size_t part, const std::array<double, kPartUnknowns>& of_g,
                         const std::array<double, kPartUnknowns>& of_lagrangian,
                         const std::array<double, kPartUnknowns*(kPartUnknowns + 1) / 2>& of_hessian) {
  const auto& [unknown, column] = parts_[part];
  for (std::size_t i = 0, at = 0; i < kPartUnknowns; ++i)
    for (std::size_t n = 0; n <= i; ++n, ++at) {
      const double h = of_hessian[at];
      if (i < 2) {
        if (unknown[i] < 0 || unknown[n] < 0) continue;
        (i == n ? diagonal_[unknown[i]] : beside_[unknown[n]]) += h;
      } else if (n < 2) {
        border_[part](static_cast<Index>(n), static_cast<Index>(i) - 2) += h;
      } else {
        hessian(column[i - 2], column[n - 2]) += h;
        if (n < i) hessian(column[n - 2], column[i - 2]) += h;
      }
    }
  for (std::size_t i = 0; i < kPartUnknowns; ++i) {
    if (i < 2 && unknown[i] < 0) continue;
    (i < 2 ? g.squares[unknown[i]] : g.parameters[column[i - 2]]) += of_g[i];
    (i < 2 ? lagrangian.squares[unknown[i]] : lagrangian.parameters[column[i - 2]]) += of_lagrangian[i];
  }
}

void BorderedSystem::add_bound(bool of_square, Index at, double of_g, double of_lagrangian,
                               double of_hessian) {
  (of_square ? g.squares : g.parameters)[at] += of_g;
  (of_square ? lagrangian.squares : lagrangian.parameters)[at] += of_lagrangian;
  (of_square ? diagonal_[at] : hessian(at, at)) += of_hessian;
}

void BorderedSystem::hold(const std::vector<Index>& held) {
  for (const Index at : held) {
    for (std::size_t k = 0; k < parts_.size(); ++k)
      for (std::size_t c = 0; c < parts_[k].parameters.size(); ++c)
        if (parts_[k].parameters[c] == at) border_[k].col(static_cast<Index>(c)).setZero();
    g.parameters[at] = lagrangian.parameters[at] = 0;
    targets.col(at).setZero();
    for (MatrixXd* square : {&hessian, &metric}) {
      square->row(at).setZero();
      square->col(at).setZero();
      (*square)(at, at) = 1;
    }
  }
}

/// Calls each(square, parameter, value) for the entries of B.
template <class Each>
void BorderedSystem::for_border(const Each& each) const {
  for (std::size_t k = 0; k < parts_.size(); ++k)
    for (std::size_t i = 0; i < parts_[k].squares.size(); ++i)
      for (std::size_t c = 0; c < parts_[k].parameters.size(); ++c)
        if (parts_[k].squares[i] >= 0)
          each(parts_[k].squares[i], parts_[k].parameters[c],
               border_[k](static_cast<Index>(i), static_cast<Index>(c)));
}

void BorderedSystem::factorize_squares() {
  pivot_ = diagonal_;
  lower_.setZero(pivot_.size());
  for (Index k = 0; k < pivot_.size(); ++k) {
    if (k > 0) {
      lower_[k] = beside_[k - 1] / pivot_[k - 1];
      pivot_[k] -= lower_[k] * beside_[k - 1];
    }
    if (!(pivot_[k] > 1e-9 * std::abs(diagonal_[k]))) pivot_[k] = 1e-2 * std::abs(diagonal_[k]) + 1e-6;
  }
}

void BorderedSystem::eliminate_squares() {
  factorize_squares();
  const Index squares = pivot_.size(), n = hessian.cols();
  RowMajor& x = eliminated_;
  x.setZero(squares, n + 1);
  for_border([&](Index row, Index column, double value) { x(row, column) += value; });
  x.col(n) = g.squares;
  for (Index k = 1; k < squares; ++k) x.row(k) -= lower_[k] * x.row(k - 1);
  for (Index k = 0; k < squares; ++k) x.row(k) /= pivot_[k];
  for (Index k = squares - 1; k-- > 0;) x.row(k) -= lower_[k + 1] * x.row(k + 1);
}

void BorderedSystem::solve(double regularization) {
  eliminate_squares();
  const Index n = hessian.cols(), rows = errors.size();
  RowMajor schur(n, n + 1);  // and the gradient
  schur << hessian, g.parameters;
  for_border(
      [&](Index row, Index column, double value) { schur.row(column) -= value * eliminated_.row(row); });

  const Eigen::HouseholderQR<MatrixXd> qr(targets.transpose());
  const auto q = qr.householderQ();
  const auto in_null = [&](MatrixXd square) {
    square.applyOnTheLeft(q.adjoint());
    square.applyOnTheRight(q);
    return MatrixXd(square.bottomRightCorner(n - rows, n - rows));
  };
  range_ = q * MatrixXd::Identity(n, rows);
  on_range_.compute(targets * range_);
  const VectorXd shortest = to_targets(-errors);
  const VectorXd right = -(q.adjoint() * (schur.col(n) + schur.leftCols(n) * shortest));
  VectorXd across(n);
  across << VectorXd::Zero(rows), descent(
                                      in_null(schur.leftCols(n) + regularization * metric),
                                      [&] { return in_null(metric); }, regularization, right.tail(n - rows));
  step.parameters = shortest + q * across;
  const VectorXd rest = -(schur.col(n) + schur.leftCols(n) * step.parameters +
                          regularization * metric * (step.parameters - shortest));
  multipliers = on_range_.transpose().solve(range_.transpose() * rest);
}

void BorderedSystem::follow() {
  const Index n = hessian.cols();
  step.squares = -eliminated_.col(n) - eliminated_.leftCols(n) * step.parameters;
}

VectorXd BorderedSystem::to_targets(const VectorXd& change) const { return range_ * on_range_.solve(change); }

}  // namespace joulepath::joint
