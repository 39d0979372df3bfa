#pragma once

#include <array>
#include <optional>
#include <vector>

#include "planner/joint/joint_starts.hpp"
#include "planner/path/floor/free_space.hpp"

namespace joulepath {

/// How a leg is driven along its route: in one direction, straight back out of a stop without room to turn
/// and then forward, or forward and then straight back into such a stop.
enum class RouteDrive { forward, reverse, out_in_reverse, in_in_reverse };
inline constexpr std::array kRouteDrives{RouteDrive::forward, RouteDrive::reverse, RouteDrive::out_in_reverse,
                                         RouteDrive::in_in_reverse};

/// Length of the straight line from a pose to the first place where the robot has room to turn, forward
/// (direction 1) or backward (-1); absent where it has room at the pose, or none along 5 m.
[[nodiscard]] std::optional<double> way_to_room_m(const FreeSpace& room, const Pose& from, int direction);

/// A leg from a pose along its route to a goal. `first`, `last`: senses of the arcs at its ends, as in
/// joint::along_route(). Absent where the drive needs a stop without room and there is none.
[[nodiscard]] std::optional<joint::Sketch> sketch_along(RouteDrive drive, const Pose& from,
                                                        const joint::LegGoal& goal,
                                                        const std::vector<Point2>& route_m, int first,
                                                        int last, double half_track_m, const FreeSpace& room);

}  // namespace joulepath
