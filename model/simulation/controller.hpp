#pragma once

#include <optional>

#include "model/operating_point.hpp"

namespace joulepath {

/// Gains of the wheels' speed loops. Absent gains are designed for a closed loop with `bandwidth_per_s` on
/// the wheel's straight-line inertia.
struct ControllerSettings {
  double period_s{0.01};
  double bandwidth_per_s{12.0};
  std::optional<double> proportional_V_s_rad{};
  std::optional<double> integral_V_rad{};
  bool feed_forward{true};  ///< voltage of the nominal model, effects of the robot file included
};

/// One PI loop per wheel on its speed, added to the voltage of the nominal model.
///
///   V = V_model(v, omega, v', omega') + k_p e + k_i (integral of e dt),   e = q'_ref - q'
///
/// The integral stops while the driver saturates, and decays while the robot stands as commanded.
class WheelController {
 public:
  WheelController(const ControllerSettings& settings, const Robot& robot);

  /// Voltages (V) for the next period; `limit_V` is what the driver can put out.
  [[nodiscard]] Sided<double> command_V(const BodyMotion<double>& reference, const Site& site,
                                        const Sided<double>& wheel_speed_rad_s, const Sided<double>& limit_V);

  /// Resets the integral, as after the bridges were open.
  void release() { integral_V_ = {}; }

  const ControllerSettings& settings() const { return settings_; }

 private:
  ControllerSettings settings_;
  Plant nominal_;
  Sided<double> proportional_{};
  Sided<double> integral_{};
  Sided<double> integral_V_{};
};

}  // namespace joulepath
