#include "planner/bound/heading_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/bound/heading_program.hpp"

namespace joulepath {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kMostMultipliers = 12;
constexpr double kReach = 2.0;       ///< of the multipliers searched, in rates of the middle
constexpr double kLeastArea = 1e-5;  ///< of the region of multipliers, relative

using Polygon = std::vector<Point2>;

double dot(const Point2& a, const Point2& b) { return a[0] * b[0] + a[1] * b[1]; }
Point2 minus(const Point2& a, const Point2& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// The part of a convex polygon on the side of `normal`.
Polygon cut(const Polygon& polygon, const Point2& through, const Point2& normal) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point2 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
    const double f = dot(normal, minus(from, through)), t = dot(normal, minus(to, through));
    if (f >= 0) kept.push_back(from);
    if ((f > 0 && t < 0) || (f < 0 && t > 0))
      kept.push_back({std::lerp(from[0], to[0], f / (f - t)), std::lerp(from[1], to[1], f / (f - t))});
  }
  return kept;
}

std::optional<Point2> centroid(const Polygon& polygon, double least_area) {
  double area = 0;
  Point2 sum{0, 0};
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const Point2 a = minus(polygon[k], polygon[0]), b = minus(polygon[k + 1], polygon[0]);
    const double cross = a[0] * b[1] - a[1] * b[0];
    area += cross;
    for (std::size_t j : {0u, 1u}) sum[j] += cross * (a[j] + b[j]) / 3;
  }
  if (!(area > least_area)) return std::nullopt;
  return Point2{polygon[0][0] + sum[0] / area, polygon[0][1] + sum[1] / area};
}

/// Search for the multiplier of the place: the bound is concave in it, so that each one that is tried drops a
/// half of those left.
class MultiplierSearch {
 public:
  MultiplierSearch(HeadingProgram& program, const Point2& offset_m, double most)
      : program_(program), offset_m_(offset_m), least_area_(kLeastArea * most * most) {
    const double way_m = std::hypot(offset_m[0], offset_m[1]);
    const Point2 ahead = way_m > 0 ? Point2{offset_m[0] / way_m, offset_m[1] / way_m} : Point2{1, 0};
    for (const auto& [along, left] : {Point2{-1, -1}, Point2{1, -1}, Point2{1, 1}, Point2{-1, 1}})
      region_.push_back(
          {most * (along * ahead[0] - left * ahead[1]), most * (along * ahead[1] + left * ahead[0])});
  }

  /// The best bound for the goal's heading, or for any; `lambda`: the first multiplier.
  double find(std::optional<double> turned_rad, Point2 lambda, double enough_J) {
    Polygon left = region_;
    double best_J = -kNoLimit;
    for (int k = 0; k < kMostMultipliers && program_.run(lambda); ++k) {
      const double turned = turned_rad ? *turned_rad : program_.cheapest_rad();
      const double cost_J = turned_rad ? program_.cost_J(turned) : program_.least_cost_J();
      best_J = std::max(best_J, dot(lambda, offset_m_) + cost_J);
      if (best_J >= enough_J) break;
      left = cut(left, lambda, minus(offset_m_, program_.reached_m(turned)));
      const std::optional<Point2> next = centroid(left, least_area_);
      if (!next) break;
      lambda = *next;
    }
    return best_J;
  }

 private:
  HeadingProgram& program_;
  Point2 offset_m_{};
  double least_area_{};
  Polygon region_{};
};

}  // namespace

double heading_bound(const RateTable& table, const HeadingEnds& ends, double least_m, double most_m,
                     double enough_J) {
  const bool backward = !ends.start_rad;
  if (!table.bounded || (backward && !ends.goal_rad)) return 0;
  const double anchor_rad = backward ? *ends.goal_rad : *ends.start_rad;
  HeadingProgram program(heading_stages(table, least_m, most_m, backward), anchor_rad, table.reverse);
  const double rate = std::max(table.middle.free(), 0.0),
               way_m = std::hypot(ends.offset_m[0], ends.offset_m[1]);
  const double share = way_m > 0 ? rate / way_m : 0.0;
  const Point2 first{share * ends.offset_m[0], share * ends.offset_m[1]};
  MultiplierSearch search(program, ends.offset_m, kReach * rate);
  if (backward || !ends.goal_rad) return search.find(std::nullopt, first, enough_J);
  const double turned_rad = std::remainder(*ends.goal_rad - anchor_rad, kTurn);
  const double one_J = search.find(turned_rad, first, enough_J);
  return std::min(one_J, search.find(turned_rad + kTurn, first, one_J));
}

}  // namespace joulepath
