#pragma once

#include <optional>
#include <vector>

#include "model/plant.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/mission_request.hpp"

// Design: docs/decisions/0210-ways.md
namespace joulepath {

/// Parts of a floor where driving is dearer than beside them: cells of a speed mask that hold the robot back,
/// and patches of rolling resistance. A part that is closed to a search gives ways around it.
class DearFloor {
 public:
  DearFloor(const MissionWorld& world, const Plant& plant, const RouteSpace* space);

  using Parts = std::vector<int>;  ///< in ascending order
  /// The parts that hold one of these places.
  [[nodiscard]] Parts at(const std::vector<Point2>& places_m) const;
  /// The parts that paths lead through, or closely along.
  [[nodiscard]] Parts along(const std::vector<Path>& paths) const;
  /// The floor with parts closed to the point between the wheels.
  [[nodiscard]] const RouteSpace& without(const Parts& parts) const;

 private:
  std::optional<int> part(double x_m, double y_m) const;
  void label(const std::vector<std::uint8_t>& dear);

  const MissionWorld& world_;
  const RouteSpace* space_;
  std::vector<int> part_{};        ///< of cells; -1: none
  std::vector<float> inside_m_{};  ///< distance of cells to the edge of their part
  std::vector<float> depth_m_{};   ///< of parts: the largest such distance
};

}  // namespace joulepath
