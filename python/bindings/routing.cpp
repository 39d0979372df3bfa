#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>

#include "extensions/fleet/order_search.hpp"
#include "python/bindings/bindings.hpp"

namespace joulepath::python {
namespace {

using Number = std::int64_t;
using Problem = RoutingProblem;
using DriveRow = std::tuple<Number, Number, Number>;
using DriveRows = std::vector<DriveRow>;
using VisitRow = std::tuple<int, Number, Number, Number>;
using StepRow = std::tuple<int, int, int, Number, std::optional<VisitRow>>;
using RouteRows = std::vector<std::vector<StepRow>>;

Problem::Drives drives_of(const DriveRows& rows) {
  Problem::Drives drives;
  for (const auto& [duration_s, motion, upper] : rows) drives.push_back({duration_s, motion, upper});
  return drives;
}

void begin_problem(
    Problem* self, int places, const std::vector<std::tuple<Number, Number, Number>>& types,
    const std::vector<std::tuple<int, int, Number, Number, Number, Number, int>>& robots,
    const std::vector<std::tuple<int, int, Number, Number, std::vector<Number>>>& chargers,
    const std::vector<std::tuple<int, int, Number, Number, Number, std::vector<int>, std::vector<DriveRows>>>&
        missions,
    const std::vector<DriveRows>& ways, const std::vector<std::tuple<int, Number, Number>>& busy) {
  new (self) Problem{.places = places};
  for (const auto& [capacity, reserve, standby] : types) self->types.push_back({capacity, reserve, standby});
  for (const auto& [type, start, level, from_s, to_s, use_price, likeness] : robots)
    self->robots.push_back({type, start, level, from_s, to_s, use_price, likeness});
  for (const auto& [place, count, power, taper, knees] : chargers)
    self->chargers.push_back({place, count, power, taper, knees});
  for (const auto& [first, last, ready_s, due_s, late_price, drivers, drives] : missions) {
    self->missions.push_back({first, last, ready_s, due_s, late_price, drivers, {}});
    for (const DriveRows& rows : drives) self->missions.back().drives.push_back(drives_of(rows));
  }
  for (const DriveRows& rows : ways) self->ways.push_back(drives_of(rows));
  for (const auto& [charger, from_s, to_s] : busy) self->busy.push_back({charger, from_s, to_s});
}

std::optional<RouteRows> rows_of(const std::optional<DrivenRoutes>& driven) {
  if (!driven) return {};
  RouteRows routes;
  for (const auto& route : driven->routes) {
    auto& rows = routes.emplace_back();
    for (const RouteStep& step : route) {
      std::optional<VisitRow> visit;
      if (step.visit)
        visit = VisitRow{step.visit->charger, step.visit->from_s, step.visit->to_s, step.visit->target};
      rows.emplace_back(step.mission, step.way, step.speed, step.start_s, visit);
    }
  }
  return routes;
}

}  // namespace

void bind_routing(nb::module_& module) {
  nb::class_<Problem>(module, "RoutingProblem",
                      "A fleet in numbers: places, types, robots and missions by index. A drive is "
                      "(duration_s, motion, upper), a step (mission, way, speed, start_s, visit), a visit "
                      "(charger, from_s, to_s, target).")
      .def("__init__", &begin_problem, nb::arg("places"), nb::arg("types"), nb::arg("robots"),
           nb::arg("chargers"), nb::arg("missions"), nb::arg("ways"), nb::arg("busy"),
           "types: (capacity, reserve, standby). robots: (type, start, level, from_s, to_s, use_price, "
           "likeness). chargers: (place, count, power, taper, knee of each type). missions: (first, last, "
           "ready_s, due_s, late_price, robots, drives of each type). ways: drives of (type, from, to), "
           "row-major. busy: (charger, from_s, to_s).")
      .def(
          "drive",
          [](const Problem& self, const Orders& orders) {
            return rows_of(RouteDriver(self).drive(orders, kQueues_s));
          },
          nb::arg("orders"),
          "The cheapest routes by several waits at chargers; None where a battery or a shift ends.")
      .def(
          "dispatch",
          [](const Problem& self, double low, double high) {
            return rows_of(RouteDriver(self).dispatch(low, high));
          },
          nb::arg("low"), nb::arg("high"),
          "The routes of a dispatcher; None where a battery or a shift ends.")
      .def("inserted", &inserted_orders, "Orders of missions by insertion where they cost least.");
  nb::class_<OrderSearch>(module, "OrderSearch", "Simulated annealing over orders of missions.")
      .def(nb::init<const Problem&, Orders, Number, std::uint64_t, std::size_t>(), nb::keep_alive<1, 2>(),
           nb::arg("problem"), nb::arg("orders"), nb::arg("cost"), nb::arg("seed"), nb::arg("rounds"))
      .def(
          "advance",
          [](OrderSearch& self, std::size_t rounds) {
            std::optional<DrivenRoutes> best;
            {
              const nb::gil_scoped_release released;
              best = self.advance(rounds);
            }
            return rows_of(best);
          },
          nb::arg("rounds"), "The best routes so far where they are new, else None.");
}

}  // namespace joulepath::python
