"""A lower bound of a large fleet's cost: each robot drives a route of its own over time, missions are paid for.

Lagrangian relaxation of "each mission is driven once" [Fisher1981]: a mission pays a price to each robot that drives it. The bound is
the sum of all prices and of each robot's cheapest route at these prices; subgradient steps raise it. A route is cheapest over
(mission, start in steps of time): it keeps windows, start places, waiting, lateness and use, and may drive a mission again, but not
directly after the one that follows it. Its times are never later and its costs never higher than those of the route that it stands
for: times are rounded down, all speeds but the cheapest are one that is as quick and as cheap as any of them, charges are left out.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from ortools.linear_solver import pywraplp

from ._problem import NEVER, Problem

STEP_S, MOST_STEPS = 10, 1000  #: of time, where no mission with the way to the next one is shorter
MOST_MISSIONS = 100  #: of a fleet that this is tried for: one round for 200 missions takes seconds
BEYOND_S = 300  #: routes end so long after the last due time; prices are low enough that no later mission is worth its lateness
STEPS, PATIENCE = 0.5, 4  #: share of the gap that a step is for; rounds without a better bound, after which it is halved
FAR = 1e15
Array = Any


class _Kind:
    """Robots of one type: costs and times of missions and of ways between them."""

    def __init__(self, problem: Problem, t: int, latest_s: int) -> None:
        self.problem, self.t, self.standby = problem, t, problem.types[t].standby
        self.robots = [r for r, x in enumerate(problem.robots) if x.type == t]
        self.mine = _driven_by(problem, t)
        missions = [problem.missions[m] for m in self.mine]
        own = np.array([_two([(d.duration_s, d.motion) for d in x.drives[t]]) for x in missions])  # mission, speed, (time, cost)
        way = np.array([[self.way(a.last, b.first) for b in missions] for a in missions])
        self.own_s, self.own_cost = own[:, :, 0].min(axis=1), (own[:, :, 1] + self.standby * own[:, :, 0]).min(axis=1)
        self.way_cost = (way[:, :, :, 1] + self.standby * way[:, :, :, 0]).min(axis=2)
        self.onward = [own[:, None, speed] + way[:, :, way_speed] for speed in range(2) for way_speed in range(2)]
        self.onward = self.onward if (own[:, 0] != own[:, 1]).any() or (way[:, :, 0] != way[:, :, 1]).any() else self.onward[:1]
        others = ~np.eye(len(missions), dtype=bool)
        self.step_s = int(min(max(STEP_S, latest_s // MOST_STEPS), min(x[others, 0].min(initial=FAR) for x in self.onward)))
        self.steps = latest_s // max(1, self.step_s) + 1
        self.forward = [(x[:, :, 0] // max(1, self.step_s)).astype(int) for x in self.onward]
        self.ready = np.array([x.ready_s for x in missions], dtype=int) // max(1, self.step_s)
        price, due_s = (np.array([getattr(x, name) for x in missions], dtype=float) for name in ("late_price", "due_s"))
        starts_s = max(1, self.step_s) * np.arange(self.steps)
        self.late = price[:, None] * np.maximum(0.0, starts_s[None, :] + self.own_s[:, None] - due_s[:, None])

    def way(self, a: str, b: str) -> list[tuple[int, int]]:
        """Direct, or by a charger where that is shorter or cheaper."""
        ways, t = self.problem.ways, self.t
        found = [(d.duration_s, d.motion) for d in ways[t, a, b]]
        for place in {c.place for c in self.problem.chargers}:
            found += [(x.duration_s + y.duration_s, x.motion + y.motion) for x in ways[t, a, place] for y in ways[t, place, b]]
        return _two(found)

    def routes(self, prices: Array) -> list[tuple[float, list[int]]]:
        """Of each robot: the least cost of a route less its prices, and the route; (0, []) where it stays."""
        to_go = self._to_go(prices[self.mine])
        return [self._from_start(r, to_go) for r in self.robots]

    def _to_go(self, prices: Array) -> tuple[Array, Array, Array]:
        """Least costs from each mission's start at each step on, shape (2, steps, missions): with the best follower, and with the best of
        all others; these followers (-1: none), and the step of their starts."""
        shape = (2, self.steps, len(self.mine))
        best, follower, begins = np.full(shape, FAR), np.full(shape, -1), np.zeros(shape, dtype=int)
        for step in range(self.steps - 1, -1, -1):
            costs, steps = zip(*(self._onward(step, speed, best, follower) for speed in range(len(self.onward))))
            which = np.argmin(costs, axis=0)[None]
            cost, to = (np.take_along_axis(np.array(x), which, axis=0)[0] for x in (costs, steps))
            own = self.late[:, step] - prices
            self._keep_two(cost, to, own, best[:, step], follower[:, step], begins[:, step])
        return best, follower, begins

    def _onward(self, step: int, speed: int, best: Array, follower: Array) -> tuple[Array, Array]:
        """Least costs from each mission's start in a step on by each follower, and the step of its start."""
        columns, rows = np.arange(len(self.mine))[None, :], np.arange(len(self.mine))[:, None]
        to = np.maximum(step + self.forward[speed], self.ready[None, :])
        at = np.minimum(to, self.steps - 1)
        place = at * len(self.mine) + columns
        ahead = np.where(follower[0].take(place) == rows, best[1].take(place), best[0].take(place))
        cost = self.onward[speed][:, :, 1] + self.standby * self.step_s * (to - step) + ahead
        return np.where((to < self.steps) & (columns != rows), cost, FAR), at

    def _keep_two(self, cost: Array, to: Array, own: Array, best: Array, follower: Array, begins: Array) -> None:
        """The two cheapest of all followers and of none."""
        rows, ends = np.arange(len(cost)), self.own_cost
        for k in range(2):
            least = cost.argmin(axis=1)
            stays = ends <= cost[rows, least]
            best[k] = np.where(stays, ends, cost[rows, least]) + own
            follower[k], begins[k] = np.where(stays, -1, least), to[rows, least]
            cost[rows[~stays], least[~stays]] = FAR
            ends = np.where(stays, FAR, ends)

    def _from_start(self, r: int, to_go: tuple[Array, Array, Array]) -> tuple[float, list[int]]:
        robot, missions = self.problem.robots[r], [self.problem.missions[m] for m in self.mine]
        ways = np.array([self.way(robot.start, x.first) for x in missions])
        to = np.maximum((robot.from_s + ways[:, :, 0]) // self.step_s, self.ready[:, None])
        at = np.minimum(to, self.steps - 1)
        cost = robot.use_price + ways[:, :, 1] + self.standby * np.maximum(0, self.step_s * to - robot.from_s)
        cost = cost + to_go[0][0][at, np.arange(len(missions))[:, None]]
        cost = np.where(np.array([r in x.robots for x in missions])[:, None] & (to < self.steps), cost, FAR)
        m, speed = np.unravel_index(cost.argmin(), cost.shape)
        return (float(cost[m, speed]), self._followed(int(m), int(at[m, speed]), to_go)) if cost[m, speed] < 0 else (0.0, [])

    def _followed(self, m: int, step: int, to_go: tuple[Array, Array, Array]) -> list[int]:
        """The route from a mission's start on."""
        (_, follower, begins), route, before = to_go, [self.mine[m]], -1
        while True:
            k = 1 if follower[0, step, m] == before and before >= 0 else 0
            after = int(follower[k, step, m])
            if after < 0:
                return route
            before, m, step = m, after, int(begins[k, step, m])
            route.append(self.mine[m])


def _two(options: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Of drives (time, cost): the cheapest, and one that is as quick and as cheap as any of those that are quicker."""
    cheapest = min(options, key=lambda x: (x[1], x[0]))
    quicker = [x for x in options if x[0] < cheapest[0]]
    return [cheapest, (min(x[0] for x in quicker), min(x[1] for x in quicker)) if quicker else cheapest]


def _driven_by(problem: Problem, t: int) -> list[int]:
    """Missions that robots of a type may drive."""
    return [m for m, x in enumerate(problem.missions) if any(problem.robots[r].type == t for r in x.robots)]


def relaxed_bound(problem: Problem, most: int, rounds: int, stop: Callable[[], bool] = lambda: False) -> int:
    """The bound after so many subgradient steps towards a known cost; 0 for too many missions, and where missions and ways are too
    short for the time that they span: a round would take seconds."""
    if len(problem.missions) > MOST_MISSIONS:
        return 0
    last_s = max((x.due_s for x in problem.missions if x.due_s < NEVER), default=0)
    latest_s = max([last_s, *(x.ready_s for x in problem.missions), *(x.from_s for x in problem.robots)]) + BEYOND_S
    kinds = [_Kind(problem, t, latest_s) for t in range(len(problem.types)) if _driven_by(problem, t)]
    if any(kind.step_s < 1 or kind.steps > 4 * MOST_STEPS for kind in kinds):
        return 0
    ceiling = _ceiling(problem, kinds)
    prices, found, best_prices, scale, waited = np.minimum(_first(problem, kinds), ceiling), 0.0, None, STEPS, 0
    for _ in range(rounds):
        if stop():
            break
        routes = [route for kind in kinds for route in kind.routes(prices)]
        low = float(prices.sum() + sum(cost for cost, _ in routes))
        waited += 1
        if low > found or best_prices is None:
            found, best_prices, waited = max(found, low), prices, 0
        elif waited > PATIENCE:
            prices, scale, waited = best_prices, scale / 2, 0
            continue
        lack = 1.0 - np.bincount([m for _, route in routes for m in route], minlength=len(prices))
        if not lack.any():
            break
        prices = np.minimum(prices + scale * max(1.0, most - low) / float(lack @ lack) * lack, ceiling)
    return int(found)


def _least(problem: Problem, kinds: list[_Kind], cost: Callable[[_Kind], Array]) -> Array:
    """Of each mission, the least of a cost over the types."""
    found = np.full(len(problem.missions), FAR)
    for kind in kinds:
        found[kind.mine] = np.minimum(found[kind.mine], kind.own_cost + cost(kind))
    return found


def _ceiling(problem: Problem, kinds: list[_Kind]) -> Array:
    """At these prices no mission after the last step is worth what it costs."""
    return _least(problem, kinds, lambda kind: kind.late[:, -1])


def _first(problem: Problem, kinds: list[_Kind]) -> Array:
    """A mission's own least cost, and its prices as one that follows and as one that is followed, in the cheapest assignment of ways:
    with them the bound is that assignment's, but for the rounding of times."""
    own, ways = _least(problem, kinds, lambda _: np.zeros(1)), _ways(problem, kinds)
    solver = pywraplp.Solver.CreateSolver("GLOP")
    arcs = {(i, j): solver.NumVar(0, 1, "") for i, j in zip(*np.nonzero(ways < FAR))}
    rows, columns = ([solver.Constraint(low, 1) for _ in range(count)] for low, count in ((0, len(ways)), (1, len(own))))
    for (i, j), arc in arcs.items():
        solver.Objective().SetCoefficient(arc, ways[i, j])
        rows[i].SetCoefficient(arc, 1)
        columns[j].SetCoefficient(arc, 1)
    if solver.Solve() != pywraplp.Solver.OPTIMAL:
        return own
    robots = len(problem.robots)
    return own + np.array([columns[m].dual_value() + rows[robots + m].dual_value() for m in range(len(own))])


def _ways(problem: Problem, kinds: list[_Kind]) -> Array:
    """The least cost of each way to a mission, from robots' starts and missions' ends; ``FAR``: none."""
    robots, missions = len(problem.robots), len(problem.missions)
    found = np.full((robots + missions, missions), FAR)
    for kind in kinds:
        mine = np.array(kind.mine)
        grid = np.ix_(robots + mine, mine)
        found[grid] = np.minimum(found[grid], np.where(np.eye(len(mine), dtype=bool), FAR, kind.way_cost))
        for r in kind.robots:
            for m in kind.mine:
                if r in problem.missions[m].robots:
                    way = min(cost + kind.standby * time for time, cost in kind.way(problem.robots[r].start, problem.missions[m].first))
                    found[r, m] = way + problem.robots[r].use_price
    return found
