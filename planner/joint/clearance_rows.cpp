#include "planner/joint/clearance_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace joulepath::joint {
namespace {

constexpr double kFar_m = 0.1 - 1e-9;                 ///< the slack is not followed beyond
constexpr double kStep_m = 1e-4, kBendStep_m = 0.01;  ///< of differences
constexpr double kActive = 1e-6, kFlat = 1e-9;
constexpr double kLeastSlack_m = 0.03;
constexpr double kPart_m = 0.6, kMostParts = 24;
constexpr double kOverlap = 0.25;  ///< of a part at each end
/// Places near a stop without room, each a row of its own: the least slack is that of the stop, which no path
/// changes.
constexpr std::array<double, 3> kNearStop_m{0.003, 0.01, 0.03};
constexpr double kLook_m = 0.1, kPolygonLook_m = 0.2;  ///< a polygon's slack costs far more
constexpr double kMostLooks = 24, kCloser = 0.1;
constexpr double kLeastOpening_per_m = 0.1;
constexpr double kStopShare = 0.5, kOpening = 0.01;  ///< of the margin near a stop

Pose on_floor(const Pose& frame, const Pose& pose) {
  const double c = std::cos(frame.heading_rad), s = std::sin(frame.heading_rad);
  return {frame.x_m + c * pose.x_m - s * pose.y_m, frame.y_m + s * pose.x_m + c * pose.y_m,
          frame.heading_rad + pose.heading_rad};
}

}  // namespace

/// Whether a piece begins where the robot stands at a given place.
bool ClearanceRows::leaves_stop(std::size_t piece) const {
  if (piece == 0) return true;
  const Piece& before = program_.pieces[piece - 1];
  return before.leg != program_.pieces[piece].leg || (before.turns && leaves_stop(piece - 1));
}

bool ClearanceRows::reaches_stop(std::size_t piece) const {
  if (piece + 1 == program_.pieces.size()) return true;
  const Piece& next = program_.pieces[piece + 1];
  return next.leg != program_.pieces[piece].leg || (next.turns && reaches_stop(piece + 1));
}

void ClearanceRows::lay_out(const Eigen::VectorXd& parameters) {
  if (!program_.checker) return;
  PathGeometry geometry(program_);
  geometry.place(parameters);
  const auto slack_at_m = [&](const Pose& pose) {
    return std::max(0.0, program_.checker->near_slack_m(on_floor(program_.frame, pose)));
  };
  stops_.push_back({{0, 0}, slack_at_m({})});
  for (const Target& target : program_.targets)
    stops_.push_back(
        {target.at_m, slack_at_m({target.at_m[0], target.at_m[1],
                                  target.heading_rad.value_or(geometry.pose(target.piece, 1).heading_rad)})});
  const auto tight = [&](std::size_t stop) { return stop < stops_.size() && stops_[stop].slack_m < kFar_m; };
  for (std::size_t j = 0; j < program_.pieces.size(); ++j) {
    const Piece& piece = program_.pieces[j];
    if (piece.turns && program_.checker->is_disc()) continue;
    const double length_m = parameters[program_.length_of(j)];
    const double count = std::clamp(std::ceil(length_m / kPart_m), 1.0, kMostParts);
    double begin = -kOverlap / count, end = 1 - begin;
    if (j > 0 && leaves_stop(j - 1))
      begin = std::max(begin, -0.5 * parameters[program_.length_of(j - 1)] / length_m);
    if (j + 1 < program_.pieces.size() && reaches_stop(j + 1))
      end = std::min(end, 1 + 0.5 * parameters[program_.length_of(j + 1)] / length_m);
    for (const double from_m : kNearStop_m) {
      const double share = from_m / length_m;
      if (share > 0.5) break;
      if (leaves_stop(j) && tight(piece.leg)) {
        begin = share;
        parts_.push_back({j, begin, begin, {}});
      }
      if (reaches_stop(j) && tight(piece.leg + 1)) {
        end = 1 - share;
        parts_.push_back({j, end, end, {}});
      }
    }
    for (double i = 0; i < count; ++i) {
      const double from = std::max(begin, (i - kOverlap) / count),
                   to = std::min(end, (i + 1 + kOverlap) / count);
      if (from < to) parts_.push_back({j, from, to, {}});
    }
  }
}

