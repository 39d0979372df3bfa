#include "benchmarks/ways/brute_force.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "planner/ways/way_score.hpp"

namespace joulepath::ways {
namespace {

constexpr std::size_t kMostSpans = 4;
constexpr std::size_t kDrivenWell = 4;  ///< ends of descents that are evaluated on a fine grid
/// First steps of a descent's two methods: from a sample, and from a known spline.
constexpr struct Steps { double cma{}, simplex{}; } kFar{0.2, 0.03}, kNear[] = {{0.02, 0.03}, {0.005, 0.005}};
constexpr double kLongestReaches = 10, kLongestMore_m = 30;  ///< of a spline worth a look
constexpr double kSlackStep_m = 0.03;
constexpr double kNoCurve_J = 1e7, kInTheWay_J = 1e6, kNoProfile_J = 1e5;

/// The least slack along a path: steps of at least 3 cm, so long that the slack on them can hardly be below
/// the least one so far. In a turn, the outline of a polygon moves farther than its center.
double least_slack_m(const FootprintChecker& checker, const Path& path) {
  double least_m = kNoLimit;
  for (const PathPiece& piece : path.pieces) {
    const double length = piece_length(piece), trust = checker.is_disc() ? 1.0 : 0.4;
    for (double s = 0;;) {
      const double here_m = checker.slack_m(piece_point(piece, s).pose);
      least_m = std::min(least_m, here_m);
      if (s >= length) break;
      s = std::min(length, s + std::max(kSlackStep_m, trust * (here_m - least_m)));
    }
  }
  return least_m;
}

/// Variables: logarithms of the handles, a free goal heading, coordinates of the knots in units of the reach.
class Search {
 public:
  Search(const World& world, const Problem& problem, std::mt19937& random, const SearchSize& size)
      : world_(world),
        problem_(problem),
        random_(random),
        size_(size),
        plant_(make_plant(world.world.robot)),
        mission_(mission_of(problem)) {}

  BestSpline run(const std::vector<FreeSpline>& known) {
    for (const FreeSpline& spline : known)
      for (const Steps& first : kNear) descend({.x = variables_of(spline)}, first);
    for (std::size_t spans = 1; spans <= kMostSpans; ++spans) try_spans(spans);
    std::stable_sort(found_.begin(), found_.end(), cheaper);
    BestSpline best{.energy_J = kNoLimit, .evaluations = evaluations_};
    for (std::size_t k = 0; k < std::min(kDrivenWell, found_.size()); ++k) {
      const FreeSpline spline = spline_at(found_[k].x);
      const std::optional<Path> path = free_spline_path(spline);
      if (!path || world_.space.checker().first_collision(*path)) continue;
      const double energy_J = driven_J(world_, problem_, *path);
      if (energy_J < best.energy_J) best.energy_J = energy_J, best.spline = spline;
    }
    return best;
  }

 private:
  struct Point {
    std::vector<double> x{};
    double value{};
  };
  static bool cheaper(const Point& a, const Point& b) { return a.value < b.value; }

  double uniform(double from, double to) {
    return from + (to - from) * (static_cast<double>(random_()) / 4294967296.0);
  }

  void descend(Point point, const Steps& first) {
    const Objective objective = [this](const std::vector<double>& x) { return cost(x); };
    minimize_by_cma(point.x, first.cma, size_.evaluations, random_, objective);
    point.value = minimize_by_simplex(point.x, first.simplex, size_.refinements, objective);
    if (point.value < kNoProfile_J) found_.push_back(std::move(point));
  }

  void try_spans(std::size_t spans) {
    std::vector<Point> points;
    for (int k = 0; k < size_.samples; ++k) {
      Point point{.x = sample(spans)};
      point.value = cost(point.x);
      points.push_back(std::move(point));
    }
    std::stable_sort(points.begin(), points.end(), cheaper);
    points.resize(std::min(points.size(), static_cast<std::size_t>(size_.descents)));
    for (const Point& point : points) descend(point, kFar);
  }

