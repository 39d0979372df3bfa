#include "planner/path/shape/direction_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/path/geometry/path.hpp"
#include "planner/path/geometry/segment_ends.hpp"
// Design: docs/decisions/0200-paths.md
namespace joulepath {
namespace {

constexpr double kHalfTrack_m = 0.25;      ///< of the segments: that of a robot is not known here
constexpr double kMostPhi_rad = 1.55;      ///< beyond, the robot turns in place
constexpr double kKnotPhi_rad = 0.0005;    ///< off the line between its neighbors: a pose that needs a knot
constexpr double kLongest_m = 2;           ///< between knots
constexpr double kOffHeading_rad = 0.003;  ///< of a pose from the curve
/// w, and how many knots may follow each other freely: the first pair that keeps the poses.
constexpr struct {
  double smooth_m;
  std::size_t window;
} kAttempts[] = {{0.03, 24}, {0.03, 12}, {0.01, 12}, {0.003, 6}};
constexpr double kStep = 1e-6;      ///< of difference quotients
constexpr double kSettled = 1e-10;  ///< change of phi in rad and of lengths in m
constexpr int kFitRounds = 8, kClosings = 4;
constexpr std::size_t kMostKnots = 2000;

using Shape = DirectionSegment::Shape;

/// Length and angle of the motion from each pose to the next, as along an arc.
struct Step {
  double length_m{};  ///< tau
  double phi_rad{};
};

std::vector<Step> steps_between(const std::vector<Pose>& poses) {
  std::vector<Step> steps;
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const double turn_rad = poses[i + 1].heading_rad - poses[i].heading_rad, half = 0.5 * turn_rad;
    const double chord_m = std::hypot(poses[i + 1].x_m - poses[i].x_m, poses[i + 1].y_m - poses[i].y_m);
    const double arc_m = std::abs(half) > 1e-6 ? chord_m * half / std::sin(half) : chord_m;
    steps.push_back({std::hypot(arc_m, kHalfTrack_m * turn_rad), std::atan2(kHalfTrack_m * turn_rad, arc_m)});
  }
  return steps;
}

/// Some poses, in order, between which phi is nearly linear over the length.
class Knots {
 public:
  explicit Knots(const std::vector<Step>& steps) : at_m_{0.0} {
    for (const Step& step : steps) at_m_.push_back(at_m_.back() + step.length_m);
    phi_ = {steps.front().phi_rad};
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const double before = steps[i - 1].length_m, after = steps[i].length_m;
      phi_.push_back((after * steps[i - 1].phi_rad + before * steps[i].phi_rad) / (before + after));
    }
    phi_.push_back(steps.back().phi_rad);
    if (steps.size() > 1) {
      phi_.front() = 2 * steps.front().phi_rad - phi_[1];
      phi_.back() = 2 * steps.back().phi_rad - phi_[steps.size() - 1];
    }
    cut(steps.size());
  }

  bool complete() const { return complete_; }

  const std::vector<std::size_t>& poses() const { return knots_; }
  double phi_rad(std::size_t pose) const { return phi_[pose]; }
  double length_m(std::size_t from, std::size_t to) const { return at_m_[to] - at_m_[from]; }

 private:
  /// The knots (Douglas and Peucker's rule); more than kMostKnots are not sought.
  void cut(std::size_t last) {
    std::vector<std::size_t> ahead{last};
    knots_ = {0};
    while (!ahead.empty() && knots_.size() + ahead.size() <= kMostKnots + 1) {
      const std::size_t worst = worst_between(knots_.back(), ahead.back());
      if (worst > knots_.back()) {
        ahead.push_back(worst);
      } else {
        knots_.push_back(ahead.back());
        ahead.pop_back();
      }
    }
    complete_ = ahead.empty();
  }

  /// The pose that needs a knot; `from` where none does.
  std::size_t worst_between(std::size_t from, std::size_t to) const {
    double most = 0;
    std::size_t worst = from;
    for (std::size_t i = from + 1; i < to; ++i) {
      const double share = length_m(from, i) / length_m(from, to);
      const double off = std::abs(phi_[i] - (1 - share) * phi_[from] - share * phi_[to]);
      if (off > most) most = off, worst = i;
    }
    if (most > kKnotPhi_rad) return worst;
    return length_m(from, to) > kLongest_m ? from + (to - from) / 2 : from;
  }

  std::vector<double> at_m_{}, phi_{};
  std::vector<std::size_t> knots_{};
  bool complete_{};
};