/// A place on a piece, or beyond its ends on a neighbor without a rest between.
ClearanceRows::Place ClearanceRows::place(const PathGeometry& geometry, std::size_t piece,
                                          double share) const {
  const auto beyond = [&](std::size_t neighbor, double part) {
    return std::min(1.0, part * geometry.length_m(piece) / geometry.length_m(neighbor));
  };
  if (share < 0) {
    const bool joined = piece > 0 && !program_.pieces[piece - 1].rests_after;
    return joined ? Place{piece - 1, 1 - beyond(piece - 1, -share)} : Place{piece, 0};
  }
  if (share <= 1) return {piece, share};
  const bool joined = piece + 1 < program_.pieces.size() && !program_.pieces[piece].rests_after;
  return joined ? Place{piece + 1, beyond(piece + 1, share - 1)} : Place{piece, 1};
}

/// Looks along the part, then at the vertex of the parabola through the least look and its neighbors, and at
/// that of a closer one: the slopes are those at the place, so it must be near.
ClearanceRows::Nearest ClearanceRows::nearest(const PathGeometry& geometry, const Part& part) const {
  const auto look = [&](double share) {
    const Place at = place(geometry, part.piece, share);
    return Nearest{at, slack_m(geometry.near_pose(at.piece, at.share)), false};
  };
  if (part.from == part.to) return look(part.from);
  const double length_m = (part.to - part.from) * geometry.length_m(part.piece);
  const int looks = static_cast<int>(std::clamp(
      std::ceil(length_m / (program_.checker->is_disc() ? kLook_m : kPolygonLook_m)), 2.0, kMostLooks));
  const double step = (part.to - part.from) / looks;
  std::array<double, static_cast<std::size_t>(kMostLooks) + 1> slacks{};
  Nearest least{.slack_m = kNoLimit};
  int k = 0;
  for (int i = 0; i <= looks; ++i) {
    const Nearest here = look(part.from + i * step);
    slacks[i] = here.slack_m;
    if (here.slack_m < least.slack_m) least = here, k = i;
  }
  if (k == 0 || k == looks || least.slack_m >= kFar_m - program_.margin_m) return least;
  least.inside = true;
  double share = part.from + k * step, before = slacks[k - 1], after = slacks[k + 1];
  for (double width = step;; width *= kCloser) {
    const double bend = before + after - 2 * least.slack_m;
    if (!(bend > 0)) return least;
    share += std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) * width;
    least = look(share);
    least.inside = true;
    if (width < step) return least;
    before = look(share - kCloser * width).slack_m;
    after = look(share + kCloser * width).slack_m;
  }
}

/// Near a stop no more than a share of the slack there.
double ClearanceRows::margin_m(const Pose& pose) const {
  double margin_m = program_.margin_m;
  if (margin_m > 0)
    for (const Stop& stop : stops_)
      margin_m = std::min(margin_m,
                          kStopShare * stop.slack_m + kOpening * distance_m(stop.at_m, {pose.x_m, pose.y_m}));
  return margin_m;
}

double ClearanceRows::slack_m(const Pose& pose) const {
  return program_.checker->near_slack_m(on_floor(program_.frame, pose)) - margin_m(pose);
}

std::vector<ClearanceRows::Nearest> ClearanceRows::nearest(const PathGeometry& geometry) const {
  std::vector<Nearest> all;
  for (const Part& part : parts_) all.push_back(nearest(geometry, part));
  return all;
}

std::vector<ClearanceRows::Nearest> ClearanceRows::present() const {
  std::vector<Nearest> all;
  for (const Part& part : parts_) all.push_back(part.at);
  return all;
}

