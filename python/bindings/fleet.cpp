#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <tuple>

#include "app/jobs/cache_choice.hpp"
#include "app/report/map_picture.hpp"
#include "app/report/page_text.hpp"
#include "extensions/fleet/fleet_file.hpp"
#include "extensions/fleet/fleet_floor.hpp"
#include "extensions/fleet/leg_energies.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/stop.hpp"

namespace joulepath::python {
namespace {

/// A fleet file with its robots and floors; answers about legs are cached as those of `joulepath batch`.
struct FleetValue {
  FleetFloor floor{};
  std::unique_ptr<AnswerCache> answers{};
  std::vector<ContentKey> worlds{};  ///< of the types

  [[nodiscard]] SharedAnswers shared(std::size_t type) const { return {answers.get(), worlds.at(type)}; }
};

std::unique_ptr<FleetValue> load_fleet(const std::string& file, bool cache) {
  const LongCall call;
  auto value = std::make_unique<FleetValue>();
  value->floor = read_fleet_floor(read_fleet(file));
  value->answers = answer_cache({.none = !cache});
  for (const FleetType& type : value->floor.types)
    value->worlds.push_back(world_key(floor_key(value->floor.fleet.floor, type.world), type.world.robot));
  return value;
}

using Point = std::tuple<double, double, double>;

std::vector<Point> points_of_leg(const FleetValue& self, std::size_t type, const std::string& from,
                                 const std::string& to, double payload_kg) {
  const LongCall call;
  std::vector<Point> points;
  for (const LegPoint& point : leg_points(self.floor, {type, from, to, payload_kg}, self.shared(type)))
    points.emplace_back(point.duration_s, point.motion_J, point.sigma_J);
  return points;
}

constexpr std::size_t kTrackSteps = 60;

std::vector<Point> track_of_leg(const FleetValue& self, std::size_t type, const std::string& from,
                                const std::string& to, double payload_kg) {
  const LongCall call;
  const Plan plan = leg_plan(self.floor, {type, from, to, payload_kg}, self.shared(type));
  std::vector<double> times_s;
  for (std::size_t k = 0; k <= kTrackSteps; ++k)
    times_s.push_back(plan.duration_s * static_cast<double>(k) / static_cast<double>(kTrackSteps));
  const Trajectory driven = plan_trajectory_at(plan, make_plant(self.floor.types[type].world.robot), times_s);
  std::vector<Point> track;
  for (std::size_t k = 0; k < driven.size(); ++k)
    track.emplace_back(times_s[k], driven.position_x_m[k], driven.position_y_m[k]);
  return track;
}

/// Width, height, resolution in m, origin (x, y, heading); cells as runs (class, count) from the bottom row
/// on.
using Picture = std::tuple<int, int, double, Point, std::vector<std::pair<int, int>>>;

Picture picture_of_floor(const FleetValue& self) {
  const MissionWorld& world = self.floor.types.front().world;
  const report::MapPicture map = report::map_picture(*world.map, world.keepout ? &*world.keepout : nullptr);
  const Point origin{map.origin.x_m, map.origin.y_m, map.origin.heading_rad};
  return {map.width, map.height, map.resolution_m, origin, {map.runs.begin(), map.runs.end()}};
}

}  // namespace

void bind_fleet(nb::module_& module) {
  nb::class_<FleetValue>(module, "FleetValue", "A fleet file, checked, with the floors of its robots.")
      .def_prop_ro(
          "json", [](const FleetValue& self) { return fleet_json(self.floor); }, "The fleet for the package.")
      .def("leg_points", &points_of_leg, nb::arg("type"), nb::arg("from_station"), nb::arg("to_station"),
           nb::arg("payload_kg"),
           "(duration_s, motion energy J without standby, 1-sigma J) from the cheapest to the quickest.")
      .def("leg_track", &track_of_leg, nb::arg("type"), nb::arg("from_station"), nb::arg("to_station"),
           nb::arg("payload_kg"), "(time_s, x_m, y_m) of the leg's drive when time is free.")
      .def_prop_ro(
          "map_picture", &picture_of_floor,
          "(width, height, resolution_m, (x_m, y_m, heading_rad) of the lower left corner, runs of cells "
          "from the bottom row on: free 0, unknown 1, occupied 2, keep-out 3).");
  module.def("page_day", &report::day, "The day that a report names, YYYY-MM-DD.");
  module.def("page_style", &report::shared_style, "The style that every report shares.");
  module.def("load_fleet", &load_fleet, nb::arg("file"), nb::arg("cache"));
}

}  // namespace joulepath::python