Eigen::Vector3d miss(const Pose& from, const Shape& shape, const Pose& to) {
  const Pose end = end_of(DirectionSegment(from, shape)).pose;
  return {end.x_m - to.x_m, end.y_m - to.y_m, kHalfTrack_m * (end.heading_rad - to.heading_rad)};
}

/// The least squares over phi at the knots and lengths between them: unknowns phi_0, tau_0, phi_1, ...
class Shooting {
 public:
  Shooting(const std::vector<Pose>& poses, const Knots& knots, double smooth_m) : smooth_m_(smooth_m) {
    for (std::size_t k = 0; k < knots.poses().size(); ++k) {
      const std::size_t pose = knots.poses()[k];
      poses_.push_back(poses[pose]);
      phi_.push_back(within(knots.phi_rad(pose)));
      if (k > 0) length_.push_back(knots.length_m(knots.poses()[k - 1], pose));
    }
  }

  void settle() {
    for (int round = 0; round < kFitRounds && step() > kSettled; ++round) continue;
  }

  /// Changes phi least so that the segments, one after the other, pass every `window`-th knot and end at the
  /// last pose.
  void pass_knots(std::size_t window) {
    const std::size_t count = length_.size(), windows = std::max<std::size_t>(1, count / window);
    for (std::size_t k = 0; k < windows; ++k) close(window * k, k + 1 < windows ? window * (k + 1) : count);
  }

  std::vector<CurveSegment> segments() const {
    std::vector<CurveSegment> all;
    Pose here = poses_.front();
    for (std::size_t k = 0; k < length_.size(); ++k) {
      all.push_back(DirectionSegment(here, shape(k)));
      here = end_of(all.back()).pose;
    }
    return all;
  }

 private:
  Shape shape(std::size_t k) const { return {phi_[k], phi_[k + 1], length_[k], kHalfTrack_m}; }

  /// The end of segments from their first pose, less the pose there.
  Eigen::Vector3d end_off(std::size_t first, std::size_t last) const {
    Pose here = poses_[first];
    for (std::size_t k = first; k + 1 < last; ++k) here = end_of(DirectionSegment(here, shape(k))).pose;
    return miss(here, shape(last - 1), poses_[last]);
  }

  /// Between two knots whose phi stays, except at the ends of the curve.
  void close(std::size_t first, std::size_t last) {
    const std::size_t from = first == 0 ? 0 : first + 1, to = last == length_.size() ? last : last - 1;
    for (int round = 0; round < kClosings; ++round) {
      const Eigen::Vector3d off = end_off(first, last);
      if (off.norm() < 1e-12) return;
      Eigen::Matrix3Xd slopes(3, static_cast<Eigen::Index>(to - from + 1));
      for (std::size_t k = from; k <= to; ++k) {
        const double kept = std::exchange(phi_[k], phi_[k] - std::copysign(kStep, phi_[k]));
        slopes.col(static_cast<Eigen::Index>(k - from)) = (end_off(first, last) - off) / (phi_[k] - kept);
        phi_[k] = kept;
      }
      const Eigen::Matrix3d square = slopes * slopes.transpose() + 1e-14 * Eigen::Matrix3d::Identity();
      const Eigen::VectorXd change = -slopes.transpose() * square.ldlt().solve(off);
      if (!change.allFinite()) return;
      for (std::size_t k = from; k <= to; ++k)
        phi_[k] = within(phi_[k] + change[static_cast<Eigen::Index>(k - from)]);
    }
  }

  static double within(double phi_rad) { return std::clamp(phi_rad, -kMostPhi_rad, kMostPhi_rad); }

  void move(const Eigen::VectorXd& change) {
    for (std::size_t k = 0; k < phi_.size(); ++k)
      phi_[k] = within(phi_[k] + change[2 * static_cast<Eigen::Index>(k)]);
    for (std::size_t k = 0; k < length_.size(); ++k)
      length_[k] = std::max(0.5 * length_[k], length_[k] + change[2 * static_cast<Eigen::Index>(k) + 1]);
  }

