#pragma once

#include <cstddef>
#include <span>

#include "model/limits.hpp"
#include "model/plant.hpp"

// Design: docs/decisions/0402-on-the-robot.md
namespace joulepath {

/// What the drives are told from the start of a period on; the accelerations hold throughout it.
struct CommandedMotion {
  double rate{};  ///< speed along the direction of travel, m/s, >= 0
  double acceleration_m_s2{};
  double yaw_rate_rad_s{};
  double yaw_acceleration_rad_s2{};
};

/// Makes commands that continue each other: speed and yaw rate have no jumps, and acceleration, its change
/// from one period to the next (the jerk), yaw acceleration and the drives' limits are kept. Wanted speeds
/// that ask for more are approached as fast as the limits allow.
class CommandShaper {
 public:
  static constexpr std::size_t kLook = 40;  ///< wanted speeds of the look-ahead under a jerk limit

  CommandShaper(const Plant& plant, int travel_sign, const CommandedMotion& start)
      : plant_(plant), travel_sign_(travel_sign), now_(start) {}

  /// Goes on to the next period, `elapsed_s` after the last one; its accelerations are the last ones yet.
  void advance(double elapsed_s);

  /// Seconds between the wanted speeds of accelerate(); 0: without a jerk limit one is enough.
  [[nodiscard]] static double spacing_s(const Limits& limits, double period_s);

  /// Speed at the end of the period. wanted[m]: the speed that is due m * spacing_s() after the end.
  ///
  /// Under a jerk limit j, the acceleration can fall by j T per period of T, so that the speed grows by
  ///   (T + h) a - j h (h + T)/2
  /// until h after the end; a must leave this below every wanted speed, and mirrored above 0.
  double accelerate(const Limits& limits, std::span<const double> wanted, double period_s);

  /// The speed at the end of the period up to which a course of so much yaw per metre keeps yaw rate, yaw
  /// acceleration and lateral acceleration.
  [[nodiscard]] double fastest_on(double yaw_per_m, const Limits& limits, double period_s) const;

  /// Turns towards a yaw rate at the end of the period, as far as the lateral acceleration allows it at the
  /// speed that is reached then.
  void turn(const Limits& limits, double wanted_rad_s, double period_s);

  /// Lowers the accelerations as far as the drives need it: voltage, current, power, traction, wheel
  /// acceleration. A jerk limit comes first.
  void keep_drives(const Limits& limits, double payload_kg, double period_s);

  const CommandedMotion& now() const { return now_; }
  double end_rate(double period_s) const { return now_.rate + period_s * now_.acceleration_m_s2; }
  bool at_rest() const { return now_.rate == 0 && now_.yaw_rate_rad_s == 0; }

 private:
  [[nodiscard]] bool drives_keep(const Limits& limits, double payload_kg, double period_s) const;

  Plant plant_;
  int travel_sign_{};
  CommandedMotion now_{};
  double least_{-kNoLimit}, most_{kNoLimit};  ///< acceleration that the last one and the jerk limit allow
};

}  // namespace joulepath
