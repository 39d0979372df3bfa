"""A fleet's constraint program, solved from a known schedule."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from ortools.sat.python import cp_model

from ._alone import Leg, Sets, sets_of, untimed_bound
from ._model import FleetModel
from ._problem import NEVER, Problem, Schedule, Step, Visit
from ._routes import account

NEARER = 0.01  #: share of a bound by which the next cost is higher, below which sets are looked for
LABELS_PER_S = 40_000  #: of the limit
TIMING = 1.0  #: deterministic time for the times of known routes


def _in_order(f: FleetModel, schedule: Schedule) -> Schedule:
    """The schedule with the routes of equal robots in the model's order."""
    routes = list(schedule.routes)
    for group in f.problem.equals():
        for r, route in zip(group, sorted((routes[r] for r in group), key=lambda route: min((x.mission for x in route), default=NEVER))):
            routes[r] = route
    return replace(schedule, routes=tuple(routes))


def _hint(f: FleetModel, schedule: Schedule) -> None:
    """Starts the search at a schedule."""
    m = f.model
    for r, route in enumerate(_in_order(f, schedule).routes):
        m.add_hint(f.unused[r], not route)
        node = f.nodes[r]
        for step in route:
            for other in f.robots:
                if other in f.assigned[step.mission]:
                    m.add_hint(f.assigned[step.mission][other], other == r)
            for (i, j, t, c, k), literal in f.taken.items():
                if j == step.mission:
                    at = step.visit.charger if step.visit else -1
                    m.add_hint(literal, (i, t, c, k) == (node.index, f.problem.robots[r].type, at, step.way))
            for (t, k), literal in f.speed[step.mission].items():
                m.add_hint(literal, (t, k) == (f.problem.robots[r].type, step.speed))
            m.add_hint(f.start[step.mission], step.start_s)
            if step.visit:
                for variable, value in ((node.begin, step.visit.from_s), (node.done, step.visit.to_s),
                                        (node.charge, step.visit.to_s - step.visit.from_s),
                                        (node.target, step.visit.target)):
                    m.add_hint(variable, value)
            node = f.nodes[len(f.robots) + step.mission]


def _schedule(f: FleetModel, solver: Any) -> Schedule:
    """The routes of a solution."""
    after: dict[int, tuple[int, Step]] = {}
    for (i, j, t, c, k), literal in f.taken.items():
        if not solver.boolean_value(literal):
            continue
        node: Any = f.nodes[i]
        visit = None if c < 0 else Visit(c, solver.value(node.begin), solver.value(node.done), solver.value(node.target))
        speed = next(s for (u, s), v in f.speed[j].items() if solver.boolean_value(v))
        after[i] = (len(f.robots) + j, Step(j, k, speed, solver.value(f.start[j]), visit))
    routes = []
    for r in f.robots:
        route, node_index = [], r
        while node_index in after:
            node_index, step = after[node_index]
            route.append(step)
        routes.append(tuple(route))
    return Schedule(tuple(routes), round(solver.objective_value), round(solver.best_objective_bound))


class _Progress(cp_model.CpSolverSolutionCallback):
    def __init__(self, tell: Any, stop: Any) -> None:
        super().__init__()
        self._tell, self._stop = tell, stop

    def on_solution_callback(self) -> None:
        self._tell(round(self.objective_value), round(self.best_objective_bound))
        if self._stop():
            self.stop_search()


def _narrowed(problem: Problem, start: Schedule, seed: int, labels: int, stop: Callable[[], bool]) -> tuple[Schedule, Sets | None, int]:
    """The start or a cheaper schedule; sets of missions of schedules that are no dearer, None: too many to tell; and a bound.

    Sets are looked for below costs that rise from a bound: the first ones make a schedule whose queues alone can make it dearer.
    """
    low = untimed_bound(problem)
    most, division, sets = low, start.cost, None  # type: int, int, Sets | None
    while low < start.cost and most < start.cost and not stop():
        most = start.cost if sets and sets.routes else min(division, math.ceil(low * (1 + NEARER)))
        sets = sets_of(problem, most, sets.least if sets else None, labels)
        if sets is None:
            return start, None, low
        labels = sets.labels
        low, division = max(low, min(sets.bound, most + 1)), min(division, sets.bound)
        better = _timed(problem, sets.routes, seed) if sets.routes else None
        start = better if better is not None and better.cost < start.cost else start
    return start, sets if most >= start.cost else None, low


def _timed(problem: Problem, routes: Sequence[Sequence[Leg]], seed: int) -> Schedule | None:
    """The cheapest times of routes."""
    ordered = list(routes)
    for group in problem.equals():
        for r, route in zip(group, sorted((ordered[r] for r in group), key=lambda x: min((leg[0] for leg in x), default=NEVER))):
            ordered[r] = route
    fleet, solver = FleetModel(problem, routes=ordered), cp_model.CpSolver()
    solver.parameters.random_seed, solver.parameters.num_workers, solver.parameters.max_deterministic_time = seed, 1, TIMING
    if solver.solve(fleet.model) not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    found = _schedule(fleet, solver)
    return replace(found, cost=account(problem, found.routes), bound=0)


def solve(problem: Problem, *, seed: int = 1, workers: int = 8, limit: float = 120.0, start: Schedule | None = None,
          tell: Any = None, stop: Any = None, relative_gap: float = 0.0, takes_sigint: bool = True) -> tuple[str, Schedule | None]:
    """The cheapest schedule: ``optimal``, ``feasible``, ``infeasible`` or ``unknown``, and the schedule.

    ``limit``: deterministic time of CP-SAT, in its seconds. ``workers`` interleave, so that the same seed, workers and limit give the
    same schedule. ``tell(cost, bound)`` is called for each better schedule; ``stop()`` ends the search; so does SIGINT with
    ``takes_sigint``.
    """
    sets, low = None, 0
    if start is not None:
        start, sets, low = _narrowed(problem, start, seed, round(limit * LABELS_PER_S), stop or (lambda: False))
        if low >= start.cost:
            return "optimal", replace(start, bound=start.cost, proven=True)
    fleet = FleetModel(problem, None if start is None else start.cost, sets)
    low = max(low, fleet.low)
    if start is not None:
        if low >= start.cost:
            return "optimal", replace(start, bound=start.cost, proven=True)
        _hint(fleet, start)
    solver = cp_model.CpSolver()
    solver.parameters.random_seed = seed
    solver.parameters.num_workers = workers
    solver.parameters.interleave_search = workers > 1
    solver.parameters.max_deterministic_time = limit
    solver.parameters.relative_gap_limit = relative_gap
    solver.parameters.catch_sigint_signal = takes_sigint
    status = solver.solve(fleet.model, _Progress(tell or (lambda *_: None), stop or (lambda: False)))
    if status == cp_model.INFEASIBLE:
        return "infeasible", None
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return ("unknown", None) if start is None else ("feasible", replace(start, bound=low))
    found = _schedule(fleet, solver)
    cost = account(problem, found.routes)  # a schedule that is not proven may have slack in its variables
    proven = status == cp_model.OPTIMAL and cost == found.cost
    return "optimal" if proven else "feasible", Schedule(found.routes, cost, min(max(found.bound, low), cost), proven)
