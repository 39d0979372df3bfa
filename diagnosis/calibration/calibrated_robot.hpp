#pragma once

#include "diagnosis/calibration/wheel_equations.hpp"

namespace joulepath::calibration {

/// Inertias of the robot file, derived from the fitted parameters.
struct DerivedInertia {
  double wheel_axle_kg_m2{};   ///< I_w + I_s = J - m r^2/2
  double chassis_yaw_kg_m2{};  ///< I_c, from D
};
[[nodiscard]] DerivedInertia derived_inertia(const Robot& robot, const FitValues& values);

/// What one sigma of a mass or length in the robot file changes both inertias by.
struct InheritedError {
  std::string key{};
  DerivedInertia change{};
};

/// Of the keys that the file's `uncertainty:` states.
[[nodiscard]] std::vector<InheritedError> inherited_errors(const Robot& robot, const FitValues& values);

/// The robot with the fitted values. Inertias that would be negative, or that depend on a parameter that was
/// not fitted, keep the value of the robot file.
[[nodiscard]] Robot robot_with(const Robot& robot, const FitValues& values);

}  // namespace joulepath::calibration
