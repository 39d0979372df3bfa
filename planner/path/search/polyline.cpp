#include "planner/path/search/polyline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

// Method: [GeraertsOvermars2007]
namespace joulepath {
namespace {

constexpr double kFinestStep_m = 0.5;
constexpr double kMostVertices = 90;
constexpr int kRounds = 4;
constexpr double kSettled = 1e-4;
constexpr int kPasses = 6;
constexpr int kBisections = 9;
constexpr double kMergeWithin_m = 1.0;
constexpr double kMergeExtra_m = 0.05;
constexpr double kRounding = 1e-12;

Point2 between(const Point2& a, const Point2& b, double t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])};
}

std::vector<Point2> subdivided(const std::vector<Point2>& polyline_m) {
  const double step_m = std::max(kFinestStep_m, polyline_cost(polyline_m, {}) / kMostVertices);
  std::vector<Point2> out{polyline_m.front()};
  for (std::size_t i = 0; i + 1 < polyline_m.size(); ++i) {
    const double length_m = distance_m(polyline_m[i], polyline_m[i + 1]);
    const int parts = std::max(1, static_cast<int>(std::ceil(length_m / step_m)));
    for (int k = 1; k <= parts; ++k)
      out.push_back(between(polyline_m[i], polyline_m[i + 1], static_cast<double>(k) / parts));
  }
  return out;
}

/// Skips vertices in line of sight as long as the steps stay short: a route over cells has too many vertices.
std::vector<Point2> thinned(const std::vector<Point2>& p, const LineFree& free) {
  std::vector<Point2> out{p.front()};
  for (std::size_t i = 1; i < p.size(); ++i) {
    const bool skip =
        i + 1 < p.size() && distance_m(out.back(), p[i + 1]) < kFinestStep_m && free(out.back(), p[i + 1]);
    if (!skip) out.push_back(p[i]);
  }
  return out;
}

/// The cheapest way over a subset of the vertices, in their order. For each vertex, predecessors are tried in
/// the order of cost until one is in line of sight.
std::vector<Point2> shortcut(const std::vector<Point2>& p, const LineFree& free, const TravelCost& cost) {
  std::vector<double> cost_to(p.size(), 0.0);
  std::vector<std::size_t> from(p.size(), 0);
  for (std::size_t j = 1; j < p.size(); ++j) {
    std::vector<std::pair<double, std::size_t>> candidates;
    for (std::size_t i = 0; i < j; ++i)
      candidates.emplace_back(cost_to[i] + polyline_cost({p[i], p[j]}, cost), i);
    std::sort(candidates.begin(), candidates.end());
    cost_to[j] = cost_to[j - 1] + polyline_cost({p[j - 1], p[j]}, cost);
    from[j] = j - 1;
    for (const auto& [sum, i] : candidates) {
      if (sum >= cost_to[j] || !free(p[i], p[j])) continue;
      cost_to[j] = sum, from[j] = i;
      break;
    }
  }
  std::vector<Point2> out{p.back()};
  for (std::size_t j = p.size() - 1; j > 0; j = from[j]) out.push_back(p[from[j]]);
  std::reverse(out.begin(), out.end());
  return out;
}

/// Moves vertex i towards the line of its neighbors; true if it moved.
bool pull_vertex(std::vector<Point2>& p, std::size_t i, const LineFree& free, const TravelCost& cost) {
  const Point2 a = p[i - 1], v = p[i], b = p[i + 1];
  const double dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
  const double t =
      length2 > 0 ? std::clamp(((v[0] - a[0]) * dx + (v[1] - a[1]) * dy) / length2, 0.0, 1.0) : 0;
  const Point2 target = between(a, b, t);
  const double cost_before = polyline_cost({a, v, b}, cost);
  double pulled = 0, stuck = 1;
  const auto acceptable = [&](double share) {
    const Point2 moved = between(v, target, share);
    return polyline_cost({a, moved, b}, cost) < cost_before && free(a, moved) && free(moved, b);
  };
  if (acceptable(1)) {
    pulled = 1;
  } else {
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (pulled + stuck);
      (acceptable(middle) ? pulled : stuck) = middle;
    }
  }
  p[i] = between(v, target, pulled);
  return pulled * distance_m(v, target) > 1e-3;
}

std::vector<Point2> without_needless(const std::vector<Point2>& p, const LineFree& free,
                                     const TravelCost& cost) {
  std::vector<Point2> out{p.front()};
  for (std::size_t i = 1; i + 1 < p.size(); ++i) {
    if (distance_m(out.back(), p[i]) < kSamePlace_m) continue;
    const double through = polyline_cost({out.back(), p[i], p[i + 1]}, cost);
    const bool needless = polyline_cost({out.back(), p[i + 1]}, cost) <= (1 + kRounding) * through &&
                          free(out.back(), p[i + 1]);
    if (!needless) out.push_back(p[i]);
  }
  out.push_back(p.back());
  return out;
}

/// The point where the lines a-b and d-c meet beyond b and beyond c; absent where there is none.
std::optional<Point2> meeting_point(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const double ux = b[0] - a[0], uy = b[1] - a[1], wx = c[0] - d[0], wy = c[1] - d[1];
  const double denominator = ux * wy - uy * wx;
  if (std::abs(denominator) < 1e-9) return std::nullopt;
  const double t = ((d[0] - a[0]) * wy - (d[1] - a[1]) * wx) / denominator;
  const double r = ((d[0] - a[0]) * uy - (d[1] - a[1]) * ux) / denominator;
  if (t < 1 || r < 1) return std::nullopt;
  return Point2{a[0] + t * ux, a[1] + t * uy};
}

}  // namespace

std::vector<Point2> merged_corners(std::vector<Point2> p, const LineFree& free, double within_m,
                                   double extra_m) {
  for (std::size_t i = 1; i + 2 < p.size();) {
    const Point2 a = p[i - 1], b = p[i], c = p[i + 1], d = p[i + 2];
    const auto corner = meeting_point(a, b, c, d);
    const bool merge = corner && distance_m(b, c) < within_m &&
                       polyline_length_m({a, *corner, d}) < polyline_length_m({a, b, c, d}) + extra_m &&
                       free(a, *corner) && free(*corner, d);
    if (!merge) {
      ++i;
      continue;
    }
    p[i] = *corner;
    p.erase(p.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    if (i > 1) --i;
  }
  return p;
}

double polyline_length_m(const std::vector<Point2>& polyline_m) { return polyline_cost(polyline_m, {}); }

std::vector<Point2> pull_taut(std::vector<Point2> polyline_m, const LineFree& free, const TravelCost& cost) {
  if (polyline_m.size() < 3) return polyline_m;
  std::vector<Point2> p = thinned(polyline_m, free);
  for (int round = 0; round < kRounds && p.size() > 2; ++round) {
    const double cost_before = polyline_cost(p, cost);
    p = shortcut(subdivided(p), free, cost);
    for (int pass = 0; pass < kPasses && p.size() > 2; ++pass) {
      bool moved = false;
      for (std::size_t i = 1; i + 1 < p.size(); ++i) moved = pull_vertex(p, i, free, cost) || moved;
      p = without_needless(p, free, cost);
      if (!moved) break;
    }
    if (polyline_cost(p, cost) > (1 - kSettled) * cost_before) break;
  }
  return merged_corners(p, free, kMergeWithin_m, kMergeExtra_m);
}

}  // namespace joulepath
