#include "planner/path/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>

namespace joulepath {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kShortestHandle_m = 0.02;
constexpr double kLongestHandle_m = 4.0;
constexpr double kReach_m = 3.0;        // how far a vertex may move
constexpr double kSampleStep_m = 0.03;  // of the clearance constraint; the final check is dense
constexpr double kClearanceMargin_m = 0.002;
constexpr std::size_t kPerCorner = 4;

std::vector<SplineCorner> corners_of(const std::vector<double>& x) {
  std::vector<SplineCorner> corners;
  for (std::size_t i = 0; i + kPerCorner <= x.size(); i += kPerCorner)
    corners.push_back({{x[i], x[i + 1]}, x[i + 2], x[i + 3]});
  return corners;
}

/// The problem that NLopt sees.
struct Problem {
  const FootprintChecker& checker;
  const PathCost& cost;
  Point2 start_m{}, goal_m{};
  Path initial{};
  double scale{1};  ///< of the cost: the initial one
  std::size_t corner_count{};
  int evaluations{};
  double best{kInfinity};
  std::vector<double> best_x{};

  /// The curve between the initial path's end turns.
  std::optional<Path> path_at(const std::vector<double>& x) const;
  double objective(const std::vector<double>& x);
  void constraints(unsigned m, double* result, const std::vector<double>& x) const;
  double least_slack_m(const Path& path) const;
};

std::optional<Path> Problem::path_at(const std::vector<double>& x) const {
  auto inner = spline_path(start_m, corners_of(x), goal_m);
  if (!inner) return std::nullopt;
  Path path;
  const Pose first = initial.start(), last = initial.end();
  if (is_turn(initial.pieces.front())) append_turn_to(path, first, inner->start().heading_rad);
  path.pieces.push_back(inner->pieces.front());
  if (is_turn(initial.pieces.back())) append_turn_to(path, first, last.heading_rad);
  return path;
}

double Problem::least_slack_m(const Path& path) const {
  double least = kInfinity;
  for (const PathPiece& piece : path.pieces) {
    const double length = piece_length(piece);
    const int steps = is_turn(piece) && checker.is_disc() ? 1 : static_cast<int>(length / kSampleStep_m) + 1;
    for (int k = 0; k <= steps; ++k)
      least = std::min(least, checker.slack_m(piece_point(piece, length * k / steps).pose));
  }
  return least;
}

double Problem::objective(const std::vector<double>& x) {
  ++evaluations;
  const auto path = path_at(x);
  if (!path) return 10;
  const double value = cost(*path) / scale;
  if (!std::isfinite(value)) return 10;
  if (value < best && least_slack_m(*path) >= kClearanceMargin_m && !checker.first_collision(*path))
    best = value, best_x = x;
  return value;
}

/// Clearance (one row), and one row per straight line between corners: all <= 0 where satisfied, in metres.
void Problem::constraints(unsigned m, double* result, const std::vector<double>& x) const {
  const auto corners = corners_of(x);
  for (std::size_t i = 0; i <= corners.size(); ++i) {
    const Point2& a = i == 0 ? start_m : corners[i - 1].vertex_m;
    const Point2& b = i < corners.size() ? corners[i].vertex_m : goal_m;
    const double used_m =
        (i > 0 ? 2 * corners[i - 1].after_m : 0) + (i < corners.size() ? 2 * corners[i].before_m : 0);
    result[i] = used_m + 0.02 - std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  const auto path = path_at(x);
  result[m - 1] = path ? kClearanceMargin_m - least_slack_m(*path) : 1.0;
}

double objective_entry(const std::vector<double>& x, std::vector<double>&, void* data) {
  return static_cast<Problem*>(data)->objective(x);
}

void constraints_entry(unsigned m, double* result, unsigned n, const double* x, double*, void* data) {
  static_cast<const Problem*>(data)->constraints(m, result, std::vector<double>(x, x + n));
}

/// A start: handles as long as the lines allow up to a length, shortened until the path is free.
std::vector<double> first_guess(const Problem& problem, const std::vector<Point2>& line) {
  for (double handle_m = 0.6; handle_m > kShortestHandle_m; handle_m *= 0.75) {
    std::vector<double> x;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const double before_m = std::hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]);
      const double after_m = std::hypot(line[i + 1][0] - line[i][0], line[i + 1][1] - line[i][1]);
      x.insert(x.end(), {line[i][0], line[i][1], std::min(handle_m, 0.24 * before_m),
                         std::min(handle_m, 0.24 * after_m)});
    }
    const auto path = problem.path_at(x);
    if (path && problem.least_slack_m(*path) >= kClearanceMargin_m) return x;
  }
  return {};
}

void optimize(Problem& problem, std::vector<double> x, const RefineOptions& options) {
  nlopt::opt optimizer(nlopt::LN_COBYLA, static_cast<unsigned>(x.size()));
  std::vector<double> lower(x.size()), upper(x.size()), step(x.size(), options.first_step_m);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool handle = i % kPerCorner >= 2;
    lower[i] = handle ? kShortestHandle_m : x[i] - kReach_m;
    upper[i] = handle ? kLongestHandle_m : x[i] + kReach_m;
    x[i] = std::clamp(x[i], lower[i], upper[i]);
  }
  optimizer.set_lower_bounds(lower);
  optimizer.set_upper_bounds(upper);
  optimizer.set_initial_step(step);
  optimizer.set_min_objective(objective_entry, &problem);
  optimizer.add_inequality_mconstraint(constraints_entry, &problem,
                                       std::vector<double>(problem.corner_count + 2, 1e-6));
  optimizer.set_ftol_rel(options.relative_tolerance);
  optimizer.set_xtol_rel(1e-5);
  optimizer.set_maxeval(options.max_evaluations);
  double value = 0;
  try {
    optimizer.optimize(x, value);
  } catch (const nlopt::roundoff_limited&) {
    // The best point seen is kept in the problem.
  }
}

}  // namespace

RefineResult refine_path(const FootprintChecker& checker, const Path& initial,
                         const std::vector<Point2>& polyline_m, const PathCost& cost,
                         const RefineOptions& options) {
  RefineResult result;
  result.path = initial;
  result.cost_before = result.cost = cost(initial);
  result.evaluations = 1;
  result.polyline_m = polyline_m;
  if (polyline_m.size() < 3 || initial.pieces.empty() || !std::isfinite(result.cost) || result.cost <= 0)
    return result;
  Problem problem{checker, cost,        polyline_m.front(),   polyline_m.back(),
                  initial, result.cost, polyline_m.size() - 2};
  const std::vector<double> x = first_guess(problem, polyline_m);
  if (x.empty()) return result;
  optimize(problem, x, options);
  result.evaluations += problem.evaluations;
  if (problem.best >= 1) return result;
  result.path = *problem.path_at(problem.best_x);
  result.cost = problem.best * problem.scale;
  result.improved = true;
  const auto corners = corners_of(problem.best_x);
  for (std::size_t i = 0; i < corners.size(); ++i) result.polyline_m[i + 1] = corners[i].vertex_m;
  return result;
}

}  // namespace joulepath
