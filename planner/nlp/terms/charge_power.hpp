#pragma once

#include "planner/nlp/terms/term.hpp"

namespace joulepath::nlp {

/// Power into the battery's terminals: eta (P_left + P_right) + standby >= -limit. Exact where both wheels
/// return power or share a bus; where one of them drives, max(P, eta P) is above and less is returned.
struct ChargePower {
  static constexpr std::string_view name = "charge_power";
  static constexpr std::size_t rows = kLimitPoints;
  Limits limits{};

  Bounds bounds(const Segment& segment, std::size_t) const {
    const PowerSupply& supply = segment.plant->robot.power;
    if (supply.regeneration_efficiency == 0.0) return {};
    return {-limits.charge_power_W - supply.standby_W, kNoLimit};
  }
  template <class AnyInterval>
  auto operator()(const AnyInterval& interval, std::size_t row) const {
    using Real = typename AnyInterval::Real;
    const double eta = interval.segment.plant->robot.power.regeneration_efficiency;
    return Real(eta *
                (load_at(interval, row, Side::left).power_W + load_at(interval, row, Side::right).power_W));
  }
};

}  // namespace joulepath::nlp
