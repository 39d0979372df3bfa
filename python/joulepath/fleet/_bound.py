"""A lower bound of every schedule's cost: an assignment of predecessors, and the energy that must be bought. With a known
schedule's cost it tells what no cheaper one contains."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from ortools.graph.python import linear_sum_assignment

from ._problem import NEVER, Drive, Problem, RobotType

Price = Callable[[Drive, RobotType], int]
Arc = tuple[int, int]  #: node, mission; nodes are robots' starts, then missions' ends
FAR = 10**15  #: a price that no schedule has


def bound(problem: Problem) -> int:
    """Each mission follows one robot's start or one other mission, and each of these has one successor: the cheapest
    assignment of ways, with missions at their cheapest speeds, standby of the time that both take, unavoidable lateness, and
    standby of the time that chargers need for the energy that the batteries lack. There are two such bounds: one counts all
    batteries together, the other one those of the robots that drive. The higher one holds."""
    return max(_cheapest(problem, _prices(problem, drive_cost, _uses(problem))) + _beside_ways(problem), _charging_bound(problem))


def _charging_bound(problem: Problem) -> int:
    """A robot that needs more energy than its battery holds charges the difference. A unit of it costs ``standby / power`` at least,
    its rate. The bound prices the need of each drive so, and subtracts the battery of each robot that drives."""
    rates = {kind: kind.standby / power if (power := _power(problem, kind)) > 0 else 0.0 for kind in problem.types}

    def price(d: Drive, kind: RobotType) -> int:
        return drive_cost(d, kind) + int(rates[kind] * _need(d, kind))

    starts = [r.use_price - math.ceil(rates[problem.kind(k)] * (r.level - problem.kind(k).reserve)) for k, r in enumerate(problem.robots)]
    return _cheapest(problem, _prices(problem, price, starts)) + _driving(problem, price) + _late(problem)


def _power(problem: Problem, kind: RobotType) -> int:
    """That a charger gives beyond a robot's standby."""
    return max((c.power - kind.standby for c in problem.chargers), default=0)


def _uses(problem: Problem) -> list[int]:
    return [r.use_price for r in problem.robots]


def _late(problem: Problem) -> int:
    return sum(late_cost(problem, m) for m in range(len(problem.missions)))


def drive_cost(d: Drive, kind: RobotType) -> int:
    return d.motion + kind.standby * d.duration_s


def _need(d: Drive, kind: RobotType) -> int:
    return d.upper + kind.standby * d.duration_s


def _beside_ways(problem: Problem) -> int:
    """Missions, charging and lateness."""
    need = _cheapest(problem, _prices(problem, _need, [0] * len(problem.robots))) + _driving(problem, _need)
    held = sum(r.level - problem.kind(k).reserve for k, r in enumerate(problem.robots))
    least = min(kind.standby for kind in problem.types)
    power = max(_power(problem, kind) for kind in problem.types)
    charging = least * max(0, need - held) // power if power > 0 else 0
    return _driving(problem, drive_cost) + charging + _late(problem)


def _driving(problem: Problem, price: Price) -> int:
    return sum(min(price(d, problem.types[t]) for t, drives in x.drives.items() for d in drives) for x in problem.missions)


def _prices(problem: Problem, price: Price, starts: list[int]) -> dict[Arc, int]:
    """The least price of each way from a node to a mission. ``starts``: prices of robots that drive."""
    prices: dict[Arc, int] = {}
    before: list[tuple[str, tuple[int, ...], int]] = [(r.start, (k,), starts[k]) for k, r in enumerate(problem.robots)]
    before += [(x.last, x.robots, 0) for x in problem.missions]
    for i, (place, robots, extra) in enumerate(before):
        for j, mission in enumerate(problem.missions):
            types = {problem.robots[r].type for r in robots if r in mission.robots}
            if types and i != len(problem.robots) + j:
                prices[i, j] = extra + min(way_cost(problem, t, place, mission.first, price) for t in types)
    return prices


def _cheapest(problem: Problem, prices: dict[Arc, int], forced: Arc | None = None) -> int:
    """The least price of a way to each mission, from each node at most once; 0 where there is none, ``FAR`` with a forced way."""
    robots, missions = len(problem.robots), len(problem.missions)
    arcs = [(i, j, p) for (i, j), p in prices.items() if forced is None or (i, j) == forced or (i != forced[0] and j != forced[1])]
    arcs += [(i, missions + n, 0) for i in range(robots + missions) for n in range(robots) if forced is None or i != forced[0]]
    table, solver = np.array(arcs, dtype=np.int64), linear_sum_assignment.SimpleLinearSumAssignment()
    solver.add_arcs_with_cost(table[:, 0].astype(np.int32), table[:, 1].astype(np.int32), table[:, 2])
    status = solver.solve()
    if status == solver.INFEASIBLE:
        return FAR if forced else 0
    if status != solver.OPTIMAL:  # prices are too large to add up
        return -FAR
    return int(solver.optimal_cost())


