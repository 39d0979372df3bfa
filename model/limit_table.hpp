#pragma once

#include <string_view>

#include "model/operating_point.hpp"

namespace joulepath {

/// The state of a moving robot, as input of the table of limits (its rows are in model/limits.hpp).
struct LimitState {
  using Motor = joulepath::Motor;

  const Plant& plant;
  Site site{};
  BodyMotion<double> motion{};
  double speed_gain_m_s2{};  ///< d|v|/dt: negative while braking, in reverse too
  double jerk_m_s3{};
  Sided<double> wheel_acceleration_rad_s2{};
  Sided<WheelState<double>> wheels{};
  double normal_load_N{};    ///< on each wheel, m g/2
  double battery_power_W{};  ///< at the terminals, standby included
  double battery_sag_V{};    ///< what the battery's resistance takes of its voltage at this power
};

/// The state of a plant in motion. `speed_gain_m_s2` is an argument because at standstill the motion does not
/// say whether the speed rises or falls.
[[nodiscard]] LimitState limit_state(const Plant& plant, const BodyMotion<double>& motion, const Site& site,
                                     double speed_gain_m_s2, double jerk_m_s3);

using Limit = LimitRow<LimitState>;
inline constexpr const auto& kLimits = kLimitRows<LimitState>;

/// The row with a name (not a key); null where there is none.
[[nodiscard]] const Limit* limit_named(std::string_view name);

/// What the robot may carry: the row, and its value (infinite without `limits:`).
[[nodiscard]] const Limit& payload_limit();
[[nodiscard]] double payload_limit_kg(const Robot& robot);

/// A limit's value in force for a wheel.
[[nodiscard]] double limit_of(const Limit& row, const Limits& limits, const Sided<Motor>& motor, Side side);

/// |value| / limit. For a limit of zero: 0 if the value is zero, else infinity.
[[nodiscard]] double limit_fraction(double value, double limit);

/// Calls use(row, value, limit) for each finite limit of a motion; once for each wheel where the row says so.
template <class Use>
void for_each_limit(const LimitState& state, const Limits& limits, Use&& use) {
  for (const Limit& row : kLimits)
    for (const Side side : kSides) {
      if (row.value == nullptr || (side == Side::right && !row.per_wheel)) break;
      const double limit = limit_of(row, limits, state.plant.robot.motor, side);
      if (limit < kNoLimit) use(row, row.value(state, side), limit);
    }
}

/// Limits with `limits: by_payload` applied. Each key is linear in the payload between the rows, and constant
/// beyond the first and the last row. A row without a key has that key's value outside of `by_payload`.
/// Between a row with a limit and a row without, the limit of the first one holds.
[[nodiscard]] Limits limits_for_payload(const Robot& robot, double payload_kg);

/// For each key the least limit over all payloads between two.
[[nodiscard]] Limits limits_between_payloads(const Robot& robot, double from_kg, double to_kg);

}  // namespace joulepath
