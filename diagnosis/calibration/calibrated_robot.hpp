#pragma once

#include "diagnosis/calibration/wheel_equations.hpp"

namespace joulepath::calibration {

/// Robot file values in the fit's own parameters.
struct DerivedInertia {
  double wheel_axle_kg_m2{};   ///< I_w + I_s = J - m r^2/2
  double chassis_yaw_kg_m2{};  ///< I_c, from D
};
[[nodiscard]] DerivedInertia derived_inertia(const Robot& robot, const FitValues& values);

/// Standard deviation of both that comes from the uncertainty of masses and lengths in the robot file.
[[nodiscard]] DerivedInertia geometric_deviation(const Robot& robot, const FitValues& values);

/// The robot with fitted values in place of its own. Inertias that would be
/// negative, or that rest on a value that was not fitted, are left.
[[nodiscard]] Robot robot_with(const Robot& robot, const FitValues& values);

}  // namespace joulepath::calibration
