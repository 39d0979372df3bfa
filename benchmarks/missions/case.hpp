#pragma once

#include <map>
#include <string>

#include "benchmarks/missions/draw.hpp"

namespace joulepath::bench {

/// Joules of one plan in the case's total time; waiting at the end counts as standby.
struct Joules {
  double with_standby{};
  double motion{};
};

/// One mission planned step by step, every plan in the same total time.
struct Case {
  std::map<std::string, Joules> joules{};  ///< by plan: plain, profile, time, arcs, ...
  bool order_changed{};
  double fleet_motion_percent{};  ///< error of the simple fleet model: of the motion's energy
  double fleet_percent{};         ///< of the energy with standby
  double together_cpu_s{};
};

[[nodiscard]] double cpu_s();

/// Three picks and a drop at random places; nothing if one of its plans cannot be driven.
[[nodiscard]] std::optional<Case> random_case(const Floor& floor, std::mt19937& random);

}  // namespace joulepath::bench
