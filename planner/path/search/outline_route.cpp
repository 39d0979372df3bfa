#include "planner/path/search/outline_route.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>
#include <unordered_map>

#include "planner/path/search/polyline.hpp"
// Design: docs/decisions/0201-routes-and-floor.md
namespace joulepath {
namespace {

using Cell = OccupancyGrid::CellIndex;
constexpr int kDriveHeadings = 64;
constexpr double kStep_cells = 1.5;     ///< of a line: leaves every cell
constexpr double kArrives_cells = 2.5;  ///< the last line is at most this long
constexpr double kTurn_m = 0.1;         ///< least price of a turn, per radian, in metres of way
constexpr std::size_t kMostStates = 600000;

bool turns_free(const FootprintChecker& checker, const Point2& at, double from_rad, double to_rad) {
  const double angle_rad = wrapped_angle_rad(to_rad - from_rad);
  return !checker.first_collision(PathPiece{TurnInPlace{{at[0], at[1], from_rad}, angle_rad}});
}

/// Hybrid A*: lines of a step along one of the headings and turns to the next one. A state is a cell and a
/// heading, with the exact place at which the cheapest way so far reaches it.
class OutlineSearch {
 public:
  OutlineSearch(const RouteSpace& space, const FreeSpace& floor, const RouteRequest& request)
      : request_(request),
        checker_(space.checker()),
        grid_(floor.grid()),
        start_{request.start.x_m, request.start.y_m},
        goal_{request.goal_x_m, request.goal_y_m},
        to_goal_m_(floor.lengths_to_m(goal_)),
        turn_m_(std::max(kTurn_m, request.cost.per_rad / request.cost.least_rate)) {}

  std::vector<Point2> corners() {
    begin();
    while (!open_.empty() && nodes_.size() < kMostStates) {
      const Entry entry = open_.top();
      open_.pop();
      if (entry.state == kGoal) return way();
      if (entry.cost_m > nodes_.at(entry.state).cost_m) continue;  // outdated
      expand(entry.state);
    }
    return {};
  }

 private:
  using State = std::size_t;
  static constexpr State kGoal = static_cast<State>(-1), kStart = static_cast<State>(-2);
  static constexpr double kBlocked = -1;  ///< as the cost of a state: no way is cheaper
  struct Node {
    Point2 at_m{};
    double slack_m{};
    double cost_m{kNoLimit};
    State from{kStart};
  };
  struct Entry {
    double estimate_m, cost_m;
    State state;
    bool operator>(const Entry& other) const {
      return estimate_m != other.estimate_m ? estimate_m > other.estimate_m : state > other.state;
    }
  };

  double heading_rad(int heading) const {
    return wrapped_angle_rad(grid_.origin.heading_rad + 2 * std::numbers::pi * heading / kDriveHeadings);
  }
  int heading_of(State state) const { return static_cast<int>(state % kDriveHeadings); }
  State state_of(Cell cell, int heading) const {
    return grid_.index_of(cell) * kDriveHeadings + static_cast<State>(heading);
  }

  /// The inscribed disc's way to the goal from a cell about a place.
  double left_m(const Point2& at_m) const {
    const Cell center = grid_.cell_of(at_m[0], at_m[1]);
    double least_m = kNoLimit;
    for (int row = center.row - 1; row <= center.row + 1; ++row)
      for (int column = center.column - 1; column <= center.column + 1; ++column)
        if (grid_.contains({column, row}))
          least_m = std::min(least_m, static_cast<double>(to_goal_m_[grid_.index_of({column, row})]));
    return least_m;
  }

  /// Takes a place with a heading as reached if that is cheaper and `drives(slack_m)` there.
  template <class Drives>
  void reach(const Point2& at_m, int heading, double cost_m, State from, const Drives& drives) {
    const Cell cell = grid_.cell_of(at_m[0], at_m[1]);
    if (!grid_.contains(cell)) return;
    const State state = state_of(cell, heading);
    const auto known = nodes_.find(state);
    if (known != nodes_.end() && cost_m >= known->second.cost_m) return;
    const double slack_m = checker_.slack_m({at_m[0], at_m[1], heading_rad(heading)}), rest_m = left_m(at_m);
    if (slack_m < -FootprintChecker::kTolerance_m || rest_m == kNoLimit) {
      nodes_.try_emplace(state, Node{.cost_m = kBlocked});
      return;
    }
    if (!drives(slack_m)) return;
    nodes_[state] = {at_m, slack_m, cost_m, from};
    open_.push({cost_m + rest_m, cost_m, state});
  }

  void begin() {
    for (int heading = 0; heading < kDriveHeadings; ++heading) {
      const double to_rad = heading_rad(heading), from_rad = request_.start.heading_rad;
      const bool free = request_.start_heading_free;
      const double turn_rad = free ? 0.0 : std::abs(wrapped_angle_rad(to_rad - from_rad));
      reach(start_, heading, turn_m_ * turn_rad, kStart,
            [&](double) { return free || turns_free(checker_, start_, from_rad, to_rad); });
    }
  }

