#include "planner/joint/path_geometry.hpp"

#include <cmath>

#include "planner/joint/joint_segment.hpp"

namespace joulepath::joint {
namespace {

/// Gauss-Legendre places on either side of the middle, and their weights.
template <std::size_t Pairs>
struct GaussRule {
  std::array<double, Pairs> place{}, weight{};
};
constexpr GaussRule<4> kExact{
    {0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168},
    {0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915}};
constexpr GaussRule<2> kNear{{0.33998104358485626480, 0.86113631159405257522},
                             {0.65214515486254614263, 0.34785484513745385737}};

/// Displacement from the start of a piece to a share f of its length.
template <class Real>
struct Displacement {
  Real x{0.0}, y{0.0}, turn{0.0};
};
template <class Real, std::size_t Pairs>
Displacement<Real> displacement(const Real& from_rad, const Real& to_rad, const Real& length_m,
                                double half_track_m, double f, const GaussRule<Pairs>& rule) {
  const PieceRates<Real> rates = piece_rates(from_rad, to_rad, half_track_m);
  Displacement<Real> sum;
  const auto turn = [&](double g) { return length_m * (rates.W0 * g + rates.dW * (0.5 * g * g)); };
  for (std::size_t i = 0; i < 2 * Pairs; ++i) {
    const double g = 0.5 * f * (1 + (i % 2 ? rule.place[i / 2] : -rule.place[i / 2]));
    const Real t = turn(g), along = (rates.A0 + rates.dA * g) * (0.5 * f * rule.weight[i / 2]);
    sum.x = sum.x + along * cos(t);
    sum.y = sum.y + along * sin(t);
  }
  return {sum.x * length_m, sum.y * length_m, turn(f)};
}

Pose moved_by(const Pose& from, const Displacement<double>& d) {
  const double c = std::cos(from.heading_rad), s = std::sin(from.heading_rad);
  return {from.x_m + c * d.x - s * d.y, from.y_m + s * d.x + c * d.y, from.heading_rad + d.turn};
}

}  // namespace

std::array<Eigen::Index, 3> PathGeometry::own(std::size_t piece) const {
  return {program_.pieces[piece].from, program_.pieces[piece].to, program_.length_of(piece)};
}

void PathGeometry::place(const Eigen::VectorXd& parameters) {
  parameters_ = &parameters;
  starts_.assign(1, Pose{});
  for (std::size_t j = 0; j < program_.pieces.size(); ++j) starts_.push_back(pose(j, 1));
}

Pose PathGeometry::pose(std::size_t piece, double share) const {
  const auto [a, b, l] = own(piece);
  const Eigen::VectorXd& p = *parameters_;
  return moved_by(starts_[piece],
                  displacement<double>(p[a], p[b], p[l], program_.half_track_m(), share, kExact));
}

Pose PathGeometry::near_pose(std::size_t piece, double share) const {
  const auto [a, b, l] = own(piece);
  const Eigen::VectorXd& p = *parameters_;
  return moved_by(starts_[piece],
                  displacement<double>(p[a], p[b], p[l], program_.half_track_m(), share, kNear));
}

double PathGeometry::length_m(std::size_t piece) const { return (*parameters_)[program_.length_of(piece)]; }

double PathGeometry::curvature_per_m(std::size_t piece, double share) const {
  constexpr double kLeastAlong = 0.05;
  const auto [a, b, l] = own(piece);
  const PieceRates<double> rates = piece_rates((*parameters_)[a], (*parameters_)[b], program_.half_track_m());
  const double along = rates.A(share);
  return rates.W(share) / std::copysign(std::max(std::abs(along), kLeastAlong), along);
}

LocalPose PathGeometry::local(std::size_t piece, double share) const {
  const auto index = own(piece);
  std::array<LocalPose::Jet, 3> x;
  for (std::size_t i = 0; i < 3; ++i) x[i] = LocalPose::Jet::variable(i, (*parameters_)[index[i]]);
  const auto d = displacement(x[0], x[1], x[2], program_.half_track_m(), share, kExact);
  return {d.x, d.y, d.turn};
}

PoseSlopes PathGeometry::slopes(std::size_t piece, const LocalPose& at) const {
  const double heading = starts_[piece].heading_rad, c = std::cos(heading), s = std::sin(heading);
  PoseSlopes slopes = PoseSlopes::Zero();
  slopes.leftCols<3>().setIdentity();
  slopes(0, 2) = -(s * at.x.value + c * at.y.value);
  slopes(1, 2) = c * at.x.value - s * at.y.value;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    slopes(0, 3 + i) = c * at.x.d[k] - s * at.y.d[k];
    slopes(1, 3 + i) = s * at.x.d[k] + c * at.y.d[k];
    slopes(2, 3 + i) = at.turn.d[k];
  }
  return slopes;
}

