#include "extensions/onboard/monitor/block_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kPriorSizes = 3.0;   ///< 1-sigma of another cause, in its typical sizes
constexpr double kPriorShare = 10.0;  ///< 1-sigma of kg and resistance: next to no prior, but never singular
constexpr double kWidest_kg = 1e4;

/// Solves an information matrix for one linear combination of the unknowns.
Estimate combination(const Eigen::MatrixXd& information, const Eigen::VectorXd& right,
                     const Eigen::VectorXd& combined) {
  const Eigen::LDLT<Eigen::MatrixXd> factors(information);
  const double variance = combined.dot(factors.solve(combined));
  return {combined.dot(factors.solve(right)), std::sqrt(std::max(variance, 0.0))};
}

}  // namespace

void BlockFit::reset(std::size_t others) {
  const Eigen::Index n = kOther + static_cast<Eigen::Index>(others);
  normal_ = Eigen::MatrixXd::Zero(n, n);
  right_ = Eigen::VectorXd::Zero(n);
  squares_ = rows_ = 0;
  windows_ = 0;
}

void BlockFit::add(const WindowMean& window, const WindowEquations& rows) {
  if (!rows.residual.allFinite() || !rows.other.allFinite()) return;
  if (windows_ == 0) begin_s_ = window.begin_s;
  end_s_ = window.end_s;
  Eigen::MatrixXd design(rows.residual.size(), normal_.cols());
  design << (rows.driving ? 1.0 : 0.0) * rows.per_kg, (rows.driving ? 0.0 : 1.0) * rows.per_kg,
      rows.resistance, rows.other;
  normal_ += design.transpose() * design;
  right_ += design.transpose() * rows.residual;
  squares_ += rows.residual.squaredNorm();
  rows_ += static_cast<double>(rows.residual.size());
  ++windows_;
}

/// Information of all columns but `resistance`, which the other causes replace.
Eigen::MatrixXd BlockFit::with_priors(double noise) const {
  Eigen::MatrixXd information = normal_ / (noise * noise);
  information.row(kResistance).setZero();
  information.col(kResistance).setZero();
  information(kResistance, kResistance) = 1;
  for (Eigen::Index i = kOther; i < information.rows(); ++i)
    information(i, i) += 1 / (kPriorSizes * kPriorSizes);
  for (const Eigen::Index i : {kDriving, kBraking}) information(i, i) += 1 / (kWidest_kg * kWidest_kg);
  return information;
}

BlockFit::Leftover BlockFit::leftover() const {
  // As good as without priors: what is left has to be noise alone.
  Eigen::MatrixXd normal = normal_;
  const double size = normal.trace() / static_cast<double>(normal.rows());
  normal.diagonal().array() += 1e-9 * std::max(size, 1e-12);
  const Eigen::VectorXd x = Eigen::LDLT<Eigen::MatrixXd>(normal).solve(right_);
  const double squares = squares_ - 2 * x.dot(right_) + x.dot(normal_ * x);
  return {std::max(squares, 0.0), rows_ - static_cast<double>(normal.rows())};
}

BlockEstimate BlockFit::estimate(double noise) const {
  const Eigen::MatrixXd information = with_priors(noise);
  Eigen::VectorXd right = right_ / (noise * noise);
  right(kResistance) = 0;
  BlockEstimate result{.begin_s = begin_s_, .end_s = end_s_, .noise = noise};
  Eigen::VectorXd difference = Eigen::VectorXd::Zero(right.size());
  difference(kDriving) = 1, difference(kBraking) = -1;
  result.disagreement = combination(information, right, difference);
  // One payload for both phases: the two columns are one.
  Eigen::MatrixXd joined = Eigen::MatrixXd::Identity(right.size(), right.size());
  joined(kBraking, kDriving) = 1;
  joined.col(kBraking).setZero();
  Eigen::MatrixXd one = joined.transpose() * information * joined;
  one(kBraking, kBraking) = 1;
  Eigen::VectorXd kg = Eigen::VectorXd::Zero(right.size());
  kg(kDriving) = 1;
  result.extra_kg = combination(one, joined.transpose() * right, kg);
  Eigen::Matrix2d two;
  two << normal_.topLeftCorner(2, 2).sum(), normal_.col(kResistance).head(2).sum(),
      normal_.col(kResistance).head(2).sum(), normal_(kResistance, kResistance);
  two /= noise * noise;
  two.diagonal().array() += 1 / (kPriorShare * kPriorShare);
  const Eigen::Vector2d both = Eigen::Vector2d(right_(kDriving) + right_(kBraking), right_(kResistance));
  result.resistance = combination(two, both / (noise * noise), Eigen::Vector2d(0, 1));
  return result;
}

int BlockFit::best_other() const {
  const double kg = right_(kDriving) + right_(kBraking);
  const auto gain = [](double product, double square) { return square > 0 ? product * product / square : 0; };
  double most = gain(kg, normal_.topLeftCorner(2, 2).sum());
  int best = -1;
  for (Eigen::Index i = kOther; i < right_.size(); ++i)
    if (const double explained = gain(right_(i), normal_(i, i)); explained > most) {
      most = explained;
      best = static_cast<int>(i - kOther);
    }
  return best;
}

}  // namespace joulepath
