#pragma once

#include "planner/values/plan.hpp"

namespace joulepath {

/// One row of a mission's energy: a part of a leg that is driven, a turn in place, waiting, a dwell, or a
/// prescribed motion. All rows of a plan add up to its energy and its time.
struct EdgeEnergy {
  enum class Kind { drive, turn, wait, dwell, prescribed };
  std::size_t leg{};
  std::string name{};  ///< name of an order's edge; else empty
  Kind kind{Kind::drive};
  double start_s{};  ///< from the mission's start
  double duration_s{};
  double distance_m{};
  double turned_rad{};  ///< in place
  double payload_kg{};  ///< at the beginning
  Pose from{};
  Pose to{};
  EnergyByCause energy{};
};

[[nodiscard]] const char* edge_kind_name(EdgeEnergy::Kind kind);

/// The rows of a valid plan in the order of driving: one per edge if the mission names edges, else one per
/// stretch without a stop.
[[nodiscard]] std::vector<EdgeEnergy> edge_energies(const Plan& plan, const Plant& plant);

}  // namespace joulepath