  void expand(State state) {
    const Node here = nodes_.at(state);
    const int heading = heading_of(state);
    const double from_rad = heading_rad(heading), step_m = kStep_cells * grid_.resolution_m;
    arrive(state, here, from_rad);
    const Point2 ahead{here.at_m[0] + step_m * std::cos(from_rad),
                       here.at_m[1] + step_m * std::sin(from_rad)};
    reach(ahead, heading, here.cost_m + step_m, state, [&](double slack_m) {
      return here.slack_m + slack_m >= step_m ||
             checker_.line_free(here.at_m[0], here.at_m[1], ahead[0], ahead[1]);
    });
    constexpr double kTurn_rad = 2 * std::numbers::pi / kDriveHeadings;
    for (const int turn : {1, kDriveHeadings - 1}) {
      const int to = (heading + turn) % kDriveHeadings;
      reach(here.at_m, to, here.cost_m + turn_m_ * kTurn_rad, state, [&](double slack_m) {
        return here.slack_m + slack_m >= kTurn_rad * checker_.circumscribed_radius_m() ||
               turns_free(checker_, here.at_m, from_rad, heading_rad(to));
      });
    }
  }

  /// The line from a state to the goal, after a turn towards it.
  void arrive(State state, const Node& here, double from_rad) {
    const double length_m = distance_m(here.at_m, goal_);
    if (length_m > kArrives_cells * grid_.resolution_m) return;
    const double line_rad = length_m > kSamePlace_m ? bearing_rad(here.at_m, goal_) : from_rad;
    if (!turns_free(checker_, here.at_m, from_rad, line_rad) ||
        !checker_.line_free(here.at_m[0], here.at_m[1], goal_[0], goal_[1]))
      return;
    double cost_m = here.cost_m + length_m + turn_m_ * std::abs(wrapped_angle_rad(line_rad - from_rad));
    if (request_.goal_heading_rad) {
      if (!turns_free(checker_, goal_, line_rad, *request_.goal_heading_rad)) return;
      cost_m += turn_m_ * std::abs(wrapped_angle_rad(*request_.goal_heading_rad - line_rad));
    }
    Node& goal = nodes_[kGoal];
    if (cost_m >= goal.cost_m) return;
    goal = {goal_, 0, cost_m, state};
    open_.push({cost_m, cost_m, kGoal});
  }

  /// The places at which the way turns.
  std::vector<Point2> way() const {
    std::vector<Point2> line{goal_};
    State state = nodes_.at(kGoal).from;
    for (int heading = -1; state != kStart; state = nodes_.at(state).from) {
      const Point2 at_m = nodes_.at(state).at_m;
      if (heading_of(state) != heading && distance_m(at_m, line.back()) > kSamePlace_m) line.push_back(at_m);
      heading = heading_of(state);
    }
    if (distance_m(line.back(), start_) > kSamePlace_m) line.push_back(start_);
    std::reverse(line.begin(), line.end());
    return line;
  }

  const RouteRequest& request_;
  const FootprintChecker& checker_;
  const OccupancyGrid& grid_;
  Point2 start_, goal_;
  std::vector<float> to_goal_m_;
  double turn_m_;
  std::unordered_map<State, Node> nodes_{};
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_{};
};

/// Leaves out corners as long as the outline can drive the rest.
std::vector<Point2> without_corners(std::vector<Point2> line, const RouteSpace& space,
                                    const RouteRequest& request) {
  for (std::size_t i = 1; i + 1 < line.size();) {
    std::vector<Point2> shorter = line;
    shorter.erase(shorter.begin() + static_cast<std::ptrdiff_t>(i));
    if (outline_drives(space, request, shorter))
      line = std::move(shorter);
    else
      ++i;
  }
  return line;
}

}  // namespace

bool outline_drives(const RouteSpace& space, const RouteRequest& request,
                    const std::vector<Point2>& polyline_m) {
  const FootprintChecker& checker = space.checker();
  std::optional<double> heading_rad;
  if (!request.start_heading_free) heading_rad = request.start.heading_rad;
  for (std::size_t i = 0; i + 1 < polyline_m.size(); ++i) {
    const Point2 &a = polyline_m[i], &b = polyline_m[i + 1];
    const double line_rad = bearing_rad(a, b);
    if (!checker.line_free(a[0], a[1], b[0], b[1])) return false;
    if (heading_rad && !turns_free(checker, a, *heading_rad, line_rad)) return false;
    heading_rad = line_rad;
  }
  return !heading_rad || !request.goal_heading_rad ||
         turns_free(checker, polyline_m.back(), *heading_rad, *request.goal_heading_rad);
}

std::vector<Point2> outline_route(const RouteSpace& space, const FreeSpace& floor,
                                  const RouteRequest& request) {
  std::vector<Point2> corners = OutlineSearch(space, floor, request).corners();
  if (corners.size() < 3) return corners;
  const FootprintChecker& checker = space.checker();
  const LineFree free = [&checker](const Point2& a, const Point2& b) {
    return checker.line_free(a[0], a[1], b[0], b[1]);
  };
  std::vector<Point2> taut = pull_taut(corners, free, request.cost);
  return outline_drives(space, request, taut) ? taut : without_corners(corners, space, request);
}

}  // namespace joulepath