def way_cost(problem: Problem, t: int, a: str, b: str, price: Price) -> int:
    """Direct: by a charger is dearer where ways are no shorter than the direct one; the least of both is taken."""
    kind = problem.types[t]
    direct = min(price(d, kind) for d in problem.ways[t, a, b])
    return min([direct, *(_by_charger(problem, t, a, c, b, price) for c in range(len(problem.chargers)))])


def _by_charger(problem: Problem, t: int, a: str, c: int, b: str, price: Price) -> int:
    kind, dock = problem.types[t], problem.chargers[c].place
    return price(problem.ways[t, a, dock][0], kind) + price(problem.ways[t, dock, b][0], kind)


def late_cost(problem: Problem, m: int) -> int:
    """The price of a mission's lateness where a robot stands at its first stop already."""
    mission = problem.missions[m]
    return mission.late_price * max(0, _soonest(problem, m) - mission.due_s)


def _soonest(problem: Problem, m: int) -> int:
    mission = problem.missions[m]
    return min(max(mission.ready_s, problem.robots[r].from_s) + min(d.duration_s for d in mission.drives[problem.robots[r].type])
               for r in mission.robots)


class Limits:
    """What a schedule can contain that costs no more than a known one; everything without one.

    The bound of the cost with a way, a speed or a lateness forced is compared with the known cost.
    """

    def __init__(self, problem: Problem, most: int | None) -> None:
        self.problem, self.most = problem, most
        self.prices = _prices(problem, drive_cost, _uses(problem))
        rest = _beside_ways(problem)
        self.low = rest + _cheapest(problem, self.prices)
        self.forced = {arc: rest + (0 if most is None else _cheapest(problem, self.prices, arc)) for arc in self.prices}
        motion = _cheapest(problem, _prices(problem, lambda d, _: d.motion, _uses(problem))) + _driving(problem, lambda d, _: d.motion)
        self.present_s = NEVER  # of all robots together
        standby = min(kind.standby for kind in problem.types)
        if most is not None and standby > 0:
            self.present_s = min(NEVER, max(0, most - motion) // standby)

    def allows(self, extra: int) -> bool:
        return self.most is None or self.low + extra <= self.most

    def speed(self, m: int, t: int, k: int) -> bool:
        """Whether a mission may have a speed."""
        drives, kind = self.problem.missions[m].drives, self.problem.types[t]
        cheapest = min(drive_cost(d, self.problem.types[u]) for u, each in drives.items() for d in each)
        return self.allows(drive_cost(drives[t][k], kind) - cheapest)

    def way(self, arc: Arc, t: int, c: int, k: int) -> bool:
        """Whether a way from a node to a mission may be taken: at a speed, or by a charger, by a robot that may do both."""
        if arc not in self.prices or self.most is None:
            return arc in self.prices
        p, (i, j) = self.problem, arc
        count = len(p.robots)
        place, extra = (p.robots[i].start, p.robots[i].use_price) if i < count else (p.missions[i - count].last, 0)
        first = p.missions[j].first
        price = drive_cost(p.ways[t, place, first][k], p.types[t]) if c < 0 else _by_charger(p, t, place, c, first, drive_cost)
        return self.forced[arc] + extra + price - self.prices[arc] <= self.most

    def latest_end(self, m: int) -> int:
        """Of a mission, in whole seconds."""
        mission = self.problem.missions[m]
        if self.most is None or not mission.late_price:
            return NEVER
        unavoidable = max(0, _soonest(self.problem, m) - mission.due_s)
        return mission.due_s + unavoidable + max(0, self.most - self.low) // mission.late_price

    def soonest_start(self, m: int) -> int:
        """Of a mission: the way to it is driven after the first robot's begin."""
        p, mission = self.problem, self.problem.missions[m]
        places = {x.last for n, x in enumerate(p.missions) if n != m} | {x.place for x in p.chargers}
        starts = [max(mission.ready_s, r.from_s + self._way_s({r.start} | places, r.type, mission.first))
                  for n, r in enumerate(p.robots) if n in mission.robots]
        return min(starts)

    def _way_s(self, places: set[str], t: int, to: str) -> int:
        """The shortest of the ways to a place."""
        return min(d.duration_s for a in places if (t, a, to) in self.problem.ways for d in self.problem.ways[t, a, to])

    def way_to(self, m: int, t: int) -> tuple[int, int]:
        """Seconds and upper bound of the energy without standby, of the least way to a mission."""
        p, first = self.problem, self.problem.missions[m].first
        places = {x.last for n, x in enumerate(p.missions) if n != m and t in x.drives} | {x.place for x in p.chargers}
        places |= {r.start for r in p.robots if r.type == t}
        ways = [d for a in places if (t, a, first) in p.ways for d in p.ways[t, a, first]]
        return min(d.duration_s for d in ways), min(d.upper for d in ways)