void ClearanceRows::begin(const std::vector<Nearest>& nearest, double mu) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    parts_[i].row.begin(nearest[i].slack_m, kLeastSlack_m, mu);
    parts_[i].at = nearest[i];
  }
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

void ClearanceRows::add(Part& part, PathGeometry& geometry, double mu) {
  const Nearest& at = part.at;
  const Pose pose = geometry.near_pose(at.place.piece, at.place.share);
  const Slopes by = slopes(pose, at.slack_m);
  const LocalPose local = geometry.local(at.place.piece, at.place.share);
  const PoseSlopes places = geometry.slopes(at.place.piece, local);
  PieceSums& sums = geometry.sums(at.place.piece);
  part.gradient = places.transpose() * Eigen::Vector3d(by.x, by.y, by.heading);
  const double z = part.row.z;
  sums.gradient -= part.row.push(mu) * part.gradient;
  sums.lagrangian -= z * part.gradient;
  sums.hessian += part.row.stiffness() * part.gradient * part.gradient.transpose();
  if (z < kActive) return;
  const double size = std::max(1e-3, std::hypot(by.x, by.y));
  const PieceGradient across = (by.x * places.row(1) - by.y * places.row(0)).transpose() / size;
  sums.hessian -= z * by.bend * across * across.transpose();
  sums.hessian += geometry.curvature(at.place.piece, local, {-z * by.x, -z * by.y, -z * by.heading});
  if (!at.inside || !program_.checker->is_disc()) return;
  // Along the path, d the distance, u the rate of its length, kappa its curvature, n = +-(its normal):
  // d_f = 0,  d_ff = u^2 (bend +- kappa),  d_fp = u (bend t . x_p +- heading_p),  D2 min d = D2 d - d_fp
  // d_fp' / d_ff.
  const double c = std::cos(pose.heading_rad), s = std::sin(pose.heading_rad);
  const double side = by.y * c - by.x * s > 0 ? 1.0 : -1.0;
  const double turn = side * geometry.curvature_per_m(at.place.piece, at.place.share),
               opening = by.bend + turn;
  if (opening < kLeastOpening_per_m) return;
  const PieceGradient slide =
      (by.bend * (c * places.row(0) + s * places.row(1)) + side * places.row(2)).transpose();
  sums.hessian += z / opening * slide * slide.transpose();
}

ClearanceRows::Sums ClearanceRows::assemble(PathGeometry& geometry, double mu) {
  Sums sums;
  for (Part& part : parts_) {
    part.gradient.setZero();
    if (part.row.value < kFar_m - program_.margin_m) add(part, geometry, mu);
    // The start of the path does not move.
    const Eigen::Index fixed = part.at.place.piece == 0 ? 3 : 0;
    sums.lost |= part.row.value < 0 && part.gradient.tail(6 - fixed).lpNorm<Eigen::Infinity>() < kFlat;
    sums.least_m = std::min(sums.least_m, part.row.value);
    sums.complementarity += part.row.s * part.row.z;
    sums.primal += std::abs(part.row.residual()) * part.row.z;
  }
  return sums;
}

void ClearanceRows::step(const std::vector<PieceGradient>& changes, double mu, StepLengths& lengths) {
  for (Part& part : parts_) part.row.step(part.gradient.dot(changes[part.at.place.piece]), mu, lengths);
}

double ClearanceRows::merit(const std::vector<Nearest>& nearest, double step, double mu) const {
  double sum = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    sum += parts_[i].row.merit(step, nearest[i].slack_m, mu, 1.0);
  return sum;
}

void ClearanceRows::take(const std::vector<Nearest>& nearest, double primal, double dual, double mu) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    parts_[i].row.take(primal, dual, nearest[i].slack_m, mu);
    parts_[i].at = nearest[i];
  }
}

}  // namespace joulepath::joint
