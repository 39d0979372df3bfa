#pragma once

#include <cstddef>
#include <vector>

#include "model/plant.hpp"
#include "planner/path/geometry/path.hpp"

namespace joulepath {

enum class TimeMode {
  fixed_time,    ///< exactly duration_s
  time_budget,   ///< at most duration_s
  free_time,     ///< least energy, standby included
  time_price,    ///< least energy + price_W T, at most duration_s
  minimum_time,  ///< least time; the energy is not minimized
};

struct TimeGoal {
  TimeMode mode{TimeMode::free_time};
  double duration_s{kNoLimit};
  double price_W{};  ///< time_price only; beyond standby
};

/// Speed cap (m/s) on an interval of arc length; of no effect on a turn in place.
struct SpeedCap {
  double from_m{};
  double to_m{};
  double speed_m_s{};
};

enum class SolverChoice { ipopt, fast };

/// Payload as stated, linear in the path coordinate (equal ends: constant).
struct PayloadAlongPath {
  double from_kg{};
  double to_kg{};
};

/// A piece of path without a stop, and the requested profile. Rates are those of the path coordinate: m/s
/// along a curve, rad/s in a turn in place.
struct ProfileRequest {
  PathPiece piece;
  Plant plant{};
  Limits limits{};  ///< already resolved for the payload, see limits_for_payload()
  PayloadAlongPath payload{};
  double start_rate{};
  double end_rate{};
  std::vector<SpeedCap> speed_caps{};
  TimeGoal time{};
  std::size_t nodes{200};
  double accuracy{1e-4};  ///< relative: NLP energy against replay, and the gap that counts as optimal
  double proven{0.04};    ///< ends grid refinement: a gap of this share of `accuracy`; least time has its own
  SolverChoice solver{SolverChoice::ipopt};
  /// For comparisons of paths: one grid, limits at its nodes only, no jerk limit, no bound.
  bool draft{};
  double time_of_day_s{};  ///< at the start
  EffectMemory memory{};   ///< of the effects, at the start
};

}  // namespace joulepath
