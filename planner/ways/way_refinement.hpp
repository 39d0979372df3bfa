#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "planner/joint/joint_search.hpp"
#include "planner/path/shape/free_spline.hpp"
#include "planner/ways/leg_path.hpp"
#include "planner/ways/route_sketch.hpp"
#include "planner/ways/stop_swing.hpp"
#include "planner/ways/way_chain.hpp"
#include "planner/ways/way_run.hpp"

namespace joulepath {

/// Turns the chosen ways of a run into paths: optionally moves control points, then adds the turns in place
/// at the stops.
class RefinedRun {
 public:
  RefinedRun(const ChainRequest& request, const std::vector<ChainChoice>& chain, const WayRun& run);

  /// Replaces turns in place at the stops of some legs by curves where that is cheaper: optimizes each leg in
  /// turn as a whole from the robot's present heading (best_swing), then each stop between two such legs
  /// (best_stop).
  void swing(std::size_t first, std::size_t count);

  /// Replaces the curves of up to three consecutive legs by those that optimize path and speed together,
  /// headings at the stops between included, where their certified drive is cheaper. `swings`: where none is
  /// found, the legs are optimized by swing() first.
  void join(bool swings);

  /// Whether a leg's present path must not be driven: its way needs a turn without room, or drives forward
  /// where reverse is asked. Only join() finds another one.
  [[nodiscard]] bool barred() const;

  /// The paths of the legs, turns in place included.
  [[nodiscard]] std::vector<LegPath> paths() const;

  /// Adds the results of refinement to the alternatives and improvements of a leg.
  void tell(std::size_t k, LegPath& path) const;

 private:
  struct Part {
    const Way* way{};
    Path path{};
    PathScore driving{};  ///< of the path only
    double leaves_rad{};
    double arrives_rad{};
    bool turns_at_goal{};  ///< turns after arrival to the heading in which the next leg leaves (or to that of
                           ///< the station)
    bool refined{};
    bool barred{};
    std::optional<FreeSpline> spline{};  ///< the path's spline, where it is one
  };
  std::optional<double> heading_before(std::size_t k) const;
  std::optional<double> heading_after(std::size_t k) const;
  PathScore score(std::size_t k, const Path& path) const;
  PathScore score(std::size_t k) const;
  PathScore driving(std::size_t k, const Path& path) const;
  bool drivable(std::size_t k, const Path& path) const;
  PathScore turn_before(std::size_t k, const Path& path) const;
  PathScore turn_after(std::size_t k, const Path& path) const;
  PathScore turn_after(std::size_t k, double arrives_rad) const;
  std::function<double(double)> turning_J(std::size_t k) const;
  /// Only the paths at the end must be drivable also between the nodes of a draft. Where one is not, all
  /// swings are searched again, and each is checked before it is taken.
  void swing_all(std::size_t first, std::size_t count, bool checked);
  void swing_leg(std::size_t k, bool checked);
  bool swing_from(std::size_t k, double leaves_rad, bool checked);
  const std::vector<SwingResult>& swings(std::size_t k, double leaves_rad,
                                         const std::optional<double>& arrives_rad);
  const std::optional<StopResult>& stop_swing(std::size_t k, const FreeSpline& arriving);
  void swing_through(std::size_t k, bool checked);
  joint::DriveLaw law_of(std::size_t k, int direction) const;
  bool may_drive(std::size_t k, int direction) const;
  using Starts = std::vector<std::vector<joint::Sketch>>;
  std::vector<RouteDrive> drives(std::size_t k) const;
  std::vector<std::vector<RouteDrive>> drive_choices(std::size_t first, std::size_t count) const;
  std::vector<joint::Sketch> backward_words(std::size_t k, const joint::JointQuery& query) const;
  Starts rough_paths(std::size_t k, const joint::JointQuery& query, RouteDrive drive) const;
  Starts rough_chains(std::size_t first, const joint::JointQuery& query,
                      const std::vector<RouteDrive>& drives) const;
  std::array<Starts, 2> joint_starts(std::size_t first, const joint::JointQuery& query) const;
  Starts one_by_one(std::size_t first, const joint::JointQuery& query) const;
  double driven_J(std::size_t first, std::size_t count) const;
  bool drivable(std::size_t first, std::size_t count) const;
  void take(std::size_t first, const joint::JointPaths& joined);
  bool take_cheapest(std::size_t first, std::size_t count, const joint::JointQuery& query,
                     std::array<Starts, 2> starts, double present_J);
  bool join(std::size_t first, std::size_t count);
  void take(std::size_t k, const Path& path);
  PathScore as_driven(std::size_t k) const;

  const ChainRequest& request_;
  const WayRun& run_;
  std::vector<Part> parts_{};
  /// Curves found so far by what determines them: swing_all() asks again for most of them.
  std::map<std::vector<double>, std::vector<SwingResult>> known_swings_{};
  std::map<std::vector<double>, std::optional<StopResult>> known_stops_{};
};

}  // namespace joulepath
