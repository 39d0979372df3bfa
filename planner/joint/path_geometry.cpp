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

Eigen::Matrix<double, Eigen::Dynamic, 3> PathGeometry::gradient(std::size_t piece,
                                                                const LocalPose& at) const {
  const auto j = static_cast<Eigen::Index>(piece);
  const double heading = starts_[piece].heading_rad, c = std::cos(heading), s = std::sin(heading);
  Eigen::Matrix<double, Eigen::Dynamic, 3> gradient(dx_.rows(), 3);
  gradient.col(0) = dx_.col(j) - (s * at.x.value + c * at.y.value) * dheading_.col(j);
  gradient.col(1) = dy_.col(j) + (c * at.x.value - s * at.y.value) * dheading_.col(j);
  gradient.col(2) = dheading_.col(j);
  const auto index = own(piece);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = index[i];
    gradient(row, 0) += c * at.x.d[i] - s * at.y.d[i];
    gradient(row, 1) += s * at.x.d[i] + c * at.y.d[i];
    gradient(row, 2) += at.turn.d[i];
  }
  return gradient;
}

void PathGeometry::differentiate(const Eigen::VectorXd& parameters) {
  place(parameters);
  const Eigen::Index rows = program_.parameters(), count = static_cast<Eigen::Index>(program_.pieces.size());
  dx_.setZero(rows, count + 1);
  dy_.setZero(rows, count + 1);
  dheading_.setZero(rows, count + 1);
  whole_.clear();
  for (Eigen::Index j = 0; j < count; ++j) {
    const auto piece = static_cast<std::size_t>(j);
    whole_.push_back(local(piece, 1));
    const auto next = gradient(piece, whole_.back());
    dx_.col(j + 1) = next.col(0);
    dy_.col(j + 1) = next.col(1);
    dheading_.col(j + 1) = next.col(2);
  }
  behind_.assign(program_.pieces.size(), {});
  turned_by_.assign(program_.pieces.size(), 0.0);
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
  Eigen::MatrixXd rows(3 * static_cast<Eigen::Index>(program_.targets.size()), dx_.rows());
  Eigen::Index row = 0;
  for (const Target& target : program_.targets) {
    const auto end = static_cast<Eigen::Index>(target.piece) + 1;
    rows.row(row++) = dx_.col(end).transpose();
    rows.row(row++) = dy_.col(end).transpose();
    if (target.heading_rad) rows.row(row++) = dheading_.col(end).transpose();
  }
  return rows.topRows(row);
}

Eigen::MatrixXd PathGeometry::displacement_metric() const {
  return (dx_ * dx_.transpose() + dy_ * dy_.transpose()) / static_cast<double>(program_.pieces.size());
}

/// With F = l . R(heading) (x, y):  D2 F = -F dh dh' + dF_h dh' + dh dF_h' + l . R D2(x, y), where h is the
/// heading at the piece's start. Returns dF/dh.
double PathGeometry::add_own_curvature(std::size_t piece, const LocalPose& at, double lx, double ly,
                                       Eigen::MatrixXd& hessian) const {
  const double heading = starts_[piece].heading_rad, c = std::cos(heading), s = std::sin(heading);
  const double mx = lx * c + ly * s, my = ly * c - lx * s;  // the multiplier in the piece's frame
  const auto dh = dheading_.col(static_cast<Eigen::Index>(piece));
  hessian.noalias() -= (mx * at.x.value + my * at.y.value) * dh * dh.transpose();
  const auto index = own(piece);
  for (std::size_t i = 0, k = 0; i < 3; ++i) {
    const auto row = index[i];
    const double mixed = my * at.x.d[i] - mx * at.y.d[i];
    hessian.row(row) += mixed * dh.transpose();
    hessian.col(row) += mixed * dh;
    for (std::size_t n = 0; n <= i; ++n, ++k) {
      const auto column = index[n];
      const double own_part = mx * at.x.dd[k] + my * at.y.dd[k];
      hessian(row, column) += own_part;
      if (n < i) hessian(column, row) += own_part;
    }
  }
  return my * at.x.value - mx * at.y.value;
}

void PathGeometry::add_curvature(std::size_t piece, const LocalPose& at, const PoseMultiplier& multiplier,
                                 Eigen::MatrixXd& hessian) {
  turned_by_[piece] += add_own_curvature(piece, at, multiplier.x, multiplier.y, hessian) + multiplier.heading;
  behind_[piece].x += multiplier.x;
  behind_[piece].y += multiplier.y;
  if (multiplier.heading == 0) return;
  const auto index = own(piece);
  for (std::size_t i = 0, k = 0; i < 3; ++i)
    for (std::size_t n = 0; n <= i; ++n, ++k) {
      const auto row = index[i], column = index[n];
      hessian(row, column) += multiplier.heading * at.turn.dd[k];
      if (n < i) hessian(column, row) += multiplier.heading * at.turn.dd[k];
    }
}

void PathGeometry::finish_curvature(const Eigen::VectorXd& target_multipliers, Eigen::MatrixXd& hessian) {
  const std::size_t count = program_.pieces.size();
  std::vector<PoseMultiplier> at_end(count);
  Eigen::Index row = 0;
  for (const Target& target : program_.targets) {
    at_end[target.piece].x += target_multipliers[row++];
    at_end[target.piece].y += target_multipliers[row++];
    if (target.heading_rad) at_end[target.piece].heading += target_multipliers[row++];
  }
  double lx = 0, ly = 0, turned = 0;
  for (std::size_t j = count; j-- > 0;) {
    lx += at_end[j].x;
    ly += at_end[j].y;
    turned += at_end[j].heading;
    const LocalPose& whole = whole_[j];
    const double here = add_own_curvature(j, whole, lx, ly, hessian);
    const auto index = own(j);
    for (std::size_t i = 0, k = 0; i < 3; ++i)
      for (std::size_t n = 0; n <= i; ++n, ++k) {
        const auto r = index[i], c = index[n];
        hessian(r, c) += turned * whole.turn.dd[k];
        if (n < i) hessian(c, r) += turned * whole.turn.dd[k];
      }
    turned += here + turned_by_[j];
    lx += behind_[j].x;
    ly += behind_[j].y;
  }
}

}  // namespace joulepath::joint
