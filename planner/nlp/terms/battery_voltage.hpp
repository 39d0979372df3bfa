#pragma once

#include "model/battery_sag.hpp"
#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// |V| + R_i I <= U, per wheel: the battery's open-circuit voltage U feeds the motor through its internal
/// resistance, which carries the current I of both wheels and of standby. I rises with the power at the
/// terminals, so the limit holds for all combinations of power that is recovered or not, as in BatteryPower,
/// and for both signs of V.
struct BatteryVoltage {
  static constexpr std::string_view name = "battery_voltage";
  static constexpr std::size_t rows = 8 * kSidedRows;  // row = 8 (2 point + side) + 4 sign + combination
  Limits limits{};

  Bounds bounds(const Segment& segment, std::size_t row) const {
    const PowerSupply& supply = segment.plant->robot.power;
    const std::size_t choice = row % 4;
    const bool mixed = choice == 1 || choice == 2;
    if (mixed && supply.sharing == PowerSharing::bus) return {};
    if (choice != 0 && supply.regeneration_efficiency == 1.0) return {};
    return {-kNoLimit, limits.battery_voltage_V};
  }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    using Real = typename AnyInterval::Real;
    const Robot& robot = interval.segment.plant->robot;
    const double eta = robot.power.regeneration_efficiency, sign = row % 8 < 4 ? 1.0 : -1.0;
    const std::size_t point = point_of(row / 8), choice = row % 4;
    const auto left = load_at(interval, point, Side::left);
    const auto right = load_at(interval, point, Side::right);
    const Real power_W = Real((choice & 1 ? eta : 1.0) * left.power_W +
                              (choice & 2 ? eta : 1.0) * right.power_W + Real(robot.power.standby_W));
    const auto& own = side_of(row / 8) == Side::left ? left : right;
    return Real(sign * own.voltage_V + BatterySag(robot.battery)(power_W));
  }
};

}  // namespace joulepath::nlp
