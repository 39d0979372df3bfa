#pragma once

#include <vector>

#include "planner/path/shape/free_spline.hpp"
#include "planner/ways/leg_path.hpp"
#include "planner/ways/way_chain.hpp"
#include "planner/ways/way_run.hpp"

namespace joulepath {

/// Turns the chosen ways of a run into paths: control points may be moved, then turns in place
/// at the stops are added.
class RefinedRun {
 public:
  RefinedRun(const ChainRequest& request, const std::vector<ChainChoice>& chain, const WayRun& run);

  /// Moves the control points of each leg in turn, its neighbors' headings given; a way that leaves or
  /// reaches a stop in the heading of its neighbor keeps that heading.
  void refine();

  /// Replaces turns in place at the stops by curves: each leg in turn is optimized as a whole from the
  /// heading in which the robot stands (best_swing), where that is cheaper.
  void swing();

  /// The paths of the legs, turns in place included.
  [[nodiscard]] std::vector<LegPath> paths() const;

  /// Adds what refinement made of a leg to its alternatives and improvements.
  void tell(std::size_t k, LegPath& path) const;

 private:
  struct Part {
    const Way* way{};
    Path path{};
    PathScore driving{};  ///< of the path alone
    double leaves_rad{};
    double arrives_rad{};
    bool turns_at_goal{};  ///< after arrival, to where the next leg leaves (or to the heading of the station)
    bool refined{};
    std::optional<FreeSpline> spline{};  ///< of a path that is one
  };
  std::optional<double> heading_before(std::size_t k) const;
  std::optional<double> heading_after(std::size_t k) const;
  PathScore score(std::size_t k, const Path& path) const;
  PathScore score(std::size_t k) const;
  PathScore driving(std::size_t k, const Path& path) const;
  bool drivable(std::size_t k, const Path& path) const;
  PathScore turn_before(std::size_t k, const Path& path) const;
  PathScore turn_after(std::size_t k, const Path& path) const;
  void refine(std::size_t k);
  void swing(std::size_t k);
  void swing_through(std::size_t k);
  void take(std::size_t k, const Path& path);
  PathScore as_driven(std::size_t k) const;

  const ChainRequest& request_;
  const WayRun& run_;
  std::vector<Part> parts_{};
};

}  // namespace joulepath
