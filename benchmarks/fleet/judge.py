"""Judges of schedules that share no code with the model: every rule re-checked, and brute force over permutations."""

from __future__ import annotations

import functools
import itertools
import math
from typing import Callable, Iterator, NamedTuple

from joulepath.fleet._problem import Drive, Problem, Schedule


def faults(problem: Problem, schedule: Schedule) -> list[str]:
    """What is wrong with a schedule; empty: nothing. Recomputes times, levels and cost from the routes alone."""
    wrong: list[str] = []
    total, visits = 0, [(c, a, b) for c, a, b in problem.busy]
    driven = sorted(step.mission for route in schedule.routes for step in route)
    if driven != list(range(len(problem.missions))):
        wrong.append(f"missions driven: {driven}")
    for r, route in enumerate(schedule.routes):
        robot, kind = problem.robots[r], problem.types[problem.robots[r].type]
        place, clock, level = robot.start, robot.from_s, robot.level
        spent = 0
        for step in route:
            mission = problem.missions[step.mission]
            if r not in mission.robots:
                wrong.append(f"{robot.name} may not drive {mission.name}")
            if step.visit:
                charger = problem.chargers[step.visit.charger]
                way = problem.ways[robot.type, place, charger.place][0]
                level -= way.upper + kind.standby * (step.visit.from_s - clock)
                spent += way.motion
                if step.visit.from_s < clock + way.duration_s:
                    wrong.append(f"{robot.name} arrives late at its charger before {mission.name}")
                if level < kind.reserve:
                    wrong.append(f"{robot.name} arrives at its charger with {level - kind.reserve} below its reserve")
                if step.visit.target > kind.capacity:
                    wrong.append(f"{robot.name} charges to more than its battery holds")
                seconds = step.visit.to_s - step.visit.from_s
                if not _charges(charger.power - kind.standby, charger.taper - kind.standby, charger.knee_fraction * kind.capacity,
                                level, step.visit.target, seconds):
                    wrong.append(f"{robot.name} cannot charge from {level} to {step.visit.target} in {seconds} s")
                visits.append((step.visit.charger, step.visit.from_s, step.visit.to_s))
                place, clock, level = charger.place, step.visit.to_s, max(level, step.visit.target)
                if step.way:
                    wrong.append(f"{robot.name} leaves its charger before {mission.name} at speed {step.way}, not the cheapest")
            way = problem.ways[robot.type, place, mission.first][step.way]
            drive = mission.drives[robot.type][step.speed]
            if step.start_s < max(clock + way.duration_s, mission.ready_s):
                wrong.append(f"{mission.name} starts too early")
            end = step.start_s + drive.duration_s
            level -= way.upper + drive.upper + kind.standby * (end - clock)
            spent += way.motion + drive.motion
            if level < kind.reserve:
                wrong.append(f"{robot.name} ends {mission.name} with {level - kind.reserve} below its reserve")
            if end > robot.to_s:
                wrong.append(f"{robot.name} ends {mission.name} after its shift")
            total += mission.late_price * max(0, end - mission.due_s)
            place, clock = mission.last, end
        if route:
            total += spent + robot.use_price + kind.standby * (clock - robot.from_s)
    for c, charger in enumerate(problem.chargers):
        for _, at, _ in visits:
            if sum(a <= at < b for d, a, b in visits if d == c) > charger.count:
                wrong.append(f"too many robots at {charger.place} at {at} s")
    if total != schedule.cost:
        wrong.append(f"cost {schedule.cost}, recomputed {total}")
    return wrong


def _charges(fast: int, slow: int, knee: float, level: float, target: float, seconds: float) -> bool:
    """Whether a charge of so many seconds reaches the target: integrates the power from the level."""
    to_knee = max(0.0, (knee - level) / fast)
    reached = level + fast * seconds if seconds <= to_knee else max(level, knee) + slow * (seconds - to_knee)
    return reached >= target - 1 - 1e-6 * abs(target)


class Stop(NamedTuple):
    """A mission in a sequence, at the speeds of its way and of itself; with a charger on the way, or None."""

    mission: int
    way: int
    speed: int
    charger: int | None


class Driven(NamedTuple):
    cost: float  #: infinite where it cannot be driven
    visit: tuple[int, int] | None = None  #: begin, end


Sequence = tuple[Stop, ...]
NOWHERE = Driven(math.inf)


def least_cost(problem: Problem, below: float = math.inf) -> float:
    """The least cost of a small fleet, by brute force over assignments, orders, speeds and visits; infinite where nothing costs
    less than ``below``.

    At most one visit of each robot, chargers of one place. Each robot's sequences are costed alone; combinations of them are timed
    with all orders of their visits at the chargers.
    """
    sequences = [_sequences(problem, r, below) for r in range(len(problem.robots))]
    return _combined(problem, sequences, frozenset(range(len(problem.missions))), below)


