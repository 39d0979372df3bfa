#pragma once

#include <array>

#include "model/robot.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// Planar motion of the axle midpoint P0 at an instant. Templated on the scalar: double, or an
/// automatic-differentiation number.
template <class Real>
struct BodyMotion {
  Real speed_m_s{};                ///< v: along the heading, negative when reversing
  Real acceleration_m_s2{};        ///< dv/dt
  Real yaw_rate_rad_s{};           ///< omega: counter-clockwise
  Real yaw_acceleration_rad_s2{};  ///< d omega/dt
};

inline constexpr std::size_t kMaxMemories = 2;

/// One number for each effect with a memory (a swivelling caster).
using EffectMemory = std::array<double, kMaxMemories>;

/// What effects may use of an instant besides the speeds: place, time, payload and directions of motion.
/// Directions are -1, 0 or +1 in planning (they depend on the path alone, so that friction is exact even at
/// rest); a simulator may pass a value between.
struct Site {
  Pose pose{};
  double time_of_day_s{};           ///< since the robot was cold
  double payload_kg{};              ///< as stated, before any error of it
  double travel_direction{};        ///< sign of the speed
  double turn_direction{};          ///< sign of the yaw rate
  Sided<double> wheel_direction{};  ///< sign of each wheel's speed
  double course{};                  ///< caster course that the motion demands, see course_of()
  EffectMemory memory{};
};

}  // namespace joulepath
