#include "planner/path/search/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "model/limits.hpp"

namespace joulepath {
namespace {

/// Plain square root: std::hypot is ten times slower, and its guard against overflow is not needed for
/// metres.
double plain_distance_m(const Point2& a, const Point2& b) {
  const double dx = b[0] - a[0], dy = b[1] - a[1];
  return std::sqrt(dx * dx + dy * dy);
}

/// A place itself where it is clear or nothing about it is, else the one with most room within `reach` cells.
Point2 roomiest_about(const Point2& at, int reach, const FreeSpace& space) {
  const OccupancyGrid& grid = space.grid();
  const auto center = grid.cell_of(at[0], at[1]);
  if (space.rings(center) != 0) return at;
  Point2 best = at;
  int most = 0;
  double nearest_m = kNoLimit;
  for (int row = center.row - reach; row <= center.row + reach; ++row)
    for (int column = center.column - reach; column <= center.column + reach; ++column) {
      const int rings = space.rings({column, row});
      if (rings == 0 || rings < most) continue;
      const Point2 there = grid.center_of({column, row});
      const double off_m = plain_distance_m(at, there);
      if (rings == most && off_m >= nearest_m) continue;
      best = there, most = rings, nearest_m = off_m;
    }
  return best;
}

}  // namespace

Lattice::Lattice(const FreeSpace& space, double spacing_m)
    : spacing_m_(spacing_m), extent_(space.field().extent_m()) {
  columns_ = static_cast<int>((extent_.x_max_m - extent_.x_min_m) / spacing_m) + 1;
  rows_ = static_cast<int>((extent_.y_max_m - extent_.y_min_m) / spacing_m) + 1;
  price_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 1.0);
  places_.reserve(price_.size());
  const int reach = static_cast<int>(std::lround(0.5 * spacing_m / space.grid().resolution_m));
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      places_.push_back(roomiest_about(
          {extent_.x_min_m + column * spacing_m, extent_.y_min_m + row * spacing_m}, reach, space));
}

Lattice::Node Lattice::nearest(const Point2& p) const {
  return {std::clamp(static_cast<int>(std::lround((p[0] - extent_.x_min_m) / spacing_m_)), 0, columns_ - 1),
          std::clamp(static_cast<int>(std::lround((p[1] - extent_.y_min_m) / spacing_m_)), 0, rows_ - 1)};
}

void Lattice::make_dear(const std::vector<Point2>& line, double corridor_m, double except_near_ends_m,
                        double extra_price) {
  std::vector<std::uint8_t> raised(price_.size(), 0);
  const int reach = static_cast<int>(corridor_m / spacing_m_);
  const auto raise_about = [&](const Point2& p) {
    if (plain_distance_m(p, line.front()) < except_near_ends_m ||
        plain_distance_m(p, line.back()) < except_near_ends_m)
      return;
    const Node center = nearest(p);
    for (int row = std::max(0, center.row - reach); row <= std::min(rows_ - 1, center.row + reach); ++row)
      for (int column = std::max(0, center.column - reach);
           column <= std::min(columns_ - 1, center.column + reach); ++column)
        if (std::hypot(row - center.row, column - center.column) <= reach) raised[index({column, row})] = 1;
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const int steps = static_cast<int>(plain_distance_m(line[i], line[i + 1]) / spacing_m_) + 1;
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      raise_about(
          {line[i][0] + t * (line[i + 1][0] - line[i][0]), line[i][1] + t * (line[i + 1][1] - line[i][1])});
    }
  }
  for (std::size_t i = 0; i < price_.size(); ++i)
    if (raised[i] != 0) price_[i] += extra_price;
}

template <class Visit>
void Lattice::for_nodes_around(Node center, const Visit& visit) const {
  for (int row = center.row - 1; row <= center.row + 1; ++row)
    for (int column = center.column - 1; column <= center.column + 1; ++column)
      if (row >= 0 && column >= 0 && row < rows_ && column < columns_) visit(Node{column, row});
}

std::vector<Point2> Lattice::route(const Point2& start, const Point2& goal, const DiscLineCheck& free) const {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<double> cost(price_.size(), kNoLimit);
  std::vector<std::size_t> parent(price_.size(), kNone);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for_nodes_around(nearest(start), [&](Node node) {
    if (!free(start, place(node))) return;
    cost[index(node)] = plain_distance_m(start, place(node));
    open.push({cost[index(node)] + plain_distance_m(place(node), goal), index(node)});
  });
  std::vector<std::uint8_t> settled(price_.size(), 0);
  double best = kNoLimit;
  std::size_t last = kNone;
  while (!open.empty() && open.top().first < best) {
    const std::size_t here = open.top().second;
    open.pop();
    if (settled[here] != 0) continue;
    settled[here] = 1;
    const Point2 from = place(node(here));
    const double to_goal_m = plain_distance_m(from, goal);
    if (to_goal_m < 1.5 * spacing_m_ && cost[here] + to_goal_m < best && free(from, goal)) {
      best = cost[here] + to_goal_m;
      last = here;
    }
    for_nodes_around(node(here), [&](Node next) {
      const std::size_t to = index(next);
      const double sum = cost[here] + plain_distance_m(from, place(next)) * 0.5 * (price_[here] + price_[to]);
      if (settled[to] != 0 || sum >= cost[to] || !free(from, place(next))) return;
      cost[to] = sum;
      parent[to] = here;
      open.push({sum + plain_distance_m(place(next), goal), to});
    });
  }
  if (last == kNone) return {};
  std::vector<Point2> route{goal};
  for (std::size_t i = last; i != kNone; i = parent[i]) route.push_back(place(node(i)));
  route.push_back(start);
  std::reverse(route.begin(), route.end());
  return route;
}

}  // namespace joulepath
