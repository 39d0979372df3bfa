#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/path/floor/footprint_checker.hpp"
#include "planner/path/floor/free_space.hpp"
#include "planner/path/search/search.hpp"
#include "planner/path/shape/blended_path.hpp"

namespace joulepath {

class RouteCache;

/// A floor for one robot: obstacles, outline, and connected regions. Built once per map, keep-out mask,
/// footprint and clearance; then read-only and safe to share between threads. Contains a cache of searched
/// routes.
class RouteSpace {
 public:
  ~RouteSpace();
  RouteSpace(RouteSpace&&) noexcept;
  RouteSpace& operator=(RouteSpace&&) noexcept;
  RouteSpace(const OccupancyGrid& map, const OccupancyGrid* keepout, const Footprint& footprint,
             double clearance_m);

  const ObstacleField& field() const { return *field_; }
  const FootprintChecker& checker() const { return checker_; }
  /// Free space of a disc about the axle midpoint that contains the whole outline: free at any heading.
  const FreeSpace& any_heading() const { return any_heading_; }
  /// Free space of the largest disc inside the outline: where it is blocked, every heading is blocked. The
  /// same for round robots.
  const FreeSpace& some_heading() const { return some_heading_ ? *some_heading_ : any_heading_; }
  /// As some_heading() on cells of 1.25 cm, where the floor is not too large: they miss no corridor that is
  /// so much wider than the disc. Built at the first call.
  const FreeSpace& narrow() const;
  /// The floor on which to search a way between two places: the first of any_heading(), some_heading() and
  /// narrow() that connects them and whose disc fits at both; the last one where none does.
  const FreeSpace& floor_between(const Point2& a_m, const Point2& b_m) const;
  /// A point inside of every island (homotopy.hpp) of any_heading().
  const std::vector<Point2>& islands_m() const { return islands_m_; }
  RouteCache& routes() const { return *routes_; }
  /// The floor for the same robot on another map, from `build`; called once for each map.
  const RouteSpace& on(const OccupancyGrid& map, const std::function<RouteSpace()>& build) const;

 private:
  std::unique_ptr<ObstacleField> field_{};  ///< on the heap, because the checker keeps a pointer to it
  FootprintChecker checker_;
  FreeSpace any_heading_;
  std::optional<FreeSpace> some_heading_{};
  struct Narrow;
  std::unique_ptr<Narrow> narrow_{};
  std::vector<Point2> islands_m_{};
  std::unique_ptr<RouteCache> routes_;
  struct Others;
  std::unique_ptr<Others> others_{};
};

struct RouteRequest {
  Pose start{};
  double goal_x_m{};
  double goal_y_m{};
  std::optional<double> goal_heading_rad{};  ///< absent: any
  bool start_heading_free{};  ///< start.heading_rad has no meaning: the robot begins along the path
  CornerPolicy corners{};
  /// Leave the start (reach the goal) along its heading on an arc instead of turning in place, where there is
  /// room for a blend of this policy; not for CornerPolicy::Kind::stop_turn_go.
  bool blend_start{};
  bool blend_goal{};
  TravelCost cost{};
  std::uint64_t seed{1};
};

enum class RouteStatus {
  found,
  start_blocked,   ///< the robot does not fit at the start
  goal_blocked,    ///< the robot does not fit at the goal
  no_connection,   ///< start and goal lie in parts of the floor that are not connected
  no_room_to_turn  ///< the way is wide enough to drive, but not for a necessary turn in place
};

/// Why there is no route, and where.
struct RouteVerdict {
  RouteStatus status{RouteStatus::found};
  double x_m{};  ///< place of the obstruction
  double y_m{};
  double short_by_m{};  ///< missing clearance, where that applies
  bool keepout{};       ///< the obstruction belongs to the keep-out mask, not to the map
  std::optional<Point2>
      nearest_reachable_m{};  ///< nearest place to stand at, or to reach, where that applies
  std::string message{};
};

struct RouteResult {
  RouteVerdict verdict{};
  Path path{};  ///< empty unless found; also empty for a goal at the start
  std::vector<CornerReport> corners{};
  std::vector<Point2> polyline_m{};  ///< pulled taut, before its corners were rounded
  double polyline_cost{};
  unsigned search_iterations{};
  std::string searched_by{};  ///< "line of sight", or the source that found it

  bool found() const { return verdict.status == RouteStatus::found; }
};

/// The verdict where the robot cannot stand at the request's start or goal; absent when it can.
[[nodiscard]] std::optional<RouteVerdict> blocked_ends(const RouteSpace& space, const RouteRequest& request);

/// The verdict where no way exists: an end is blocked, or the ends are not connected; absent otherwise.
[[nodiscard]] std::optional<RouteVerdict> no_way(const RouteSpace& space, const RouteRequest& request);

/// True if the goal is the start of the request.
[[nodiscard]] bool is_there_already(const RouteRequest& request);

/// Finds a way from a pose to a place and shapes it into a path with continuous curvature. The footprint
/// keeps its clearance along the whole path, which is checked before it is returned. Turns in place are added
/// at the ends where headings differ. Deterministic in the request.
[[nodiscard]] RouteResult plan_route(const RouteSpace& space, const RouteRequest& request);

/// As plan_route(), with a given polyline (from an earlier result or a route graph) instead of a search.
[[nodiscard]] RouteResult shape_route(const RouteSpace& space, const RouteRequest& request,
                                      const std::vector<Point2>& polyline_m);

}  // namespace joulepath