def _rest(problem: Problem, r: int) -> Callable[[str, frozenset[int]], float]:
    """What no continuation of a robot's sequence costs less than, when the other robots drive the rest: a way to each mission, at the
    cheapest speeds, whenever, with full batteries."""
    robots = [r, *(other for other in range(len(problem.robots)) if other != r)]

    def price(t: int, d: Drive) -> float:
        return d.motion + problem.types[t].standby * d.duration_s

    @functools.cache
    def step(t: int, place: str, m: int) -> float:
        first, drives = problem.missions[m].first, problem.missions[m].drives[t]
        direct = min(price(t, way) for way in problem.ways[t, place, first])
        by = (price(t, problem.ways[t, place, c.place][0]) + price(t, problem.ways[t, c.place, first][0]) for c in problem.chargers)
        return min([direct, *by]) + min(price(t, d) for d in drives)

    @functools.cache
    def least(n: int, place: str, left: frozenset[int]) -> float:
        if not left:
            return 0.0
        mine = (m for m in left if robots[n] in problem.missions[m].robots)
        costs = [step(problem.robots[robots[n]].type, place, m) + least(n, problem.missions[m].last, left - {m}) for m in mine]
        if n + 1 < len(robots):
            costs.append(least(n + 1, problem.robots[robots[n + 1]].start, left))
        return min(costs, default=math.inf)

    return lambda place, left: least(0, place, left)


def _sequences(problem: Problem, r: int, below: float) -> dict[frozenset[int], list[tuple[float, Sequence]]]:
    """Of each set of missions: the robot's sequences and what they cost alone, from the cheapest to the first without a visit:
    that one waits for nobody. Sequences that are too dear, whatever the others do, are left out."""
    found: dict[frozenset[int], list[tuple[float, Sequence]]] = {frozenset(): [(0.0, ())]}
    everything, rest = frozenset(range(len(problem.missions))), _rest(problem, r)

    def extend(steps: Sequence, driven: frozenset[int]) -> None:
        for m in everything - driven:
            if r not in problem.missions[m].robots:
                continue
            after, later = driven | {m}, rest(problem.missions[m].last, everything - driven - {m})
            for stop in _stops(problem, r, steps, m):
                if (cost := _drive(problem, r, (*steps, stop), 0).cost) + later < below:
                    found.setdefault(after, []).append((cost, (*steps, stop)))
                    extend((*steps, stop), after)

    extend((), frozenset())
    return {key: _to_first_free(sorted(steps, key=lambda item: item[0])) for key, steps in found.items()}


def _stops(problem: Problem, r: int, steps: Sequence, m: int) -> Iterator[Stop]:
    """All ways and speeds of a robot's next mission; by a charger where it had no visit before."""
    t, mission = problem.robots[r].type, problem.missions[m]
    place = problem.missions[steps[-1].mission].last if steps else problem.robots[r].start
    visited = any(stop.charger is not None for stop in steps)
    ways: list[tuple[int, int | None]] = [(k, None) for k in range(len(problem.ways[t, place, mission.first]))]
    ways += [] if visited else [(0, c) for c in range(len(problem.chargers))]
    for (way, charger), speed in itertools.product(ways, range(len(mission.drives[t]))):
        yield Stop(m, way, speed, charger)


def _to_first_free(steps: list[tuple[float, Sequence]]) -> list[tuple[float, Sequence]]:
    free = next((n for n, (_, sequence) in enumerate(steps) if all(stop.charger is None for stop in sequence)), len(steps))
    return steps[:free + 1]


def _combined(problem: Problem, sequences: list[dict[frozenset[int], list[tuple[float, Sequence]]]], everything: frozenset[int],
              below: float) -> float:
    best = below

    @functools.cache
    def tail(r: int, left: frozenset[int]) -> float:
        """What robots from the r-th on cost at least, each alone."""
        if r == len(sequences):
            return math.inf if left else 0.0
        return min((steps[0][0] + tail(r + 1, left - key) for key, steps in sequences[r].items() if key <= left), default=math.inf)

    def choose(r: int, left: frozenset[int], cost: float, chosen: tuple[Sequence, ...]) -> None:
        nonlocal best
        if r == len(sequences):
            best = min(best, _timed(problem, chosen))
            return
        for key, steps in sequences[r].items():
            rest = tail(r + 1, left - key) if key <= left else math.inf
            for alone, sequence in steps:
                if cost + alone + rest >= best:
                    break
                choose(r + 1, left - key, cost + alone, (*chosen, sequence))

    choose(0, everything, 0.0, ())
    return best if best < below else math.inf


