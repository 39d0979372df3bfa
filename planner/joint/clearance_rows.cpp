#include "planner/joint/clearance_rows.hpp"

#include <cmath>

namespace joulepath::joint {
namespace {

constexpr double kFar_m = 0.1 - 1e-9;                 ///< the slack is not followed beyond
constexpr double kStep_m = 1e-4, kBendStep_m = 0.01;  ///< of differences
constexpr double kActive = 1e-6;
constexpr double kLeastSlack_m = 0.03;

Pose on_floor(const Pose& frame, const Pose& pose) {
  const double c = std::cos(frame.heading_rad), s = std::sin(frame.heading_rad);
  return {frame.x_m + c * pose.x_m - s * pose.y_m, frame.y_m + s * pose.x_m + c * pose.y_m,
          frame.heading_rad + pose.heading_rad};
}

}  // namespace

void ClearanceRows::lay_out() {
  if (!program_.checker) return;
  for (std::size_t j = 0; j < program_.pieces.size(); ++j) {
    const std::size_t count = program_.pieces[j].segments;
    const bool last = j + 1 == program_.pieces.size();
    for (std::size_t i = 1; i <= count - (last ? 1 : 0); ++i)
      nodes_.push_back({j, static_cast<double>(i) / static_cast<double>(count), {}, {}});
  }
}

double ClearanceRows::slack_m(const Pose& pose) const {
  return program_.checker->near_slack_m(on_floor(program_.frame, pose)) - program_.margin_m;
}

std::vector<double> ClearanceRows::values(const PathGeometry& geometry) const {
  std::vector<double> values;
  for (const Node& node : nodes_) values.push_back(slack_m(geometry.pose(node.piece, node.share)));
  return values;
}

std::vector<double> ClearanceRows::present() const {
  std::vector<double> values;
  for (const Node& node : nodes_) values.push_back(node.row.value);
  return values;
}

void ClearanceRows::begin(const std::vector<double>& values, double mu) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].row.begin(values[i], kLeastSlack_m, mu);
}

ClearanceRows::Slopes ClearanceRows::slopes(const Pose& pose, double here_m) const {
  const auto at = [&](double dx, double dy, double turn) {
    return slack_m({pose.x_m + dx, pose.y_m + dy, pose.heading_rad + turn});
  };
  const auto central = [&](double dx, double dy, double turn) {
    return (at(kStep_m * dx, kStep_m * dy, kStep_m * turn) -
            at(-kStep_m * dx, -kStep_m * dy, -kStep_m * turn)) /
           (2 * kStep_m);
  };
  Slopes slopes{.x = central(1, 0, 0), .y = central(0, 1, 0)};
  if (!program_.checker->is_disc()) slopes.heading = central(0, 0, 1);
  const double size = std::hypot(slopes.x, slopes.y);
  if (size < 1e-3) return slopes;
  const double tx = -slopes.y / size * kBendStep_m, ty = slopes.x / size * kBendStep_m;
  slopes.bend = std::max(0.0, at(tx, ty, 0) + at(-tx, -ty, 0) - 2 * here_m) / (kBendStep_m * kBendStep_m);
  return slopes;
}

void ClearanceRows::add(Node& node, PathGeometry& geometry, double mu, const Blocks& blocks) {
  const Pose pose = geometry.pose(node.piece, node.share);
  const Slopes by = slopes(pose, node.row.value);
  const LocalPose local = geometry.local(node.piece, node.share);
  const auto places = geometry.gradient(node.piece, local);
  node.gradient = by.x * places.col(0) + by.y * places.col(1) + by.heading * places.col(2);
  const double z = node.row.z;
  blocks.gradient -= node.row.push(mu) * node.gradient;
  blocks.lagrangian -= z * node.gradient;
  blocks.hessian.noalias() += node.row.stiffness() * node.gradient * node.gradient.transpose();
  if (z < kActive) return;
  const double size = std::max(1e-3, std::hypot(by.x, by.y));
  const Eigen::VectorXd across = (by.x * places.col(1) - by.y * places.col(0)) / size;
  blocks.hessian.noalias() -= z * by.bend * across * across.transpose();
  geometry.add_curvature(node.piece, local, {-z * by.x, -z * by.y, -z * by.heading}, blocks.hessian);
}

ClearanceRows::Sums ClearanceRows::assemble(PathGeometry& geometry, double mu, const Blocks& blocks) {
  Sums sums;
  for (Node& node : nodes_) {
    node.row.value = slack_m(geometry.pose(node.piece, node.share));
    node.gradient.resize(0);
    if (node.row.value < kFar_m - program_.margin_m) add(node, geometry, mu, blocks);
    sums.complementarity += node.row.s * node.row.z;
    sums.primal += std::abs(node.row.residual()) * node.row.z;
  }
  return sums;
}

void ClearanceRows::step(const Eigen::VectorXd& change, double mu, StepLengths& lengths) {
  for (Node& node : nodes_)
    node.row.step(node.gradient.size() ? node.gradient.dot(change) : 0.0, mu, lengths);
}

double ClearanceRows::merit(const std::vector<double>& values, double step, double mu) const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) sum += nodes_[i].row.merit(step, values[i], mu, 1.0);
  return sum;
}

void ClearanceRows::take(const std::vector<double>& values, double primal, double dual, double mu) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].row.take(primal, dual, values[i], mu);
}

}  // namespace joulepath::joint
