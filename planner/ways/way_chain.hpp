#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "planner/ways/leg_ways.hpp"

namespace joulepath {

/// The data of a leg that the choice needs: its ways, with their scores at its price, and what turning in
/// place costs.
struct ChainLeg {
  const std::vector<Way>* ways{};
  double price_W{};
  double start_payload_kg{};
  double goal_payload_kg{};
  std::optional<double> goal_heading_rad{};  ///< of the station; absent: any
  Pose goal{};                               ///< place of the stop at its end
  TurnScores* turns{};
};

/// Consecutive legs between stations, from where the robot stands.
struct ChainRequest {
  Pose start{};
  bool start_heading_free{};
  std::vector<ChainLeg> legs{};
  /// Whether the robot may turn on the spot from one heading to another.
  std::function<bool(const Pose& place, double from_rad, double to_rad)> may_turn{};
};

/// The choice for one leg.
struct ChainChoice {
  std::size_t way{};
  std::optional<double> goal_heading_rad{};  ///< turn to it after arrival; absent: stay as arrived
  PathScore score{};                         ///< turns at both ends included, as far as this leg makes them
};

/// The cheapest choice of a way for every leg, turns in place between them included: dynamic programming over
/// the stops, where a way's end heading is the state. At a stop that names no heading the robot may turn at
/// the end of one leg or at the start of the next one, whichever payload makes that cheaper. `usable` says
/// which ways may be chosen. Empty where no choice can be driven.
[[nodiscard]] std::vector<ChainChoice> cheapest_chain(
    const ChainRequest& request, const std::function<bool(std::size_t leg, const Way&)>& usable);

/// What a leg would cost with each of its ways between the chosen ones of its neighbors, turns at both stops
/// included; nothing where it could not be driven.
[[nodiscard]] std::vector<PathScore> scores_between(const ChainRequest& request,
                                                    const std::vector<ChainChoice>& chosen, std::size_t leg);

}  // namespace joulepath
