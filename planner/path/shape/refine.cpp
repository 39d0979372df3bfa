#include "planner/path/shape/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/path/shape/corner_blend.hpp"
#include "planner/path/shape/nlopt_run.hpp"

// Method: [Powell1994]
namespace joulepath {
namespace {

constexpr double kShortestMoved_m = 0.02;
constexpr double kLongestHandle_m = 4.0;
constexpr double kReach_m = 3.0;         // how far a vertex may move
constexpr double kShortestLead_m = 0.1;  // of the line at an end whose heading is kept
constexpr double kClearanceMargin_m = 0.002;
constexpr double kNotDrivable = 10;  // in units of the initial cost
constexpr std::size_t kPerCorner = 4;

/// Coordinates of a corner's vertex: origin + p along + q across.
struct Frame {
  Point2 origin_m{};
  Point2 along{1, 0};
  bool on_line{};  ///< q stays 0

  Point2 at(double p, double q) const {
    return {origin_m[0] + p * along[0] - q * along[1], origin_m[1] + p * along[1] + q * along[0]};
  }
};

/// The problem for NLopt. Variables of each corner: p, q, a, b.
class Refinement {
 public:
  Refinement(const FootprintChecker& checker, const PathCost& cost, const SmoothPath& initial,
             double initial_cost, const RefineOptions& options);

  bool run();
  double best() const { return best_ * scale_; }
  Path best_path() const { return *spline_path(start_m_, corners_of(best_x_), goal_m_); }
  int evaluations() const { return evaluations_; }

 private:
  struct Trial {
    std::vector<double> x{};
    std::optional<Path> path{};
    double slack_m{};
  };
  std::vector<SplineCorner> corners_of(const std::vector<double>& x) const;
  const Trial& trial(const std::vector<double>& x);
  double objective(const std::vector<double>& x);
  void constraints(double* result, const std::vector<double>& x);
  std::vector<double> first_guess();

  const FootprintChecker& checker_;
  const PathCost& cost_;
  const RefineOptions& options_;
  Point2 start_m_{}, goal_m_{};
  double scale_;  ///< of the cost: the initial one
  std::vector<CornerReport> initial_{};
  std::vector<Frame> frames_{};
  Trial last_{};
  int evaluations_{};
  double best_{1.0};
  std::vector<double> best_x_{};
};

Refinement::Refinement(const FootprintChecker& checker, const PathCost& cost, const SmoothPath& initial,
                       double initial_cost, const RefineOptions& options)
    : checker_(checker),
      cost_(cost),
      options_(options),
      start_m_(initial.polyline_m.front()),
      goal_m_(initial.polyline_m.back()),
      scale_(initial_cost) {
  for (const CornerReport& corner : initial.corners)
    if (std::abs(corner.angle_rad) > 1e-6) initial_.push_back(corner);
  const Pose first = initial.path.start(), last = initial.path.end();
  for (const CornerReport& corner : initial_) frames_.push_back({.origin_m = {corner.x_m, corner.y_m}});
  if (frames_.empty()) return;
  if (options.keep_start_heading)
    frames_.front() = {start_m_, {std::cos(first.heading_rad), std::sin(first.heading_rad)}, true};
  if (options.keep_goal_heading)
    frames_.back() = {goal_m_, {-std::cos(last.heading_rad), -std::sin(last.heading_rad)}, true};
}

std::vector<SplineCorner> Refinement::corners_of(const std::vector<double>& x) const {
  std::vector<SplineCorner> corners;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const double* corner = &x[kPerCorner * i];
    corners.push_back({frames_[i].at(corner[0], corner[1]), corner[2], corner[3]});
  }
  return corners;
}

/// The path at x and its clearance; NLopt evaluates cost and constraints at the same x in turn.
const Refinement::Trial& Refinement::trial(const std::vector<double>& x) {
  if (last_.x != x) {
    last_ = {.x = x, .path = spline_path(start_m_, corners_of(x), goal_m_)};
    last_.slack_m = last_.path ? checker_.least_slack_m(*last_.path) : -1.0;
  }
  return last_;
}

double Refinement::objective(const std::vector<double>& x) {
  ++evaluations_;
  const Trial& here = trial(x);
  if (!here.path) return kNotDrivable;
  const double value = cost_(*here.path) / scale_;
  if (!std::isfinite(value)) return kNotDrivable;
  if (value < best_ && here.slack_m >= kClearanceMargin_m && !checker_.first_collision(*here.path))
    best_ = value, best_x_ = x;
  return value;
}

/// One row per straight line between corners, then clearance: all <= 0 where satisfied, in metres.
void Refinement::constraints(double* result, const std::vector<double>& x) {
  const auto corners = corners_of(x);
  const auto point = [&](std::size_t i) {
    return i == 0 ? start_m_ : i <= corners.size() ? corners[i - 1].vertex_m : goal_m_;
  };
  const auto heading_rad = [&](std::size_t i) {  // of the line from point i
    return std::atan2(point(i + 1)[1] - point(i)[1], point(i + 1)[0] - point(i)[0]);
  };
  double used_m = 0;  // of the line, by the corner at its start
  for (std::size_t i = 0; i <= corners.size(); ++i) {
    double after_m = 0;
    if (i < corners.size()) {
      const double turn_rad = std::abs(wrapped_angle_rad(heading_rad(i + 1) - heading_rad(i)));
      used_m += spline_tangent_m(corners[i], turn_rad, true);
      after_m = spline_tangent_m(corners[i], turn_rad, false);
    }
    result[i] = used_m + 0.02 - std::hypot(point(i + 1)[0] - point(i)[0], point(i + 1)[1] - point(i)[1]);
    used_m = after_m;
  }
  const Trial& here = trial(x);
  result[corners.size() + 1] = here.path ? kClearanceMargin_m - here.slack_m : 1.0;
}

/// The vertices and tangent lengths of the initial blends, handles shortened until the path is free.
std::vector<double> Refinement::first_guess() {
  for (double share = 1.0; share > 0.05; share *= 0.9) {
    std::vector<double> x;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const CornerReport& corner = initial_[i];
      const double dx = corner.x_m - frames_[i].origin_m[0], dy = corner.y_m - frames_[i].origin_m[1];
      const double tangent_m =
          corner.radius_m > 0 ? corner.radius_m * blend_shape(corner.angle_rad).tangent : 0.3;
      const double per_handle = 1 + 2 * std::cos(0.5 * corner.angle_rad);
      const double handle_m = std::max(kShortestMoved_m, share * tangent_m / per_handle);
      const Point2& along = frames_[i].along;
      const double p = dx * along[0] + dy * along[1], q = dy * along[0] - dx * along[1];
      x.insert(x.end(), {p, frames_[i].on_line ? 0.0 : q, handle_m, handle_m});
    }
    if (trial(x).slack_m >= kClearanceMargin_m) return x;
  }
  return {};
}

