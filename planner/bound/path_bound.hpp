#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "planner/bound/heading_bound.hpp"
#include "planner/path/search/route.hpp"
#include "planner/values/plan.hpp"

// Design: docs/nlp.md, "What the bound over all paths means"
namespace joulepath {

/// What a bound of one leg depends on.
struct LegEnds {
  Point2 start_m{}, goal_m{};
  std::optional<double> start_rad{}, goal_rad{};  ///< headings; absent: free
  double payload_kg{};
  double way_at_most_m{kNoLimit};   ///< length of a known way
  double cost_at_most_J{kNoLimit};  ///< of a known motion, time at its price included
};

/// The least that any path of a leg takes, time at its price included; or the reason why no bound is known.
struct LegBound {
  double cost_J{};
  bool around_corners{};
  bool by_headings{};  ///< headings at the ends raise it
  std::string reason{};
};

/// Bounds of legs of one robot on one floor. Straight lines that it has bounded once are remembered, with
/// what turning on them takes. Plant, robot and floor must outlive it.
class LegBounds {
 public:
  LegBounds(const Plant& plant, const Robot& robot, const RouteSpace* space)
      : plant_(plant), robot_(robot), space_(space) {}

  [[nodiscard]] LegBound find(const LegEnds& leg, double time_W);

 private:
  const PowerForm& form(double payload_kg);
  const LineBound& line(double payload_kg, double time_W, double length_m);
  const RateTable& rates(const LegEnds& leg, double time_W, double length_m);
  double with_headings_J(const LegEnds& leg, double time_W, double way_m, double line_J);

  const Plant& plant_;
  const Robot& robot_;
  const RouteSpace* space_{};
  std::map<double, PowerForm> forms_{};                 ///< by payload
  std::map<std::array<double, 3>, LineBound> lines_{};  ///< by payload, price of a second, length
  std::map<std::tuple<double, double, double, bool, bool>, RateTable> rates_{};  ///< and the headings given
};

/// Adds to a plan and to each of its legs the energy below which no path of any kind leads from stop to stop
/// in the plan's time or less; or the reason why there is none. `space`: the floor, where the mission has a
/// map.
void add_path_bounds(Plan& plan, const MissionRequest& mission, const MissionWorld& world, const Plant& plant,
                     const RouteSpace* space);

}  // namespace joulepath
