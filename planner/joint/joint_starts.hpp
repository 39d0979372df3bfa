#pragma once

#include <vector>

#include "planner/joint/joint_problem.hpp"
#include "planner/path/geometry/path.hpp"

namespace joulepath::joint {

/// A rough path of one leg, as pieces of linear direction.
struct Sketch {
  struct Part {
    double from_rad{}, to_rad{}, length_m{};  ///< phi and tau
    int sign{1};
    bool rests_after{};
    std::optional<Point2> through_m{};   ///< place at its end, where it is known
    std::optional<double> turned_rad{};  ///< from the leg's begin to its end, where it is known
    bool turns_in_place() const;
  };
  std::vector<Part> parts{};

  double turn_rad(double half_track_m) const;
  /// Length plus what its turning takes, to sort starts.
  double effort_m() const;
};

/// One leg of a program: from where it begins to its stop.
struct LegGoal {
  Point2 at_m{};
  std::optional<double> heading_rad{};
};

/// The goal of the robot turned by half a turn.
[[nodiscard]] LegGoal turned(LegGoal goal);

/// Arc, line, arc between a pose and a goal, in each combination of senses of turning and for the radii.
[[nodiscard]] std::vector<Sketch> words(const Pose& start, const LegGoal& goal, double half_track_m,
                                        const std::vector<double>& radii_m);

/// The sketch of the robot turned by half a turn, driven in reverse.
[[nodiscard]] Sketch reversed(Sketch sketch);

/// Continues a sketch after a rest, where the direction may jump.
void append(Sketch& sketch, const Sketch& next);

/// A straight line, and the pose at its end, in the robot's frame: forward where `along_m` is positive.
[[nodiscard]] Sketch straight(double along_m);
[[nodiscard]] Pose moved(Pose pose, double along_m);

/// A turn in place.
[[nodiscard]] Sketch turn(double turn_rad, double half_track_m);

/// The words of a drive in reverse, and those with one cusp: a straight line of one of the lengths at one
/// end, backward or forward, the rest the other way.
[[nodiscard]] std::vector<Sketch> reverse_words(const Pose& start, const LegGoal& goal, double half_track_m,
                                                const std::vector<double>& radii_m);
[[nodiscard]] std::vector<Sketch> cusp_words(const Pose& start, const LegGoal& goal, double half_track_m,
                                             const std::vector<double>& radii_m,
                                             const std::vector<double>& straight_m);

/// Arc, line, and a bend and a line for each corner of a route; a last arc, to a heading where one is asked.
/// `first`, `last`: senses of these arcs, +1 to the left, -1 to the right, 0 the shorter way round.
[[nodiscard]] Sketch along_route(const Pose& start, const std::vector<Point2>& route_m,
                                 const std::optional<double>& heading_rad, int first, int last,
                                 double half_track_m);

/// The same with turns in place instead of arcs at the ends. `first`, `last`: their senses, 0: an arc, the
/// shorter way round.
[[nodiscard]] Sketch along_route_turning(const Pose& start, const std::vector<Point2>& route_m,
                                         const std::optional<double>& heading_rad, int first, int last,
                                         double half_track_m);

enum class Turns { as_arcs, in_place };

/// A path in about `count` pieces: knots where its direction changes; turns in place become tight arcs, or
/// remain.
[[nodiscard]] Sketch along_path(const Path& path, double half_track_m, std::size_t count, Turns turns);

/// The start of a program of legs from one rough path each. Sets everything but the laws.
[[nodiscard]] Start assemble(const std::vector<Sketch>& legs, const std::vector<LegGoal>& goals,
                             const Pose& start, double half_track_m, std::size_t segments);

}  // namespace joulepath::joint
