#pragma once

#include "planner/path/search/route_pool.hpp"
#include "planner/values/answer_fields.hpp"
#include "planner/ways/leg_path.hpp"
#include "planner/ways/way_score.hpp"

// Fields of the cached questions and answers about ways (planner/cache).
namespace joulepath {

template <class Archive>
void each_field(Archive& archive, PathAlternative& value) {
  auto& [name, energy_J, duration_s, distance_m, chosen] = value;
  archive(name, energy_J, duration_s, distance_m, chosen);
}

template <class Archive>
void each_field(Archive& archive, WayImprovement& value) {
  auto& [step, energy_J, duration_s, cost_J] = value;
  archive(step, energy_J, duration_s, cost_J);
}

template <class Archive>
void each_field(Archive& archive, LegPath& value) {
  auto& [path, source, infeasibility, alternatives, improvements] = value;
  archive(path, source, infeasibility, alternatives, improvements);
}

template <class Archive>
void each_field(Archive& archive, PooledRoute& value) {
  auto& [polyline_m, wide_m, cost, searched_by, search_iterations, outline_fits] = value;
  archive(polyline_m, wide_m, cost, searched_by, search_iterations, outline_fits);
}

template <class Archive>
void each_field(Archive& archive, PathScore& value) {
  auto& [energy_J, duration_s, drivable] = value;
  archive(energy_J, duration_s, drivable);
}

template <class Archive>
void each_field(Archive& archive, LegStart& value) {
  auto& [pose, heading_free] = value;
  archive(pose, heading_free);
}

template <class Archive>
void each_field(Archive& archive, PayloadAlongLeg& value) {
  auto& [from_kg, to_kg] = value;
  archive(from_kg, to_kg);
}

template <class Archive>
void each_field(Archive& archive, WaySteps& value) {
  auto& [corners, routes, stops, refinement, mean_ramps] = value;
  archive(corners, routes, stops, refinement, mean_ramps);
}

/// Everything on which the way of a leg between two stations depends, except its neighbors.
struct LegQuestion {
  PayloadAlongLeg payload{};
  double start_speed_m_s{}, end_speed_m_s{};
  std::optional<double> yaw_rate_rad_s{};
  double price_W{};
  double goal_x_m{}, goal_y_m{};
  std::optional<double> goal_heading_rad{};
  std::vector<SpeedCap> zones{};
  LegDirection direction{};
};

template <class Archive>
void each_field(Archive& archive, LegQuestion& value) {
  auto& [payload, start_speed_m_s, end_speed_m_s, yaw_rate_rad_s, price_W, goal_x_m, goal_y_m,
         goal_heading_rad, zones, direction] = value;
  archive(payload, start_speed_m_s, end_speed_m_s, yaw_rate_rad_s, price_W, goal_x_m, goal_y_m,
          goal_heading_rad, zones, direction);
}

}  // namespace joulepath
