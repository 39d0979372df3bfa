#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <tuple>

#include "app/jobs/cache_choice.hpp"
#include "extensions/fleet/fleet_file.hpp"
#include "extensions/fleet/fleet_floor.hpp"
#include "extensions/fleet/leg_energies.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/stop.hpp"

namespace joulepath::python {
namespace {

/// A fleet file with its robots and floors; answers about legs are cached as those of `joulepath batch`.
struct FleetValue {
  FleetFloor floor{};
  std::unique_ptr<AnswerCache> answers{};
  std::vector<ContentKey> worlds{};  ///< of the types
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
  const SharedAnswers answers{self.answers.get(), self.worlds.at(type)};
  for (const LegPoint& point : leg_points(self.floor, {type, from, to, payload_kg}, answers))
    points.emplace_back(point.duration_s, point.motion_J, point.sigma_J);
  return points;
}

}  // namespace

void bind_fleet(nb::module_& module) {
  nb::class_<FleetValue>(module, "FleetValue", "A fleet file, checked, with the floors of its robots.")
      .def_prop_ro(
          "json", [](const FleetValue& self) { return fleet_json(self.floor); }, "The fleet for the package.")
      .def("leg_points", &points_of_leg, nb::arg("type"), nb::arg("from_station"), nb::arg("to_station"),
           nb::arg("payload_kg"),
           "(duration_s, motion energy J without standby, 1-sigma J) from the cheapest to the quickest.");
  module.def("load_fleet", &load_fleet, nb::arg("file"), nb::arg("cache"));
}

}  // namespace joulepath::python
