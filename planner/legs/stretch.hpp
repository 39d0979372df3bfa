#pragma once

#include <map>
#include <string>
#include <vector>

#include "planner/cache/answer_cache.hpp"
#include "planner/values/mission_request.hpp"
#include "planner/values/profile_request.hpp"

namespace joulepath {

/// Steps of choosing ways; a step that is left out is replaced by its simplest alternative.
struct WaySteps {
  bool corners{true};     ///< else stop, turn, go at every corner
  bool routes{true};      ///< else the shortest route
  bool stops{true};       ///< else the robot turns on the spot at stops
  bool refinement{true};  ///< path and speed together; else corners stay as they were blended
  /// Path and speed together within the mean acceleration of a ramp under the jerk limit, which that program
  /// leaves out otherwise.
  bool mean_ramps{};
};

/// The share of a limit that a plan may use, by the limit's name: the rest is its margin.
using LimitShares = std::map<std::string, double>;

struct PlanOptions {
  SolverChoice solver{SolverChoice::ipopt};
  std::size_t nodes{200};
  double accuracy{1e-4};
  unsigned seed{1};
  WaySteps steps{};
  bool baselines{true};        ///< compare with classic profiles
  bool path_bound{};           ///< bound the energy over all paths
  unsigned threads{1};         ///< threads for the legs of one mission; the plan does not depend on it
  SharedAnswers answers{};     ///< cached answers of other missions; the plan does not depend on them
  bool any_price_of_heat{};    ///< whether windings can be kept at all: not at the least price
  LimitShares limit_shares{};  ///< of the limits that profiles use; the others in full
  bool draft{};  ///< profiles are drafts (ProfileRequest::draft): no bound, never more than feasible
};

/// The options of a plan that uses at most these shares of its limits, beside those that it has. Its cached
/// answers are its own.
[[nodiscard]] PlanOptions with_limit_shares(PlanOptions options, const LimitShares& shares);

/// Limits that hold for all payloads of a leg: per key the least over the payloads on the way,
/// with the battery's own greatest power.
[[nodiscard]] Limits limits_along(const Robot& robot, const PayloadAlongLeg& payload);

/// Mean acceleration (m/s^2) of a ramp between rest and the peak speed of a path of this length, at full
/// jerk.
[[nodiscard]] double mean_ramp_m_s2(double length_m, const Limits& limits);

/// What of these limits depends on the battery, for another one: the least of both.
void limit_by_battery(Limits& limits, const Battery& battery);

/// Whether a leg may be driven backward: its direction allows it, and the robot states a reverse speed.
[[nodiscard]] bool may_reverse(const Robot& robot, const LegRequest& leg);

/// The speed caps of a piece that begins `offset_m` into its leg: the mission's zones on that leg, and the
/// speed mask sampled along the curve (at half of its resolution, so that no cell is skipped).
[[nodiscard]] std::vector<SpeedCap> speed_caps_on(const PathPiece& piece, double offset_m, std::size_t leg,
                                                  const std::vector<SpeedZone>& zones,
                                                  const std::optional<SpeedMask>& mask,
                                                  double speed_limit_m_s);

/// The requests of a leg to the profile optimizer, one per piece. The memories of the effects continue from
/// piece to piece, from `memory` at the departure. The caller sets the time goals.
[[nodiscard]] std::vector<ProfileRequest> stretches_of(const Path& path, const LegRequest& leg,
                                                       std::size_t leg_index, const MissionRequest& mission,
                                                       const MissionWorld& world, const Plant& plant,
                                                       const PlanOptions& options, EffectMemory memory = {});

/// Memories of the effects at the end of a piece.
[[nodiscard]] EffectMemory memory_after(const ProfileRequest& request);

}  // namespace joulepath
