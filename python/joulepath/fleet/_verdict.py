"""Why a fleet cannot be planned, and the smallest help that works: each is tried by planning the helped fleet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from ._problem import NEVER, UNITS_PER_J, Charger, Mission, Problem, Schedule


def helps(source: Any, *, seed: int, workers: int, limit: float) -> list[dict[str, Any]]:
    """The helps that work, each alone: a larger battery, a charger more, a robot more, a later end of the shifts."""
    problem: Problem = source.problem

    def works(helped: Problem) -> bool:
        return found(helped, seed=seed, workers=workers, limit=limit) is not None

    tries: list[dict[str, Any]] = []
    everyone = range(len(problem.robots))
    more_J = _least(lambda joules: works(_with_energy(problem, joules)), 1000.0, 3.6e6)
    if more_J is not None:
        tries.append({"help": "energy", "more_J": more_J, "says": f"{more_J / 3600:.3g} Wh more in each battery at the start"})
    if any(problem.robots[r].to_s < NEVER for r in everyone):
        later_s = _least(lambda s: works(replace(problem, robots=tuple(replace(x, to_s=min(NEVER, x.to_s + round(s)))
                                                                       for x in problem.robots))), 60.0, 86400.0)
        if later_s is not None:
            tries.append({"help": "shift", "later_s": later_s, "says": f"shifts that end {later_s / 60:.3g} min later"})
    for r in everyone:
        again = replace(problem.robots[r], name=problem.robots[r].name + " again")
        if works(_with_robot(problem, again, r)):
            tries.append({"help": "robot", "like": problem.robots[r].name, "says": f"one robot more like {problem.robots[r].name}"})
            break
    tries += _charger_helps(problem, works)
    return tries


def reason_of(source: Any, *, seed: int, workers: int, limit: float) -> dict[str, Any] | None:
    """A mission without which the fleet can be planned, or that no robot can drive alone; None: there is no single one."""
    problem: Problem = source.problem
    for mission in problem.missions:
        alone = replace(problem, missions=(mission,))
        if found(alone, seed=seed, workers=workers, limit=limit) is None:
            return {"mission": mission.name, "robots": [problem.robots[r].name for r in mission.robots],
                    "says": f"no robot can drive {mission.name}, even alone, above its reserve and in its shift"}
    for m, mission in enumerate(problem.missions):
        rest = problem.missions[:m] + problem.missions[m + 1:]
        if rest and found(replace(problem, missions=rest), seed=seed, workers=workers, limit=limit) is not None:
            return {"mission": mission.name, "robots": [problem.robots[r].name for r in mission.robots],
                    "says": f"without {mission.name} the fleet can be planned"}
    return None


def found(problem: Problem, *, seed: int, workers: int, limit: float) -> Schedule | None:
    """Any schedule."""
    from ._solve import solve

    return solve(problem, seed=seed, workers=workers, limit=limit, relative_gap=1.0)[1]


def _charger_helps(problem: Problem, works: Callable[[Problem], bool]) -> list[dict[str, Any]]:
    for c, charger in enumerate(problem.chargers):
        more = replace(charger, count=charger.count + 1)
        if works(replace(problem, chargers=problem.chargers[:c] + (more,) + problem.chargers[c + 1:])):
            return [{"help": "charger", "station": charger.place, "says": f"one charger more at {charger.place}"}]
    if problem.chargers:
        return []
    starts = {r.start for r in problem.robots}
    for place in sorted({x.first for x in problem.missions}):  # places that the table knows from everywhere
        pairs = [(t, a, place) for t in range(len(problem.types)) for a in {x.last for x in problem.missions} | starts]
        if all(pair in problem.ways for pair in pairs) and all((t, place, x.first) in problem.ways for t in range(len(problem.types))
                                                               for x in problem.missions):
            at = Charger(place, 1, 200 * UNITS_PER_J, 200 * UNITS_PER_J)
            if works(replace(problem, chargers=(at,))):
                return [{"help": "charger", "station": place, "power_W": 200, "says": f"a charger of 200 W at {place}"}]
    return []


def _with_energy(problem: Problem, joules: float) -> Problem:
    more = round(UNITS_PER_J * joules)
    types = tuple(replace(kind, capacity=kind.capacity + more) for kind in problem.types)
    return replace(problem, types=types, robots=tuple(replace(r, level=r.level + more) for r in problem.robots))


def _with_robot(problem: Problem, robot: Any, like: int) -> Problem:
    def allowed(mission: Mission) -> Mission:
        return replace(mission, robots=(*mission.robots, len(problem.robots))) if like in mission.robots else mission

    return replace(problem, robots=(*problem.robots, robot), missions=tuple(map(allowed, problem.missions)))


def _least(works: Callable[[float], bool], start: float, most: float) -> float | None:
    """The least amount that works, within 5 %; None: not even the most does."""
    high = start
    while not works(high):
        if high >= most:
            return None
        high = min(most, 4 * high)
    low = 0.0 if high == start else high / 4
    while high - low > 0.05 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if works(middle) else (middle, high)
    return high
