#pragma once

#include <random>
#include <string>
#include <vector>

#include "planner/mission/mission.hpp"

namespace joulepath::bench {

/// A floor that missions are drawn on, prepared once.
struct Floor {
  std::string name{};
  MissionWorld world{};
  RouteSpace space;
  ObstacleField::Extent box{};  ///< that stations are drawn from
};

/// Nav2's warehouse and depot and a generated warehouse of 60 x 40 m; maps that are not there are left out.
[[nodiscard]] std::vector<Floor> floors(const Robot& robot);

/// A free place on the floor from which `other` can be reached.
[[nodiscard]] Station random_place(const Floor& floor, std::mt19937& random, const Station* other);

/// Three picks of 1 to 4 kg at random places and a drop where the robot began.
struct DrawnMission {
  MissionRequest base{};  ///< stations and start
  std::vector<VisitRequest> visit{};

  /// The visits as legs in an order, payload growing from pick to pick.
  [[nodiscard]] std::vector<LegRequest> legs_in(const std::vector<std::size_t>& order) const;
  [[nodiscard]] MissionRequest with(const std::vector<LegRequest>& legs) const;
};

[[nodiscard]] DrawnMission random_mission(const Floor& floor, std::mt19937& random);

}  // namespace joulepath::bench
