"""A lower bound of every schedule's cost: an assignment of predecessors, and the energy that must be bought."""

from __future__ import annotations

from collections.abc import Callable

from ortools.graph.python import linear_sum_assignment

from ._problem import Drive, Problem, RobotType

Price = Callable[[Drive, RobotType], int]


def bound(problem: Problem) -> int:
    """Each mission follows one robot's start or one other mission, and each of these has one successor: the cheapest
    assignment of ways, with missions at their cheapest speeds, standby of the time that both take, unavoidable lateness, and
    standby of the time that chargers need for the energy that the batteries lack."""
    cost = _assignment(problem, lambda d, kind: d.motion + kind.standby * d.duration_s, use=True)
    need = _assignment(problem, lambda d, kind: d.upper + kind.standby * d.duration_s, use=False)
    held = sum(r.level - problem.kind(k).reserve for k, r in enumerate(problem.robots))
    least = min(kind.standby for kind in problem.types)
    power = max((c.power - least for c in problem.chargers), default=0)
    charging = least * max(0, need - held) // power if power else 0
    return cost + charging + sum(_late(problem, m) for m in range(len(problem.missions)))


def _assignment(problem: Problem, price: Price, use: bool) -> int:
    missions, solver = range(len(problem.missions)), linear_sum_assignment.SimpleLinearSumAssignment()
    before: list[tuple[str, tuple[int, ...], int]] = [(r.start, (k,), r.use_price if use else 0) for k, r in enumerate(problem.robots)]
    before += [(x.last, x.robots, 0) for x in problem.missions]
    for i, (place, robots, extra) in enumerate(before):
        for j in missions:
            if i == len(problem.robots) + j:
                continue
            types = {problem.robots[r].type for r in robots if r in problem.missions[j].robots}
            if types:
                solver.add_arc_with_cost(i, j, extra + min(_way(problem, t, place, problem.missions[j].first, price) for t in types))
        for spare in range(len(problem.robots)):
            solver.add_arc_with_cost(i, len(problem.missions) + spare, 0)
    if solver.solve() != solver.OPTIMAL:
        return 0
    driving = (min(price(d, problem.types[t]) for t, drives in x.drives.items() for d in drives) for x in problem.missions)
    return int(solver.optimal_cost()) + sum(driving)


def _way(problem: Problem, t: int, a: str, b: str, price: Price) -> int:
    """Direct: by a charger is dearer where ways are no shorter than the direct one; the least of both is taken."""
    kind = problem.types[t]
    direct = min(price(d, kind) for d in problem.ways[t, a, b])
    by = (price(problem.ways[t, a, c.place][0], kind) + price(problem.ways[t, c.place, b][0], kind) for c in problem.chargers)
    return min([direct, *by])


def _late(problem: Problem, m: int) -> int:
    """The price of a mission's lateness where a robot stands at its first stop already."""
    mission = problem.missions[m]
    soonest = min(max(mission.ready_s, problem.robots[r].from_s) + min(d.duration_s for d in mission.drives[problem.robots[r].type])
                  for r in mission.robots)
    return mission.late_price * max(0, soonest - mission.due_s)
