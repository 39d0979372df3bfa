#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// Power at the battery's terminals. max(P, eta P) is the larger of two smooth functions, so the limit holds
/// for all combinations: P_left recovered or not, P_right recovered or not (with sharing: bus, the sum):
///   e_left P_left + e_right P_right + standby <= limit,   e in {1, eta}.
struct BatteryPower {
  static constexpr std::string_view name = "battery_power";
  static constexpr std::size_t rows = 4 * kLimitPoints;
  Limits limits{};

  Bounds bounds(const Segment& segment, std::size_t row) const {
    const PowerSupply& supply = segment.plant->robot.power;
    const std::size_t choice = row % 4;
    const bool mixed = choice == 1 || choice == 2;
    if (mixed && (supply.sharing == PowerSharing::bus || supply.regeneration_efficiency == 1.0)) return {};
    if (choice == 3) return {};  // both kept: below both driving, or both negative and no burden
    return {-kNoLimit, limits.battery_power_W - supply.standby_W};
  }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    const double eta = interval.segment.plant->robot.power.regeneration_efficiency;
    const std::size_t point = row / 4, choice = row % 4;
    const auto left = load_at(interval, point, Side::left);
    const auto right = load_at(interval, point, Side::right);
    using Real = typename AnyInterval::Real;
    return Real((choice & 1 ? eta : 1.0) * left.power_W + (choice & 2 ? eta : 1.0) * right.power_W);
  }
};

}  // namespace joulepath::nlp
