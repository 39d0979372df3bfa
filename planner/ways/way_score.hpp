#pragma once

#include <array>
#include <map>

#include "planner/legs/stretch.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/mission_request.hpp"
#include "planner/values/plan.hpp"

namespace joulepath {

/// The input of a choice among ways.
struct ChoiceContext {
  const MissionRequest& mission;
  const MissionWorld& world;
  const RouteSpace* space{};
  const Plant& plant;
  const PlanOptions& options;
  double price_W{};  ///< price of a second on this leg, in addition to standby

  /// The price for comparisons of ways: a large value replaces an infinite price.
  double finite_price_W() const;
};

/// Energy and time of the optimal drive along a path at a price of time.
struct PathScore {
  double energy_J{};  ///< standby included
  double duration_s{};
  bool drivable{};

  double cost_J(double price_W) const { return drivable ? energy_J + price_W * duration_s : kNoLimit; }
  PathScore& operator+=(const PathScore& other);
};

inline constexpr std::size_t kScoringNodes = 60;

/// The score of a path on a leg, by inner profile solves on a coarse grid (`draft`): costs of ways differ by
/// percents, costs on different grids by hundredths of a percent.
[[nodiscard]] PathScore score_path(const Path& path, const LegRequest& leg, std::size_t leg_index,
                                   const ChoiceContext& context, std::size_t nodes = kScoringNodes);

/// True if a path has profiles within every limit, also between the nodes; draft scores check nodes only.
[[nodiscard]] bool is_drivable(const Path& path, const LegRequest& leg, std::size_t leg_index,
                               const ChoiceContext& context);

/// Cost of turns in place by payload and angle: tabulated by inner solves, interpolated between. Effects that
/// depend on the place or the heading are evaluated at the origin.
class TurnScores {
 public:
  explicit TurnScores(const ChoiceContext& context) : context_(context) {}

  PathScore turn(double from_rad, double to_rad, double payload_kg);

 private:
  static constexpr std::size_t kAngles = 12;
  using Table = std::array<PathScore, kAngles + 1>;  ///< at angles pi (i / kAngles)^2
  const Table& table(double payload_kg);
  Table tabulate(double payload_kg) const;

  ChoiceContext context_;
  std::map<double, Table> tables_{};
};

/// Cost of travel on a leg for the search: J/m of friction, rolling, slope and floor patches at a steady
/// speed with this leg's payload, plus standby and the price of time divided by that speed; J/rad of a
/// corner. Where the floor is uniform, `rate` is absent and costs count in metres of travel.
[[nodiscard]] TravelCost travel_cost(const LegRequest& leg, const ChoiceContext& context, TurnScores& turns);

}  // namespace joulepath
