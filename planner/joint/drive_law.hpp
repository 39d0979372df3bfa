#pragma once

#include <vector>

#include "model/limits.hpp"
#include "model/plant.hpp"

// Design: docs/decisions/0212-joint-path-and-speed.md
namespace joulepath::joint {

/// A quantity of a wheel as a polynomial of the body's motion, with S the sign of the wheel's speed:
///
///   constant + sign S + speed v + yaw_rate w + yaw_rate_squared w^2 + speed_by_yaw_rate v w
///     + acceleration v' + yaw_acceleration w'
struct WheelForm {
  double constant{}, sign{}, speed{}, yaw_rate{}, yaw_rate_squared{}, speed_by_yaw_rate{}, acceleration{},
      yaw_acceleration{};
};

/// A motor's current i, and its voltage  resistance i + emf + emf_sign S + emf_speed v + emf_yaw_rate w.
struct WheelLaw {
  WheelForm current_A{};
  double resistance{}, emf{}, emf_sign{}, emf_speed{}, emf_yaw_rate{};
};

/// |form| <= most, of one wheel: its motor's current or voltage, its force on the floor, its acceleration.
struct WheelLimit {
  Side side{};
  WheelForm form{};
  double most{};
};

/// Sum of share x electrical power of a motor <= most_W: the limits of a motor and of the battery.
struct PowerLimit {
  Sided<double> share{};
  double most_W{};
};

/// What driving a leg costs, and its limits, for the joint program.
struct DriveLaw {
  Sided<WheelLaw> wheel{};
  Limits limits{};
  double half_track_m{};
  double price_W{};                        ///< of a second, standby included
  double efficiency{};                     ///< of recovery, in [0, 1)
  bool shared_bus{};                       ///< recovery is counted for both motors together
  std::vector<WheelLimit> wheel_limits{};  ///< those that the other limits leave a use
  std::vector<PowerLimit> power_limits{};
};

/// The model's law for driving forward (`direction` 1) or in reverse (-1) about a place with a payload.
/// Effects are taken as they are there: what depends on the place, or not linearly on the speeds, is
/// approximated. `price_W`: of a second, beyond standby.
[[nodiscard]] DriveLaw drive_law(const Plant& plant, const Limits& limits, double payload_kg,
                                 const Pose& place, double price_W, int direction = 1);

}  // namespace joulepath::joint
