#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/ways/leg_ways.hpp"

namespace joulepath {

/// Data of a leg for the choice: its ways with their scores at its price, and the cost of turns in place.
struct ChainLeg {
  const std::vector<Way>* ways{};
  double price_W{};
  double start_payload_kg{};
  double goal_payload_kg{};
  std::optional<double> goal_heading_rad{};  ///< of the station; absent: any
  Pose goal{};                               ///< place of the stop at its end
  TurnScores* turns{};
};

/// Consecutive legs between stations, from the robot's pose on.
struct ChainRequest {
  Pose start{};
  bool start_heading_free{};
  std::vector<ChainLeg> legs{};
  /// True if the robot may turn in place from one heading to another.
  std::function<bool(const Pose& place, double from_rad, double to_rad)> may_turn{};
  bool turns_count{true};  ///< false: as if every turn could be driven, and for nothing
};

/// The choice for one leg.
struct ChainChoice {
  std::size_t way{};
  std::optional<double> goal_heading_rad{};  ///< heading to turn to after arrival; absent: no turn
  PathScore score{};                         ///< includes the turns at both ends that this leg makes
};

/// The cheapest choice of a way for every leg, including the turns in place between them: dynamic programming
/// over the stops, where the end heading of a way is the state. At a stop without a heading the robot turns
/// at the end of one leg or at the start of the next one; the cheaper payload decides. `usable` returns the
/// ways that may be chosen. Empty where no choice can be driven.
[[nodiscard]] std::vector<ChainChoice> cheapest_chain(
    const ChainRequest& request, const std::function<bool(std::size_t leg, const Way&)>& usable);

/// Cost of a leg with each of its ways, between the chosen ways of its neighbors, turns at both stops
/// included; empty for a way that cannot be driven.
[[nodiscard]] std::vector<PathScore> scores_between(const ChainRequest& request,
                                                    const std::vector<ChainChoice>& chosen, std::size_t leg);

}  // namespace joulepath