/// With F = l . R(h) (x, y), h the heading at the piece's start:  F_hh = -F,  F_h the same of (-y, x).
PieceHessian PathGeometry::curvature(std::size_t piece, const LocalPose& at,
                                     const Eigen::Vector3d& multiplier) const {
  const double heading = starts_[piece].heading_rad, c = std::cos(heading), s = std::sin(heading);
  const double mx = multiplier[0] * c + multiplier[1] * s, my = multiplier[1] * c - multiplier[0] * s;
  PieceHessian hessian = PieceHessian::Zero();
  hessian(2, 2) = -(mx * at.x.value + my * at.y.value);
  for (Eigen::Index i = 0, k = 0; i < 3; ++i) {
    const auto of = static_cast<std::size_t>(i);
    hessian(3 + i, 2) = hessian(2, 3 + i) = my * at.x.d[of] - mx * at.y.d[of];
    for (Eigen::Index n = 0; n <= i; ++n, ++k) {
      const auto at_k = static_cast<std::size_t>(k);
      hessian(3 + i, 3 + n) = hessian(3 + n, 3 + i) =
          mx * at.x.dd[at_k] + my * at.y.dd[at_k] + multiplier[2] * at.turn.dd[at_k];
    }
  }
  return hessian;
}

void PathGeometry::differentiate(const Eigen::VectorXd& parameters) {
  place(parameters);
  const std::size_t count = program_.pieces.size();
  starts_gradient_.setZero(program_.parameters(), 3 * static_cast<Eigen::Index>(count) + 3);
  whole_.clear();
  whole_by_.clear();
  for (std::size_t j = 0; j < count; ++j) {
    whole_.push_back(local(j, 1));
    whole_by_.push_back(slopes(j, whole_.back()));
    const auto start = static_cast<Eigen::Index>(3 * j);
    const PoseSlopes& by = whole_by_.back();
    auto next = starts_gradient_.middleCols<3>(start + 3);
    next.noalias() = starts_gradient_.middleCols<3>(start) * by.leftCols<3>().transpose();
    const auto index = own(j);
    for (Eigen::Index i = 0; i < 3; ++i) next.row(index[static_cast<std::size_t>(i)]) += by.col(3 + i);
  }
  sums_.assign(count, {});
}

Eigen::VectorXd PathGeometry::errors() const {
  std::vector<double> errors;
  for (const Target& target : program_.targets) {
    const Pose& end = starts_[target.piece + 1];
    errors.insert(errors.end(), {end.x_m - target.at_m[0], end.y_m - target.at_m[1]});
    if (target.heading_rad) errors.push_back(end.heading_rad - *target.heading_rad);
  }
  return Eigen::Map<Eigen::VectorXd>(errors.data(), static_cast<Eigen::Index>(errors.size()));
}

Eigen::MatrixXd PathGeometry::error_gradient() const {
  Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(program_.targets.size()), starts_gradient_.rows());
  Eigen::Index row = 0;
  for (const Target& target : program_.targets) {
    const Eigen::Index count = target.heading_rad ? 3 : 2;
    rows.middleRows(row, count) = end_gradient(target.piece).leftCols(count).transpose();
    row += count;
  }
  return rows.topRows(row);
}

