#pragma once

#include <array>
#include <vector>

#include "planner/joint/joint_search.hpp"
#include "planner/ways/leg_path.hpp"
#include "planner/ways/route_sketch.hpp"
#include "planner/ways/way_chain.hpp"
#include "planner/ways/way_run.hpp"

namespace joulepath {

/// Turns the chosen ways of a run into paths: optionally optimizes path and speed together, then adds the
/// turns in place at the stops.
class RefinedRun {
 public:
  RefinedRun(const ChainRequest& request, const std::vector<ChainChoice>& chain, const WayRun& run);

  /// Replaces the curves of up to three consecutive legs by those that optimize path and speed together,
  /// headings at the stops between included, where their drive is cheaper.
  void join();

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
    std::optional<joint::Sketch> sketch{};  ///< of a refined path
    bool barred{};
  };
  std::optional<double> heading_before(std::size_t k) const;
  std::optional<double> heading_after(std::size_t k) const;
  PathScore score(std::size_t k) const;
  PathScore driving(std::size_t k, const Path& path) const;
  PathScore turn_before(std::size_t k, const Path& path) const;
  PathScore turn_after(std::size_t k, const Path& path) const;
  joint::DriveLaw law_of(std::size_t k, int direction) const;
  bool may_drive(std::size_t k, int direction) const;
  using Starts = std::vector<std::vector<joint::Sketch>>;
  std::vector<RouteDrive> drives(std::size_t k) const;
  std::vector<std::vector<RouteDrive>> drive_choices(std::size_t first, std::size_t count) const;
  std::vector<joint::Sketch> backward_words(std::size_t k, const joint::JointQuery& query) const;
  Starts rough_paths(std::size_t k, const joint::JointQuery& query, RouteDrive drive) const;
  Starts turning_paths(std::size_t k, const joint::JointQuery& query) const;
  Starts rough_chains(std::size_t first, const joint::JointQuery& query,
                      const std::vector<RouteDrive>& drives) const;
  std::array<Starts, 2> joint_starts(std::size_t first, const joint::JointQuery& query) const;
  Starts one_by_one(std::size_t first, const joint::JointQuery& query) const;
  double driven_J(std::size_t first, std::size_t count) const;
  bool drivable(std::size_t first, std::size_t count) const;
  void take(std::size_t first, const joint::JointPaths& joined);
  bool take_cheapest(std::size_t first, std::size_t count, const joint::JointQuery& query,
                     const std::array<Starts, 2>& starts, double present_J);
  bool may_join(std::size_t k) const;
  bool join(std::size_t first, std::size_t count);
  bool joins_again(std::size_t first, std::size_t count) const;
  PathScore as_driven(std::size_t k) const;

  const ChainRequest& request_;
  const WayRun& run_;
  std::vector<Part> parts_{};
};

}  // namespace joulepath
