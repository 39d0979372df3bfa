"""The search for a schedule: small fleets are proven, large ones improved in neighborhoods. Both have a bound."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace

from ._bound import bound
from ._model import solve
from ._problem import UNITS_PER_J, Problem, Schedule, Step
from ._routes import account, dispatched, drive_orders, inserted, reinserted

SMALL = 16  #: missions of one constraint program
ROUNDS_PER_S = 25  #: reinsertions per second of the limit, which half of it is for
REPAIR = 0.5  #: deterministic time of one repair
Tell = Callable[[str], None]
Stop = Callable[[], bool]


def first_schedule(problem: Problem) -> Schedule | None:
    """The cheaper one of a regret insertion and a dispatcher; None where both run out of energy or time."""
    found = [schedule for schedule in (drive_orders(problem, inserted(problem)), dispatched(problem)) if schedule is not None]
    return min(found, key=lambda schedule: schedule.cost, default=None)


def search(problem: Problem, *, seed: int = 1, workers: int = 8, limit: float = 60.0, tell: Tell | None = None,
           stop: Stop | None = None) -> tuple[str, Schedule | None]:
    """``optimal``, ``feasible``, ``infeasible`` or ``unknown``, and the best schedule."""
    say, ended = tell or (lambda _: None), stop or (lambda: False)
    start = first_schedule(problem)
    if len(problem.missions) <= SMALL or start is None:
        status, best = solve(problem, seed=seed, workers=workers, limit=limit, start=start, stop=ended,
                             tell=lambda cost, low: say(_line(cost, low)))
        if best is None and start is not None:
            status, best = "feasible", start
        return status, best if best is None else replace(best, bound=max(best.bound, bound(problem)))
    low, best = bound(problem), improve(problem, start, seed=seed, workers=workers, limit=limit, tell=say, stop=ended)
    return ("optimal" if best.cost <= low else "feasible"), replace(best, bound=min(low, best.cost), proven=best.cost <= low)


def _line(cost: float, low: float) -> str:
    return f"cost {cost / UNITS_PER_J:.1f} J, bound {low / UNITS_PER_J:.1f} J, gap {100 * (1 - low / max(cost, 1)):.2f} %"


def improve(problem: Problem, start: Schedule, *, seed: int, workers: int, limit: float, tell: Tell, stop: Stop) -> Schedule:
    """Large-neighborhood search: first, missions are taken out of routes and inserted anew; then CP-SAT plans the ends of two
    robots' routes anew, while all others stay."""
    chance, low, best = random.Random(seed), bound(problem), start
    tell(_line(best.cost, low))
    orders = [[step.mission for step in route] for route in best.routes]
    for _ in range(round(ROUNDS_PER_S * limit / 2)):
        if stop():
            return best
        tried = reinserted(problem, orders, chance)
        found = drive_orders(problem, tried)
        if found is not None and found.cost < best.cost:
            best, orders = found, tried
            tell(_line(best.cost, low))
    for _ in range(round(limit / 2 / REPAIR)):
        if stop():
            return best
        better = repaired(problem, best, chance, workers)
        if better.cost < best.cost:
            best = better
            tell(_line(best.cost, low))
    return best


def repaired(problem: Problem, best: Schedule, chance: random.Random, workers: int) -> Schedule:
    """The ends of two routes, planned anew by CP-SAT from where the robots are then."""
    used = [r for r, route in enumerate(best.routes) if route]
    chosen = sorted(chance.sample(used, min(2, len(used))))
    count = chance.choice((3, 4, 5))
    heads = {r: best.routes[r][:max(0, len(best.routes[r]) - count)] for r in chosen}
    free = sorted(step.mission for r in chosen for step in best.routes[r][len(heads[r]):])
    part = _part(problem, best, chosen, heads, free)
    number = {m: n for n, m in enumerate(free)}
    here = tuple(tuple(replace(step, mission=number[step.mission]) for step in best.routes[r][len(heads[r]):]) for r in chosen)
    start = Schedule(here, account(part, here))
    _, found = solve(part, seed=chance.randrange(2**31), workers=workers, limit=REPAIR, start=start, takes_sigint=False)
    if found is None or found.cost >= start.cost:
        return best
    routes = list(best.routes)
    for k, r in enumerate(chosen):
        routes[r] = heads[r] + tuple(replace(step, mission=free[step.mission]) for step in found.routes[k])
    return Schedule(tuple(routes), account(problem, routes))


def _part(problem: Problem, best: Schedule, chosen: list[int], heads: dict[int, tuple[Step, ...]], free: list[int]) -> Problem:
    """The fleet of the chosen robots after their heads, with the others' visits as busy times of chargers."""
    robots = []
    for r in chosen:
        robot = problem.robots[r]
        place, clock, level = standing(problem, r, heads[r])
        robots.append(replace(robot, start=place, from_s=clock, level=level, use_price=0 if heads[r] else robot.use_price))
    visits = [step.visit for r, route in enumerate(best.routes) for step in (heads[r] if r in heads else route) if step.visit]
    missions = [replace(problem.missions[m], robots=tuple(chosen.index(r) for r in problem.missions[m].robots if r in chosen))
                for m in free]
    busy = tuple((v.charger, v.from_s, v.to_s) for v in visits if v.to_s > v.from_s)
    return replace(problem, robots=tuple(robots), missions=tuple(missions), busy=problem.busy + busy)


def standing(problem: Problem, r: int, route: tuple[Step, ...]) -> tuple[str, int, int]:
    """Place, time and lower bound of the level after a part of a robot's route."""
    robot, kind = problem.robots[r], problem.kind(r)
    place, clock, level = robot.start, robot.from_s, robot.level
    for step in route:
        mission = problem.missions[step.mission]
        if step.visit:
            place, clock, level = problem.chargers[step.visit.charger].place, step.visit.to_s, step.visit.target
        speed = mission.drives[robot.type][step.speed]
        end = step.start_s + speed.duration_s
        level -= problem.ways[robot.type, place, mission.first][step.way].upper + speed.upper + kind.standby * (end - clock)
        place, clock = mission.last, end
    return place, clock, level