/// Adds the second derivatives of a sum over the pieces: `pieces` of their starts and own parameters, `end`
/// of the end of the path. Backward, the starts' block holds all that depends on the pieces behind.
void PathGeometry::add_condensed(const std::vector<PieceHessian>& pieces, const Eigen::Matrix3d& end,
                                 Eigen::MatrixXd& hessian) const {
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(hessian.rows(), hessian.cols());
  Eigen::Matrix3d behind = end;
  for (std::size_t j = pieces.size(); j-- > 0;) {
    const PieceHessian all = pieces[j] + whole_by_[j].transpose() * behind * whole_by_[j];
    behind = all.topLeftCorner<3, 3>();
    const auto before = starts_gradient_.middleCols<3>(3 * static_cast<Eigen::Index>(j));
    const auto index = own(j);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Eigen::Index column = index[static_cast<std::size_t>(i)];
      mixed.col(column).noalias() += before * all.block<3, 1>(0, 3 + i);
      for (Eigen::Index n = 0; n < 3; ++n)
        hessian(column, index[static_cast<std::size_t>(n)]) += all(3 + i, 3 + n);
    }
  }
  hessian += mixed + mixed.transpose();
}

Eigen::MatrixXd PathGeometry::displacement_metric() const {
  Eigen::MatrixXd metric = Eigen::MatrixXd::Zero(starts_gradient_.rows(), starts_gradient_.rows());
  const double share = 1 / static_cast<double>(program_.pieces.size());
  const Eigen::Matrix3d place = Eigen::Vector3d(share, share, 0).asDiagonal();
  PieceHessian at_start = PieceHessian::Zero();
  at_start.topLeftCorner<3, 3>() = place;
  add_condensed(std::vector<PieceHessian>(program_.pieces.size(), at_start), place, metric);
  return metric;
}

void PathGeometry::add_sums(const Eigen::VectorXd& target_multipliers, Eigen::VectorXd& gradient,
                            Eigen::VectorXd& lagrangian, Eigen::MatrixXd& hessian) const {
  const std::size_t count = program_.pieces.size();
  std::vector<Eigen::Vector3d> at_end(count, Eigen::Vector3d::Zero());
  Eigen::Index row = 0;
  for (const Target& target : program_.targets)
    for (Eigen::Index i = 0; i < (target.heading_rad ? 3 : 2); ++i)
      at_end[target.piece][i] += target_multipliers[row++];
  std::vector<PieceHessian> hessians(count);
  Eigen::Vector3d behind = Eigen::Vector3d::Zero(), multiplier = behind;
  for (std::size_t j = count; j-- > 0;) {
    multiplier += at_end[j];
    hessians[j] = sums_[j].hessian + curvature(j, whole_[j], multiplier);
    const PieceGradient slope = sums_[j].gradient + whole_by_[j].transpose() * behind;
    const PieceGradient weighted = sums_[j].lagrangian + whole_by_[j].transpose() * multiplier;
    behind = slope.head<3>();
    multiplier = weighted.head<3>();
    const auto index = own(j);
    for (Eigen::Index i = 0; i < 3; ++i) {
      gradient[index[static_cast<std::size_t>(i)]] += slope[3 + i];
      lagrangian[index[static_cast<std::size_t>(i)]] += weighted[3 + i];
    }
  }
  add_condensed(hessians, Eigen::Matrix3d::Zero(), hessian);
}

std::vector<PieceGradient> PathGeometry::changes(const Eigen::VectorXd& parameters) const {
  std::vector<PieceGradient> changes;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  for (std::size_t j = 0; j < program_.pieces.size(); ++j) {
    const auto [a, b, l] = own(j);
    changes.emplace_back();
    changes.back() << start, parameters[a], parameters[b], parameters[l];
    start = whole_by_[j] * changes.back();
  }
  return changes;
}

}  // namespace joulepath::joint
