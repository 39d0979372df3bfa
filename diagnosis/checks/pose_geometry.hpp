#pragma once

#include <string>
#include <vector>

#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/foreign_constant.hpp"

namespace joulepath {

/// What the pose of a localization says of the wheels, without any force or current: radius and half track
/// over those of the robot file. Where it tells none surely, and within calibration errors, exactly 1.
struct PoseGeometry {
  double radius{1.0};
  double half_track{1.0};
  double turning{1.0};  ///< of the yaw that the wheels tell
};

/// Runs differ in ground, speed and load: only a factor that all of them share is of the geometry. Creep
/// under force, drag and the pose's delay add to the way, by what the speed gained and by the time.
[[nodiscard]] PoseGeometry geometry_by_pose(const Dataset& dataset, const std::vector<RunSignals>& runs);

/// The file's robot with the geometry that the pose tells.
[[nodiscard]] Robot with_geometry(Robot robot, const PoseGeometry& geometry);

/// What to write into the robot file, as questions.
[[nodiscard]] std::vector<std::string> geometry_notes(const Robot& robot, const PoseGeometry& geometry);

/// Radius and half track beyond what effects and calibration errors change.
[[nodiscard]] std::vector<ForeignConstant> foreign_geometry(const Robot& robot, const PoseGeometry& geometry);

}  // namespace joulepath
