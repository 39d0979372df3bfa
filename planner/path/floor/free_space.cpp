#include "planner/path/floor/free_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "planner/path/floor/footprint_checker.hpp"

namespace joulepath {
namespace {

using Cell = OccupancyGrid::CellIndex;
constexpr double kStep_m = 0.005, kFineStep_m = 1e-4;
constexpr double kSampling_m = 2e-5;  ///< more than a line can lack between two steps
constexpr double kTouching_m = 0.05;  ///< about an end with less to spare than that
constexpr std::array<Cell, 8> kNeighbors{
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
constexpr auto kNoParent = std::numeric_limits<std::uint32_t>::max();

struct OpenCell {
  double estimate;
  std::size_t cell;
  bool operator>(const OpenCell& other) const {
    return estimate != other.estimate ? estimate > other.estimate : cell > other.cell;
  }
};

/// Costs in cells, and the cell before each one, of the shortest ways from a cell over the eight neighbors of
/// usable cells: A* to a goal, or to all cells.
struct CellWays {
  std::vector<float> cost{};
  std::vector<std::uint32_t> parent{};
};

template <class Usable>
CellWays shortest_ways(const OccupancyGrid& grid, Cell start, const std::optional<Cell>& goal,
                       const Usable& usable) {
  constexpr double kDiagonal = 1.4142135623730951;
  const auto heuristic = [&](Cell cell) {
    if (!goal) return 0.0;
    const double dx = std::abs(cell.column - goal->column), dy = std::abs(cell.row - goal->row);
    return std::max(dx, dy) + (kDiagonal - 1) * std::min(dx, dy);
  };
  CellWays ways{.cost = std::vector<float>(grid.cell_count(), std::numeric_limits<float>::infinity()),
                .parent = std::vector<std::uint32_t>(grid.cell_count(), kNoParent)};
  std::priority_queue<OpenCell, std::vector<OpenCell>, std::greater<>> open;
  ways.cost[grid.index_of(start)] = 0;
  open.push({heuristic(start), grid.index_of(start)});
  while (!open.empty()) {
    const OpenCell entry = open.top();
    open.pop();
    if (goal && entry.cell == grid.index_of(*goal)) break;
    const Cell cell = grid.cell_at(entry.cell);
    const double here = ways.cost[entry.cell];
    if (entry.estimate > here + heuristic(cell) + 1e-3) continue;  // outdated
    for (const Cell& step : kNeighbors) {
      const Cell next{cell.column + step.column, cell.row + step.row};
      if (!grid.contains(next) || !usable(next)) continue;
      const std::size_t at = grid.index_of(next);
      const double next_cost = here + (step.column != 0 && step.row != 0 ? kDiagonal : 1.0);
      if (next_cost >= static_cast<double>(ways.cost[at]) - 1e-4) continue;
      ways.cost[at] = static_cast<float>(next_cost);
      ways.parent[at] = static_cast<std::uint32_t>(entry.cell);
      open.push({next_cost + heuristic(next), at});
    }
  }
  return ways;
}

OccupancyGrid divided(const OccupancyGrid& map, double largest_cell_m) {
  OccupancyGrid grid{map.width, map.height, map.resolution_m, map.origin, {}, map.file};
  const double wanted = std::ceil(map.resolution_m / largest_cell_m - 1e-9),
               most = std::sqrt(FreeSpace::kMostCells / static_cast<double>(map.cell_count()));
  const int parts = std::max(1, static_cast<int>(std::min(wanted, most)));
  grid.width *= parts, grid.height *= parts, grid.resolution_m /= parts;
  return grid;
}

}  // namespace

FreeSpace::FreeSpace(const ObstacleField& field, double radius_m, double largest_cell_m)
    : field_(&field),
      grid_(divided(field.map(), largest_cell_m)),
      radius_m_(radius_m),
      cosine_(std::cos(grid_.origin.heading_rad)),
      sine_(std::sin(grid_.origin.heading_rad)) {
  constexpr std::int32_t kUnlabelled = -2, kBlocked = -1;
  const std::size_t count = grid_.cell_count();
  component_.assign(count, kBlocked);
  rings_.assign(count, 0);
  const double clear_m = radius_m + kSpare_m + 0.5 * std::sqrt(2.0) * grid_.resolution_m;
  for (int row = 0; row < grid_.height; ++row)
    for (int column = 0; column < grid_.width; ++column) {
      const auto center = grid_.center_of({column, row});
      if (!field.disc_free(center[0], center[1], radius_m)) continue;
      component_[index({column, row})] = kUnlabelled;
      rings_[index({column, row})] = field.disc_free(center[0], center[1], clear_m) ? 1 : 0;
    }
  count_rings();
  std::int32_t label = 0;
  std::vector<Cell> open;
  for (int row = 0; row < grid_.height; ++row)
    for (int column = 0; column < grid_.width; ++column) {
      if (component_[index({column, row})] != kUnlabelled) continue;
      component_[index({column, row})] = label;
      open.push_back({column, row});
      while (!open.empty()) {
        const Cell cell = open.back();
        open.pop_back();
        for (const Cell& step : kNeighbors) {
          const Cell next{cell.column + step.column, cell.row + step.row};
          if (!grid_.contains(next) || component_[index(next)] != kUnlabelled) continue;
          component_[index(next)] = label;
          open.push_back(next);
        }
      }
      ++label;
    }
}

/// Rings from those of the neighbors: one pass down the rows and one up. Outside of the grid nothing is
/// clear.
void FreeSpace::count_rings() {
  constexpr int kMost = std::numeric_limits<std::uint8_t>::max();
  const auto pass = [&](Cell cell, int back) {
    std::uint8_t& here = rings_[index(cell)];
    if (here == 0) return;
    int least = kMost - 1;
    for (const Cell& step : {Cell{-1, -1}, Cell{0, -1}, Cell{1, -1}, Cell{-1, 0}}) {
      const Cell next{cell.column + back * step.column, cell.row + back * step.row};
      least = std::min<int>(least, grid_.contains(next) ? rings_[index(next)] : 0);
    }
    here = static_cast<std::uint8_t>(back > 0 ? least + 1 : std::min<int>(here, least + 1));
  };
  for (int row = 0; row < grid_.height; ++row)
    for (int column = 0; column < grid_.width; ++column) pass({column, row}, 1);
  for (int row = grid_.height; row-- > 0;)
    for (int column = grid_.width; column-- > 0;) pass({column, row}, -1);
}

std::optional<Cell> FreeSpace::free_cell_near(const Point2& point_m) const {
  const Cell center = grid_.cell_of(point_m[0], point_m[1]);
  std::optional<Cell> best;
  double best_squared = std::numeric_limits<double>::infinity();
  for (int row = center.row - 1; row <= center.row + 1; ++row)
    for (int column = center.column - 1; column <= center.column + 1; ++column) {
      const Cell cell{column, row};
      if (!grid_.contains(cell) || component_[index(cell)] < 0) continue;
      const auto c = grid_.center_of(cell);
      const double squared = std::pow(c[0] - point_m[0], 2) + std::pow(c[1] - point_m[1], 2);
      if (squared < best_squared) best_squared = squared, best = cell;
    }
  return best;
}

std::optional<int> FreeSpace::component(const Point2& point_m) const {
  const auto cell = free_cell_near(point_m);
  if (!cell) return std::nullopt;
  return component_[index(*cell)];
}

bool FreeSpace::connected(const Point2& a_m, const Point2& b_m) const {
  const auto a = component(a_m), b = component(b_m);
  return a && b && *a == *b;
}

std::optional<Point2> FreeSpace::nearest_reachable(const Point2& start_m, const Point2& goal_m) const {
  const auto label = component(start_m);
  return label ? nearest_free(goal_m, label, [](const Point2&) { return true; }) : std::nullopt;
}

std::optional<Point2> FreeSpace::nearest_free(const Point2& point_m, std::optional<int> component,
                                              const std::function<bool(const Point2&)>& fits) const {
  double best_squared = std::numeric_limits<double>::infinity();
  std::optional<Point2> best;
  for (int row = 0; row < grid_.height; ++row)
    for (int column = 0; column < grid_.width; ++column) {
      const std::int32_t label = component_[index({column, row})];
      if (label < 0 || label != component.value_or(label)) continue;
      const Point2 c = grid_.center_of({column, row});
      const double squared = std::pow(c[0] - point_m[0], 2) + std::pow(c[1] - point_m[1], 2);
      if (squared < best_squared && fits(c)) best_squared = squared, best = c;
    }
  return best;
}

std::vector<Point2> FreeSpace::cell_route(const Point2& start_m, const Point2& goal_m, Cells cells) const {
  const auto start = free_cell_near(start_m), goal = free_cell_near(goal_m);
  if (!start || !goal || component_[index(*start)] != component_[index(*goal)]) return {};
  const double near_cells = kNearEnds_m / grid_.resolution_m;
  const auto usable = [&](Cell cell) {
    if (component_[index(cell)] < 0) return false;
    if (cells == Cells::free || rings_[index(cell)] != 0) return true;
    for (const Cell& end : {*start, *goal})
      if (std::hypot(cell.column - end.column, cell.row - end.row) <= near_cells) return true;
    return false;
  };
  const std::vector<std::uint32_t> parent = shortest_ways(grid_, *start, goal, usable).parent;
  if (index(*goal) != index(*start) && parent[index(*goal)] == kNoParent) return {};
  std::vector<Point2> route{goal_m};
  for (std::size_t i = index(*goal); i != index(*start); i = parent[i])
    route.push_back(grid_.center_of(grid_.cell_at(i)));
  route.push_back(start_m);
  std::reverse(route.begin(), route.end());
  return route;
}

std::vector<float> FreeSpace::lengths_to_m(const Point2& goal_m) const {
  const auto goal = free_cell_near(goal_m);
  if (!goal) return std::vector<float>(grid_.cell_count(), std::numeric_limits<float>::infinity());
  std::vector<float> lengths =
      shortest_ways(grid_, *goal, std::nullopt, [&](Cell cell) { return component_[index(cell)] >= 0; }).cost;
  for (float& length : lengths) length *= static_cast<float>(grid_.resolution_m);
  return lengths;
}

DiscLineCheck::DiscLineCheck(const FreeSpace& space, const Point2& start_m, const Point2& goal_m,
                             FreeSpace::Cells cells, double spare_m)
    : space_(&space), start_m_(start_m), goal_m_(goal_m), cells_(cells) {
  // The spare distance, but not more than the ends have.
  for (const Point2& end : {start_m, goal_m})
    spare_m = std::min(spare_m, space.field().distance_m(end[0], end[1]) - space.radius_m());
  exact_radius_m_ = space.radius_m() + std::max(0.0, spare_m);
}

bool DiscLineCheck::near_ends(const Point2& p) const {
  for (const Point2& end : {start_m_, goal_m_})
    if (distance_m(p, end) <= FreeSpace::kNearEnds_m) return true;
  return false;
}

bool DiscLineCheck::point_free(const Point2& p) const {
  if (space_->clear(p[0], p[1])) return true;
  if (cells_ == FreeSpace::Cells::clear && !near_ends(p)) return false;
  return space_->field().disc_free(p[0], p[1], exact_radius_m_);
}

bool DiscLineCheck::operator()(const Point2& a, const Point2& b) const {
  const OccupancyGrid& grid = space_->field().map();
  bool all_clear = true;
  const bool possible = space_->for_unclear_cells_on_line(a, b, [&](Cell cell) {
    all_clear = false;
    return cells_ == FreeSpace::Cells::free || near_ends(grid.center_of(cell));
  });
  if (!possible || all_clear) return possible;
  const auto free = [&](const Point2& from, const Point2& to, double radius_m, double step_m) {
    return disc_line_free(space_->field(), from[0], from[1], to[0], to[1], radius_m, step_m);
  };
  if (!free(a, b, exact_radius_m_, kStep_m)) return false;
  // Where an end touches, a line has nothing to spare for what it lacks between two looks.
  const double sampled_m = space_->radius_m() + kSampling_m, length_m = distance_m(a, b);
  if (exact_radius_m_ >= sampled_m) return true;
  if (is_end(a) && is_end(b)) return free(a, b, exact_radius_m_, kFineStep_m);
  const auto at = [&](double s_m) -> Point2 {
    return {a[0] + s_m / length_m * (b[0] - a[0]), a[1] + s_m / length_m * (b[1] - a[1])};
  };
  const double begin_m = is_end(a) ? std::min(kTouching_m, length_m) : 0.0,
               end_m = is_end(b) ? std::max(length_m - kTouching_m, 0.0) : length_m;
  return (begin_m == 0 || free(a, at(begin_m), exact_radius_m_, kFineStep_m)) &&
         (end_m == length_m || free(at(end_m), b, exact_radius_m_, kFineStep_m)) &&
         (begin_m >= end_m || free(at(begin_m), at(end_m), sampled_m, kStep_m));
}

}  // namespace joulepath
