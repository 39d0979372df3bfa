#pragma once

#include <string>
#include <vector>

#include "benchmarks/ways/poses.hpp"

namespace joulepath::ways {

/// Missions of one kind on floors of their own, drawn from a seed.
struct JointCase {
  std::string name{};
  const World* world{};
  MissionRequest mission{};
};

/// Kinds of cases: `open` (0.7 to 10 m, every second goal with a heading), `corner` (at most 2 m, at least
/// 135 deg of turning), `docking` (into or out of a slot of 0.8 to 1 m), `obstacles` (a leg among pallets),
/// `stops` (two legs through a doorway or around racks, the stop's heading free), `dead_end` (out of or into a
/// dead end of 0.9 to 1.1 m where the robot has no room to turn), `behind` (1 to 10 m behind, heading kept),
/// `docking_back` (docking where the robot looks out of the slot into which it drives, or into the one that it
/// leaves).
[[nodiscard]] const std::vector<std::string>& joint_kinds();

/// The floors of all kinds, prepared once.
class JointFloors {
 public:
  JointFloors();
  const World& of(const std::string& kind) const;

 private:
  std::vector<World> worlds_{};
};

/// Case `index` of a kind: it depends on its arguments only.
[[nodiscard]] JointCase joint_case(const JointFloors& floors, const std::string& kind, unsigned seed,
                                   unsigned index);

}  // namespace joulepath::ways