  std::vector<double> sample(std::size_t spans) {
    const double dx = problem_.goal_m[0] - problem_.start.x_m, dy = problem_.goal_m[1] - problem_.start.y_m;
    std::vector<double> x{uniform(-4, 0), uniform(-4, 0)};
    if (!problem_.goal_heading_rad) x.push_back(std::atan2(dy, dx) + uniform(-2.5, 2.5));
    std::vector<double> shares;
    for (std::size_t k = 1; k < spans; ++k) shares.push_back(uniform(-0.1, 1.1));
    std::sort(shares.begin(), shares.end());
    const double spread = uniform(0.05, 0.5);
    for (const double share : shares) {
      x.push_back(share * dx / problem_.reach_m() + uniform(-spread, spread));
      x.push_back(share * dy / problem_.reach_m() + uniform(-spread, spread));
    }
    return x;
  }

  FreeSpline spline_at(const std::vector<double>& x) const {
    const double reach_m = problem_.reach_m();
    FreeSpline spline{.points_m = {{problem_.start.x_m, problem_.start.y_m}},
                      .start_heading_rad = problem_.start.heading_rad,
                      .start_handle_m = reach_m * std::exp(x[0]),
                      .goal_handle_m = reach_m * std::exp(x[1])};
    std::size_t i = 2;
    spline.goal_heading_rad = problem_.goal_heading_rad ? *problem_.goal_heading_rad : x[i++];
    for (; i + 1 < x.size(); i += 2)
      spline.points_m.push_back(
          {problem_.start.x_m + reach_m * x[i], problem_.start.y_m + reach_m * x[i + 1]});
    spline.points_m.push_back(problem_.goal_m);
    return spline;
  }

  /// The inverse of spline_at.
  std::vector<double> variables_of(const FreeSpline& spline) const {
    const double reach_m = problem_.reach_m();
    std::vector<double> x{std::log(spline.start_handle_m / reach_m),
                          std::log(spline.goal_handle_m / reach_m)};
    if (!problem_.goal_heading_rad) x.push_back(spline.goal_heading_rad);
    for (std::size_t k = 1; k + 1 < spline.points_m.size(); ++k) {
      x.push_back((spline.points_m[k][0] - problem_.start.x_m) / reach_m);
      x.push_back((spline.points_m[k][1] - problem_.start.y_m) / reach_m);
    }
    return x;
  }

  double cost(const std::vector<double>& x) {
    ++evaluations_;
    const std::optional<Path> path = free_spline_path(spline_at(x));
    if (!path) return kNoCurve_J;
    // Where no spline is free, nothing else keeps the handles from growing to thousands of kilometers.
    if (path->distance_m() > kLongestReaches * problem_.reach_m() + kLongestMore_m) return kNoCurve_J;
    const double slack_m = least_slack_m(world_.space.checker(), *path);
    if (slack_m < 0) return kInTheWay_J * (1 - slack_m);
    const PathScore score =
        score_path(*path, mission_.legs[0], 0, {mission_, world_.world, nullptr, plant_, options_, 0.0});
    return score.drivable ? score.energy_J : kNoProfile_J;
  }

  const World& world_;
  const Problem& problem_;
  std::mt19937& random_;
  const SearchSize& size_;
  Plant plant_;
  MissionRequest mission_;
  PlanOptions options_{};
  int evaluations_{};
  std::vector<Point> found_{};
};

}  // namespace

BestSpline brute_force(const World& world, const Problem& problem, std::mt19937& random,
                       const SearchSize& size, const std::vector<FreeSpline>& known) {
  return Search(world, problem, random, size).run(known);
}

std::string spline_text(const FreeSpline& spline) {
  char number[40];
  std::string text;
  const auto add = [&](double value) {
    std::snprintf(number, sizeof number, text.empty() ? "%.9g" : " %.9g", value);
    text += number;
  };
  for (const double value : {spline.start_handle_m, spline.goal_handle_m, spline.goal_heading_rad})
    add(value);
  for (std::size_t k = 1; k + 1 < spline.points_m.size(); ++k)
    for (const double coordinate_m : spline.points_m[k]) add(coordinate_m);
  return text;
}

FreeSpline spline_from(const std::string& text, const Problem& problem) {
  FreeSpline spline{.points_m = {{problem.start.x_m, problem.start.y_m}},
                    .start_heading_rad = problem.start.heading_rad};
  std::istringstream numbers(text);
  numbers >> spline.start_handle_m >> spline.goal_handle_m >> spline.goal_heading_rad;
  for (Point2 knot_m{}; numbers >> knot_m[0] >> knot_m[1];) spline.points_m.push_back(knot_m);
  spline.points_m.push_back(problem.goal_m);
  return spline;
}

}  // namespace joulepath::ways
