#pragma once

#include <optional>
#include <string>

#include "benchmarks/missions/draw.hpp"

namespace joulepath::ways {

/// A drive from a pose to a place on a floor; the goal may name a heading.
struct Problem {
  std::string floor{};
  Pose start{};
  Point2 goal_m{};
  std::optional<double> goal_heading_rad{};
  double payload_kg{};

  double reach_m() const;
};

/// A floor with the robot of this benchmark.
using World = bench::Floor;

/// `empty` (30 x 30 m) or a map of scenarios/maps.
[[nodiscard]] World make_world(const std::string& name);

/// Problem `index` of a floor: 1 to 10 m apart, log-uniform; every second goal names a heading. It depends on
/// its arguments only.
[[nodiscard]] Problem random_problem(const World& world, unsigned seed, unsigned index);

[[nodiscard]] MissionRequest mission_of(const Problem& problem);

/// Energy (standby included) of the planner's path, and whether it turns in place; infinite: no path.
struct Answer {
  double energy_J{};
  bool turns{};
};
[[nodiscard]] Answer planned(const World& world, const Problem& problem);

/// Energy of a path, driven by the planner's profile solver, time free.
[[nodiscard]] double driven_J(const World& world, const Problem& problem, const Path& path);

/// Turn, line, turn: the motion of a plain controller; infinite where the line is not free.
[[nodiscard]] double plain_J(const World& world, const Problem& problem);

}  // namespace joulepath::ways
