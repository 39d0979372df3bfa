#include "planner/bound/geodesic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"

// Method: [LozanoPerezWesley1979], [Hart1968]
namespace joulepath {
namespace {

constexpr int kBendsPerCorner = 5;              ///< on the quarter circle around it, both ends included
constexpr double kStep = std::numbers::pi / 8;  ///< between them
constexpr double kGiven_m = 0.005;              ///< given away for the resolution of the planner's checks
constexpr double kSupport = 1e-6;               ///< for rounding
constexpr std::size_t kMostBends = 20000;

/// A place where a shortest way can bend, with the direction away from the obstacle.
struct Bend {
  Point2 at_m{}, outward{};
  double way_m{std::numeric_limits<double>::infinity()};  ///< from the start
  bool done{};
};

class VisibilityGraph {
 public:
  VisibilityGraph(const ObstacleField& field, double radius_m, const Point2& start_m, const Point2& goal_m,
                  double at_most_m)
      : field_(field),
        line_radius_m_(radius_m * std::cos(0.5 * kStep) - kSupport),
        goal_m_(goal_m),
        at_most_m_(at_most_m) {
    bends_.push_back({.at_m = start_m, .way_m = 0});
    for (const Pose& corner : field.convex_corners())
      for (int k = 0; k < kBendsPerCorner; ++k) {
        const double angle = corner.heading_rad + kStep * (k - 0.5 * (kBendsPerCorner - 1));
        const Point2 outward{std::cos(angle), std::sin(angle)};
        const Point2 at_m{corner.x_m + radius_m * outward[0], corner.y_m + radius_m * outward[1]};
        if (distance_m(start_m, at_m) + distance_m(at_m, goal_m) <= at_most_m &&
            field.disc_free(at_m[0], at_m[1], line_radius_m_))
          bends_.push_back({at_m, outward});
      }
    bends_.push_back({.at_m = goal_m});
  }

  /// Not a number if there are too many bends; infinite if there is no way.
  double shortest_m() {
    if (bends_.size() > kMostBends) return std::nan("");
    for (;;) {
      Bend* next = nullptr;
      double least_m = std::numeric_limits<double>::infinity();
      for (Bend& bend : bends_)
        if (const double f = bend.way_m + distance_m(bend.at_m, goal_m_); !bend.done && f < least_m)
          next = &bend, least_m = f;
      if (!next || next == &bends_.back()) return bends_.back().way_m;
      next->done = true;
      for (Bend& bend : bends_) reach(*next, bend);
    }
  }

 private:
  /// Whether a way in a direction can bend here: the obstacle lies on one side of its line.
  static bool supports(const Bend& bend, const Point2& direction) {
    return std::abs(bend.outward[0] * direction[0] + bend.outward[1] * direction[1]) <=
           std::sin(0.5 * kStep) + kSupport;
  }

  void reach(const Bend& from, Bend& to) const {
    const double d = distance_m(from.at_m, to.at_m), way_m = from.way_m + d;
    if (to.done || way_m >= to.way_m || way_m + distance_m(to.at_m, goal_m_) > at_most_m_) return;
    const Point2 direction{(to.at_m[0] - from.at_m[0]) / d, (to.at_m[1] - from.at_m[1]) / d};
    if (d > 0 && (!supports(from, direction) || !supports(to, direction))) return;
    if (disc_line_free(field_, from.at_m[0], from.at_m[1], to.at_m[0], to.at_m[1], line_radius_m_))
      to.way_m = way_m;
  }

  const ObstacleField& field_;
  double line_radius_m_{};
  Point2 goal_m_{};
  double at_most_m_{};
  std::vector<Bend> bends_{};
};

}  // namespace

Geodesic shortest_way(const ObstacleField& field, double radius_m, const Point2& start_m,
                      const Point2& goal_m, double at_most_m) {
  const double straight_m = distance_m(start_m, goal_m), radius = std::max(0.0, radius_m - kGiven_m);
  if (disc_line_free(field, start_m[0], start_m[1], goal_m[0], goal_m[1], radius)) return {straight_m, false};
  const double way_m = VisibilityGraph(field, radius, start_m, goal_m, at_most_m + kGiven_m).shortest_m();
  if (!std::isfinite(way_m)) return {straight_m, false};
  return {std::max(straight_m, way_m), way_m > straight_m + kGiven_m};
}

}  // namespace joulepath
