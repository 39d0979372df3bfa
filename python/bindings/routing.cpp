#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <stdexcept>
#include <string>
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

void expect(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("RoutingProblem: " + what);
}

bool within(Number index, std::size_t count) { return index >= 0 && index < static_cast<Number>(count); }

void check_mission(const Problem& problem, const Problem::Mission& mission) {
  expect(within(mission.first, static_cast<std::size_t>(problem.places)) &&
             within(mission.last, static_cast<std::size_t>(problem.places)),
         "a mission has no such place");
  expect(!mission.robots.empty(), "a mission has no robots");
  expect(mission.drives.size() == problem.types.size(), "a mission has not the drives of each type");
  for (const int r : mission.robots)
    expect(within(r, problem.robots.size()) &&
               !mission.drives[static_cast<std::size_t>(problem.robot(r).type)].empty(),
           "a mission has a robot without drives");
}

/// What the driver and the search take for granted. Throws std::invalid_argument.
void check(const Problem& problem) {
  const auto places = static_cast<std::size_t>(problem.places);
  expect(!problem.missions.empty(), "no missions");
  expect(problem.ways.size() == problem.types.size() * places * places,
         "the ways are not types x places x places");
  for (const auto& robot : problem.robots)
    expect(within(robot.type, problem.types.size()) && within(robot.start, places),
           "a robot has no such type or place");
  for (const auto& charger : problem.chargers) {
    expect(within(charger.place, places) && charger.count > 0, "a charger has no such place, or no count");
    expect(charger.knees.size() == problem.types.size(), "a charger has not the knee of each type");
    for (const auto& type : problem.types)
      expect(std::min(charger.power, charger.taper) > type.standby, "a charger gives no more than a standby");
  }
  for (const auto& mission : problem.missions) check_mission(problem, mission);
  for (const auto& busy : problem.busy)
    expect(within(busy.charger, problem.chargers.size()), "a visit has no such charger");
}

/// Orders that have each mission once, by a robot that may drive it. Throws std::invalid_argument.
const Orders& checked(const Problem& problem, const Orders& orders) {
  expect(orders.size() == problem.robots.size(), "the orders are not those of the robots");
  std::vector<int> driven(problem.missions.size(), 0);
  for (std::size_t r = 0; r < orders.size(); ++r)
    for (const int m : orders[r]) {
      expect(within(m, driven.size()), "an order has no such mission");
      const auto& robots = problem.mission(m).robots;
      expect(std::find(robots.begin(), robots.end(), static_cast<int>(r)) != robots.end(),
             "an order has a mission that its robot may not drive");
      ++driven[static_cast<std::size_t>(m)];
    }
  expect(std::all_of(driven.begin(), driven.end(), [](int times) { return times == 1; }),
         "the orders have not each mission once");
  return orders;
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
  check(*self);
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
  nb::class_<Problem>(
      module, "RoutingProblem",
      "A fleet in numbers: places, types, robots and missions by index; whole seconds and tenths of a "
      "joule. A drive is "
      "(duration_s, motion, upper), a step (mission, way, speed, start_s, visit), a visit "
      "(charger, from_s, to_s, target).")
      .def("__init__", &begin_problem, nb::arg("places"), nb::arg("types"), nb::arg("robots"),
           nb::arg("chargers"), nb::arg("missions"), nb::arg("ways"), nb::arg("busy"),
           "types: (capacity, reserve, standby). robots: (type, start, level, from_s, to_s, use_price, "
           "likeness). chargers: (place, count, power, taper, knee of each type). missions: (first, last, "
           "ready_s, due_s, late_price, robots, drives of each type). ways: drives of (type, from, to), "
           "row-major. busy: (charger, from_s, to_s). Raises ValueError where they do not fit.")
      .def(
          "drive",
          [](const Problem& self, const Orders& orders) {
            return rows_of(RouteDriver(self).drive(checked(self, orders), kWaits_s));
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
  nb::class_<OrderSearch>(module, "OrderSearch",
                          "Simulated annealing over orders of missions, by one thread at a time.")
      .def(
          "__init__",
          [](OrderSearch* self, const Problem& problem, const Orders& orders, Number cost, std::uint64_t seed,
             std::size_t rounds) {
            new (self) OrderSearch(problem, checked(problem, orders), cost, seed, rounds);
          },
          nb::keep_alive<1, 2>(), nb::arg("problem"), nb::arg("orders"), nb::arg("cost"), nb::arg("seed"),
          nb::arg("rounds"))
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