bool Refinement::run() {
  if (frames_.empty()) return false;
  std::vector<double> x = first_guess();
  if (x.empty()) return false;
  nlopt::opt optimizer(nlopt::LN_COBYLA, static_cast<unsigned>(x.size()));
  std::vector<double> lower(x.size()), upper(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Frame& frame = frames_[i / kPerCorner];
    const bool handle = i % kPerCorner >= 2, across = i % kPerCorner == 1;
    lower[i] = handle ? kShortestMoved_m : x[i] - kReach_m;
    upper[i] = handle ? kLongestHandle_m : x[i] + kReach_m;
    if (frame.on_line && across) lower[i] = upper[i] = 0.0;
    if (frame.on_line && !across && !handle) lower[i] = std::max(lower[i], kShortestLead_m);
    x[i] = std::clamp(x[i], lower[i], upper[i]);
  }
  optimizer.set_lower_bounds(lower);
  optimizer.set_upper_bounds(upper);
  optimizer.set_initial_step(std::vector<double>(x.size(), options_.first_step_m));
  optimizer.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                                 void* self) { return static_cast<Refinement*>(self)->objective(at); },
                              this);
  optimizer.add_inequality_mconstraint(
      [](unsigned, double* result, unsigned n, const double* at, double*, void* self) {
        static_cast<Refinement*>(self)->constraints(result, std::vector<double>(at, at + n));
      },
      this, std::vector<double>(frames_.size() + 2, 1e-6));
  optimizer.set_ftol_rel(options_.relative_tolerance);
  optimizer.set_xtol_rel(1e-5);
  optimizer.set_maxeval(options_.evaluations_per_corner * static_cast<int>(frames_.size()));
  optimize_as_far_as_possible(optimizer, x);
  return !best_x_.empty();
}

}  // namespace

RefineResult refine_path(const FootprintChecker& checker, const SmoothPath& initial, const PathCost& cost,
                         const RefineOptions& options) {
  RefineResult result{.path = initial.path, .evaluations = 1};
  result.cost_before = result.cost = cost(initial.path);
  if (initial.polyline_m.size() < 3 || initial.path.pieces.empty() || !std::isfinite(result.cost) ||
      result.cost <= 0)
    return result;
  Refinement refinement(checker, cost, initial, result.cost, options);
  result.improved = refinement.run();
  result.evaluations += refinement.evaluations();
  if (!result.improved) return result;
  result.path = refinement.best_path();
  result.cost = refinement.best();
  return result;
}

}  // namespace joulepath
