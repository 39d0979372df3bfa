"""The search for a schedule: small fleets are proven, large ones improved in neighborhoods. Both have a bound."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import replace

from ._bound import bound
from ._solve import solve
from ._problem import UNITS_PER_J, Problem, Schedule, Step
from ._relaxed import relaxed_bound
from ._routes import Routing, account

SMALL = 16  #: missions of one constraint program
ROUNDS = 20_000  #: reinsertions before that program, whatever the limit is
MOVES_PER_S = 1_000_000  #: missions times reinsertions per second of the limit, which three quarters of it are for
CHUNK = 500  #: reinsertions between looks at ``stop``
BOUND_ROUNDS, BOUND_ROUNDS_PER_S = 60, 1 / 3  #: of the relaxation: for few missions, and per second of the limit for many
REPAIR = 0.5  #: deterministic time of one repair
Tell = Callable[[str], None]
Stop = Callable[[], bool]


def first_schedule(problem: Problem) -> Schedule | None:
    """The cheaper one of a greedy insertion and a dispatcher; None where both run out of energy or time."""
    routing = Routing(problem)
    found = [schedule for schedule in (routing.drive(routing.inserted()), routing.dispatch()) if schedule is not None]
    return min(found, key=lambda schedule: schedule.cost, default=None)


def search(problem: Problem, *, seed: int = 1, workers: int = 8, limit: float = 60.0, tell: Tell | None = None,
           stop: Stop | None = None) -> tuple[str, Schedule | None]:
    """``optimal``, ``feasible``, ``infeasible`` or ``unknown``, and the best schedule."""
    say, ended = tell or (lambda _: None), stop or (lambda: False)
    start = first_schedule(problem)
    if len(problem.missions) <= SMALL or start is None:
        if start is not None:
            start = rearranged(problem, start, seed, ROUNDS, ended)
        status, best = solve(problem, seed=seed, workers=workers, limit=limit, start=start, stop=ended,
                             tell=lambda cost, low: say(_line(cost, low)))
        if best is None and start is not None:
            status, best = "feasible", start
        return (status, best) if best is None or best.proven else _bounded(problem, best, BOUND_ROUNDS, ended)
    best = improve(problem, start, seed=seed, workers=workers, limit=limit, tell=say, stop=ended)
    status, best = _bounded(problem, best, math.ceil(BOUND_ROUNDS_PER_S * limit), ended)
    say(_line(best.cost, best.bound))
    return status, best


def _bounded(problem: Problem, best: Schedule, rounds: int, stop: Stop) -> tuple[str, Schedule]:
    """A schedule with the best of its bounds, and whether that proves it."""
    low = max(best.bound, bound(problem))
    low = min(best.cost, max(low, relaxed_bound(problem, best.cost, rounds, stop) if low < best.cost else 0))
    return ("optimal" if low >= best.cost else "feasible"), replace(best, bound=low, proven=low >= best.cost)


def _line(cost: float, low: float) -> str:
    return f"cost {cost / UNITS_PER_J:.1f} J, bound {low / UNITS_PER_J:.1f} J, gap {100 * (1 - low / max(cost, 1)):.2f} %"


def improve(problem: Problem, start: Schedule, *, seed: int, workers: int, limit: float, tell: Tell, stop: Stop) -> Schedule:
    """Large-neighborhood search: first, missions are taken out of routes and inserted anew; then CP-SAT plans the ends of two
    robots' routes anew, while all others stay."""
    chance, low = random.Random(seed), bound(problem)

    def news(schedule: Schedule) -> None:
        tell(_line(schedule.cost, low))

    news(start)
    best = rearranged(problem, start, seed, round(0.75 * limit * MOVES_PER_S / len(problem.missions)), stop, news)
    for _ in range(round(limit / 4 / REPAIR)):
        if stop():
            return best
        better = repaired(problem, best, chance, workers)
        if better.cost < best.cost:
            best = better
            news(best)
    return best


def rearranged(problem: Problem, start: Schedule, seed: int, rounds: int, stop: Stop,
               news: Callable[[Schedule], None] = lambda _: None) -> Schedule:
    """The best schedule of a simulated annealing over orders of missions (extensions/fleet/order_search.hpp)."""
    routing, best = Routing(problem), start
    annealing = routing.search(start, seed % 2**64, rounds)
    for _ in range(0, rounds, CHUNK):
        if stop():
            break
        better = routing.schedule(annealing.advance(CHUNK))
        if better is not None and better.cost < best.cost:
            best = better
            news(best)
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