def _drive(problem: Problem, r: int, steps: Sequence, not_before: int) -> Driven:
    """A sequence whose visit begins at ``not_before`` or later and charges what the rest of the sequence needs: a charge costs
    time alone."""
    if not steps:
        return Driven(0.0)
    robot, kind = problem.robots[r], problem.types[problem.robots[r].type]
    place, clock, level, cost, visit = robot.start, robot.from_s, robot.level, float(robot.use_price), None
    for n, stop in enumerate(steps):
        if stop.charger is not None:
            way = problem.ways[robot.type, place, problem.chargers[stop.charger].place][0]
            begin = max(clock + way.duration_s, not_before)
            level -= way.upper + kind.standby * (begin - clock)
            if level < kind.reserve:
                return NOWHERE
            seconds = _charge_s(problem, r, steps[n:], begin, level)
            if seconds is None:
                return NOWHERE
            level = _reached(problem, robot.type, stop.charger, level, seconds)
            cost, visit = cost + way.motion, (begin, begin + seconds)
            place, clock = problem.chargers[stop.charger].place, begin + seconds
        price, place, clock, spent = _one(problem, r, place, clock, stop)
        cost, level = cost + price, level - spent
        if level < kind.reserve or clock > robot.to_s:
            return NOWHERE
    return Driven(cost + kind.standby * (clock - robot.from_s), visit)


def _one(problem: Problem, r: int, place: str, clock: int, stop: Stop) -> tuple[float, str, int, int]:
    """Cost, place, end and energy, standby included, of one mission with the way to it."""
    mission, kind = problem.missions[stop.mission], problem.robots[r].type
    way, drive = problem.ways[kind, place, mission.first][stop.way], mission.drives[kind][stop.speed]
    end = max(clock + way.duration_s, mission.ready_s) + drive.duration_s
    cost = way.motion + drive.motion + mission.late_price * max(0, end - mission.due_s)
    return cost, mission.last, end, way.upper + drive.upper + problem.types[kind].standby * (end - clock)


def _reached(problem: Problem, t: int, c: int, level: int, seconds: int) -> int:
    charger, kind = problem.chargers[c], problem.types[t]
    fast, slow, knee = charger.power - kind.standby, charger.taper - kind.standby, round(charger.knee_fraction * kind.capacity)
    to_knee = max(0.0, (knee - level) / fast)
    reached = level + fast * seconds if seconds <= to_knee else max(level, knee) + slow * (seconds - to_knee)
    return min(kind.capacity, math.floor(reached + 1e-6))


def _charge_s(problem: Problem, r: int, steps: Sequence, begin: int, level: int) -> int | None:
    """The shortest charge in whole seconds after which the level covers the steps; longer ones lower the need where a robot
    would wait. None: no charge does."""
    kind = problem.types[problem.robots[r].type]

    def covers(seconds: int) -> bool:
        place, clock = problem.chargers[steps[0].charger or 0].place, begin + seconds
        left = _reached(problem, problem.robots[r].type, steps[0].charger or 0, level, seconds) - kind.reserve
        for stop in steps:
            _, place, clock, spent = _one(problem, r, place, clock, stop)
            left -= spent
        return left >= 0

    low, high = 0, 1
    while not covers(high):
        low, high = high, 2 * high
        if high > 100_000:
            return None
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if covers(middle) else (middle, high)
    return 0 if covers(0) else high


def _timed(problem: Problem, chosen: tuple[Sequence, ...]) -> float:
    """The least cost of chosen sequences over all orders of their visits at each charger."""
    slots = [(r, stop.charger) for r, steps in enumerate(chosen) for stop in steps if stop.charger is not None]
    groups = [[r for r, c in slots if c == charger] for charger in range(len(problem.chargers))]
    return min(_in_order(problem, chosen, orders) for orders in itertools.product(*map(itertools.permutations, groups)))


def _in_order(problem: Problem, chosen: tuple[Sequence, ...], orders: tuple[tuple[int, ...], ...]) -> float:
    """Cost where the visits at each charger have an order: each begins when the one before it has ended."""
    driven = {r: _drive(problem, r, steps, 0) for r, steps in enumerate(chosen) if all(s.charger is None for s in steps)}
    for order in orders:
        clock = 0
        for r in order:
            driven[r] = _drive(problem, r, chosen[r], clock)
            if driven[r].visit is None:
                return math.inf
            clock = driven[r].visit[1]  # type: ignore[index]
    return sum(found.cost for found in driven.values())
