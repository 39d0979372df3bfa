"""Schedules without a solver: orders of missions driven in the order of time, and the dispatcher of the field. The C++ extension drives them
(extensions/fleet/route_driver.hpp)."""

from __future__ import annotations

from collections.abc import Sequence

from .. import _core
from ._problem import Drive, Problem, Schedule, Step, Visit

Row = tuple[int, int, int, int, tuple[int, int, int, int] | None]  #: a step, with its visit


def account(problem: Problem, routes: Sequence[Sequence[Step]]) -> int:
    """The cost of timed routes."""
    return sum(route_cost(problem, r, route) for r, route in enumerate(routes))


def route_cost(problem: Problem, r: int, route: Sequence[Step]) -> int:
    """Mean energy with standby, lateness and use of a robot's timed route."""
    if not route:
        return 0
    robot, place, cost, end = problem.robots[r], problem.robots[r].start, problem.robots[r].use_price, 0
    for step in route:
        mission = problem.missions[step.mission]
        if step.visit:
            dock = problem.chargers[step.visit.charger].place
            cost, place = cost + problem.ways[robot.type, place, dock][0].motion, dock
        speed = mission.drives[robot.type][step.speed]
        cost += problem.ways[robot.type, place, mission.first][step.way].motion + speed.motion
        end = step.start_s + speed.duration_s
        cost += mission.late_price * max(0, end - mission.due_s)
        place = mission.last
    return cost + problem.types[robot.type].standby * (end - robot.from_s)


class Routing:
    """A fleet as the C++ extension reads it: places, types, robots and missions by number."""

    def __init__(self, problem: Problem) -> None:
        self.problem, types = problem, range(len(problem.types))
        names = sorted({place for _, a, b in problem.ways for place in (a, b)} | {x.start for x in problem.robots})
        at, likes = {name: n for n, name in enumerate(names)}, {}  # type: dict[str, int], dict[tuple[object, ...], int]
        self.value = _core.RoutingProblem(
            len(names), [(x.capacity, x.reserve, x.standby) for x in problem.types],
            [(x.type, at[x.start], x.level, x.from_s, x.to_s, x.use_price, likes.setdefault(x.likeness(), len(likes)))
             for x in problem.robots],
            [(at[x.place], x.count, x.power, x.taper, [x.knee(kind) for kind in problem.types]) for x in problem.chargers],
            [(at[x.first], at[x.last], x.ready_s, x.due_s, x.late_price, list(x.robots), [_rows(x.drives.get(t, ())) for t in types])
             for x in problem.missions],
            [_rows(problem.ways.get((t, a, b), ())) for t in types for a in names for b in names], list(problem.busy))

    def drive(self, orders: Sequence[Sequence[int]]) -> Schedule | None:
        """Robots drive their missions in a given order and charge when the next one would not leave them the way to a charger, with
        standby for a wait there: the cheapest of several waits. None where a battery or a shift ends."""
        return self.schedule(self.value.drive([list(order) for order in orders]))

    def dispatch(self, low: float = 0.2, high: float = 0.9) -> Schedule | None:
        """The dispatcher of the field: the next mission goes to the nearest robot that is free; below 20 % it charges until 90 %."""
        return self.schedule(self.value.dispatch(low, high))

    def inserted(self) -> list[list[int]]:
        """Orders of missions by insertion where they cost least, from the one that is due first on."""
        return self.value.inserted()

    def search(self, start: Schedule, seed: int, rounds: int) -> _core.OrderSearch:
        """A simulated annealing over orders, from those of a schedule. Its ``advance(rounds)`` gives what ``schedule`` reads."""
        orders = [[step.mission for step in route] for route in start.routes]
        return _core.OrderSearch(self.value, orders, start.cost, seed, rounds)

    def schedule(self, rows: Sequence[Sequence[Row]] | None) -> Schedule | None:
        """Routes of the extension with their cost, recomputed."""
        if rows is None:
            return None
        routes = tuple(tuple(Step(m, way, speed, start_s, Visit(*visit) if visit else None) for m, way, speed, start_s, visit in route)
                       for route in rows)
        return Schedule(routes, account(self.problem, routes))


def _rows(drives: Sequence[Drive]) -> list[tuple[int, int, int]]:
    return [(d.duration_s, d.motion, d.upper) for d in drives]