  /// A step of Gauss and Newton; its size.
  double step() {
    const auto count = static_cast<Eigen::Index>(phi_.size() + length_.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd off(3 * static_cast<Eigen::Index>(length_.size()) +
                        static_cast<Eigen::Index>(phi_.size()));
    off.setZero();
    for (std::size_t k = 0; k < length_.size(); ++k) {
      const Eigen::Vector3d here = miss(poses_[k], shape(k), poses_[k + 1]);
      const auto row = 3 * static_cast<Eigen::Index>(k), column = 2 * static_cast<Eigen::Index>(k);
      off.segment<3>(row) = here;
      for (int u = 0; u < 3; ++u) {
        Shape moved = shape(k);
        double& value = u == 0 ? moved.from_rad : u == 1 ? moved.length_m : moved.to_rad;
        const double change = u == 1 ? kStep * value : -std::copysign(kStep, value);
        value += change;
        const Eigen::Vector3d slope = (miss(poses_[k], moved, poses_[k + 1]) - here) / change;
        for (int axis = 0; axis < 3; ++axis) entries.emplace_back(row + axis, column + u, slope[axis]);
      }
    }
    for (std::size_t k = 1; k + 1 < phi_.size(); ++k) {
      const auto row = 3 * static_cast<Eigen::Index>(length_.size()) + static_cast<Eigen::Index>(k);
      const double before = length_[k - 1], after = length_[k], share = before / (before + after);
      const double weights[] = {share - 1, 1, -share};
      for (int u = -1; u <= 1; ++u) {
        const double weight = smooth_m_ * weights[u + 1];
        entries.emplace_back(row, 2 * (static_cast<Eigen::Index>(k) + u), weight);
        off[row] += weight * phi_[k + static_cast<std::size_t>(u + 1) - 1];
      }
    }
    Eigen::SparseMatrix<double> slopes(off.size(), count);
    slopes.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseMatrix<double> square = slopes.transpose() * slopes;
    for (Eigen::Index i = 0; i < count; ++i) square.coeffRef(i, i) += 1e-14;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(square);
    const Eigen::VectorXd change = factors.solve(-(slopes.transpose() * off));
    if (!change.allFinite()) return 0;
    move(change);
    return change.cwiseAbs().maxCoeff();
  }

  std::vector<Pose> poses_{};  ///< at the knots
  std::vector<double> phi_{}, length_{};
  double smooth_m_{};
};

/// Headings without jumps of whole turns.
std::vector<Pose> unwrapped(std::vector<Pose> poses) {
  for (std::size_t i = 1; i < poses.size(); ++i)
    poses[i].heading_rad =
        poses[i - 1].heading_rad + wrapped_angle_rad(poses[i].heading_rad - poses[i - 1].heading_rad);
  return poses;
}

/// Whether every pose is on the curve. The point of the curve is the nearest in place and, times
/// kHalfTrack_m, heading.
bool on_curve(const std::vector<CurveSegment>& segments, const std::vector<Pose>& poses, const Knots& knots,
              double tolerance_m) {
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const std::size_t from = knots.poses()[k], to = knots.poses()[k + 1];
    for (std::size_t i = from; i <= to; ++i) {
      const auto& segment = std::get<DirectionSegment>(segments[k]);
      double at_m = segment.length_m() * knots.length_m(from, i) / knots.length_m(from, to);
      for (int round = 0; round < 4; ++round) {
        const Pose here = segment.at(at_m).pose;
        const double turn_m = kHalfTrack_m * kHalfTrack_m * segment.bend(at_m).curvature_per_m;
        at_m += ((poses[i].x_m - here.x_m) * std::cos(here.heading_rad) +
                 (poses[i].y_m - here.y_m) * std::sin(here.heading_rad) +
                 turn_m * (poses[i].heading_rad - here.heading_rad)) /
                (1 + turn_m * turn_m / (kHalfTrack_m * kHalfTrack_m));
        at_m = std::clamp(at_m, 0.0, segment.length_m());
      }
      const Pose here = segment.at(at_m).pose;
      if (std::hypot(poses[i].x_m - here.x_m, poses[i].y_m - here.y_m) > tolerance_m) return false;
      if (std::abs(poses[i].heading_rad - here.heading_rad) > kOffHeading_rad) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<Curve> direction_fit(const std::vector<Pose>& poses, double tolerance_m, Direction direction) {
  if (poses.size() < 3) return std::nullopt;
  const std::vector<Pose> along = unwrapped(poses);
  const std::vector<Step> steps = steps_between(along);
  if (std::any_of(steps.begin(), steps.end(),
                  [](const Step& s) { return !(std::abs(s.phi_rad) < kMostPhi_rad); }))
    return std::nullopt;
  const Knots knots(steps);
  if (!knots.complete()) return std::nullopt;
  for (const auto& [smooth_m, window] : kAttempts) {
    Shooting shooting(along, knots, smooth_m);
    shooting.settle();
    shooting.pass_knots(window);
    std::vector<CurveSegment> segments = shooting.segments();
    if (on_curve(segments, along, knots, tolerance_m)) return Curve(std::move(segments), direction);
  }
  return std::nullopt;
}

}  // namespace joulepath
