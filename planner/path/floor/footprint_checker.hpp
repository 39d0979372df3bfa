#pragma once

#include <array>
#include <optional>
#include <vector>

#include "model/robot.hpp"
#include "planner/path/floor/obstacle_field.hpp"
#include "planner/path/geometry/path.hpp"

namespace joulepath {

/// A place where a footprint is closer to an obstacle than the requested clearance.
struct Collision {
  double s{};           ///< path coordinate in the piece (0 for a pose)
  Pose pose{};          ///< of the robot
  double short_by_m{};  ///< missing clearance; beyond the clearance it is the depth of the obstacle
                        ///< into the outline (for polygons: corners and centers of cells)
  ObstacleField::Nearest obstacle{};  ///< its place deepest in the outline, or nearest to it
};

/// Checks a robot's outline, kept a clearance away from every obstacle. The field must outlive it.
class FootprintChecker {
 public:
  FootprintChecker(const ObstacleField& field, const Footprint& footprint, double clearance_m);

  /// Distance from the outline to the nearest obstacle minus the clearance; exact near zero and a lower
  /// bound where it is larger than a few cells.
  [[nodiscard]] double slack_m(const Pose& pose) const;
  /// The same, exact up to a tenth of a metre and never more than that: continuous, for derivatives.
  [[nodiscard]] double near_slack_m(const Pose& pose) const;
  [[nodiscard]] bool free(const Pose& pose) const { return slack_m(pose) >= -kTolerance_m; }

  [[nodiscard]] std::optional<Collision> pose_collision(const Pose& pose) const;
  /// The collision of a pose whose slack is known.
  [[nodiscard]] Collision collision_at(double s, const Pose& pose, double slack) const;
  /// How far a point of the outline moves at most per unit of a piece's path coordinate.
  [[nodiscard]] double reach_per_s(const PathPiece& piece) const;
  /// The first place along a curve, or in the sweep of a turn, that is not free. A step is so short that no
  /// point of the outline can reach an obstacle within it, but at least 2 mm (measured at the outline).
  [[nodiscard]] std::optional<Collision> first_collision(const PathPiece& piece) const;
  [[nodiscard]] std::optional<Collision> first_collision(const Path& path) const;
  [[nodiscard]] bool segment_free(const CurveSegment& segment) const;
  /// Straight driving between two points, with the heading along the line.
  [[nodiscard]] bool line_free(double x0_m, double y0_m, double x1_m, double y1_m) const;

  /// The same outline and obstacles with another clearance.
  [[nodiscard]] FootprintChecker with_clearance(double clearance_m) const {
    FootprintChecker other = *this;
    other.clearance_m_ = clearance_m;
    return other;
  }

  bool is_disc() const { return polygon_m_.empty(); }
  double clearance_m() const { return clearance_m_; }
  double circumscribed_radius_m() const { return outer_m_; }
  double inscribed_radius_m() const { return inner_m_; }
  const ObstacleField& field() const { return *field_; }

  static constexpr double kTolerance_m = 1e-9;

 private:
  /// The pose at which an outline is compared with the floor; without the heading where it does not matter.
  template <class AnyCurve>
  Pose pose_on(const AnyCurve& curve, double s_m) const {
    if (!is_disc()) return curve.at(s_m).pose;
    const auto position_m = curve.position_m(s_m);
    return {position_m[0], position_m[1], 0};
  }
  Pose pose_on(const PathPiece& piece, double s) const;
  double polygon_slack_m(const Pose& pose) const;
  Collision polygon_collision(double s, const Pose& pose, double slack) const;
  template <class Place>
  std::optional<Collision> first_on(double length, double reach_per_s, const Place& place) const;

  const ObstacleField* field_{};
  std::vector<std::array<double, 2>> polygon_m_{};  ///< empty: a disc
  double clearance_m_{};
  double outer_m_{};  ///< from the axle midpoint to the farthest point of the outline
  double inner_m_{};  ///< to the nearest
};

/// Whether a disc may move along a line: the search's check.
[[nodiscard]] bool disc_line_free(const ObstacleField& field, double x0_m, double y0_m, double x1_m,
                                  double y1_m, double radius_m, double shortest_step_m = 0.005);

}  // namespace joulepath
