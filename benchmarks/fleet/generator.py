"""Seeded fleets with energies of a made-up floor, for the judges: no planner is needed for them."""

from __future__ import annotations

import dataclasses
import itertools
import math
import random

from joulepath.fleet._problem import NEVER, Charger, Drive, Mission, Problem, Robot, RobotType, drive, undominated


def _ways(chance: random.Random, places: dict[str, tuple[float, float]]) -> dict[tuple[int, str, str], tuple[Drive, ...]]:
    """Drives that differ by direction: an unequal detour, as racks and turns make them."""
    ways = {}
    for a, (xa, ya) in places.items():
        for b, (xb, yb) in places.items():
            way_m = (abs(xa - xb) + abs(ya - yb)) * chance.uniform(1.0, 1.15) + (0.0 if a == b else 2.0)
            ways[0, a, b] = (Drive(0, 0, 0),) if a == b else _speeds(way_m, 1.0)
    return ways


def _speeds(way_m: float, load: float, speeds: tuple[float, ...] = (0.7, 1.0)) -> tuple[Drive, ...]:
    return undominated([drive(way_m / v + 3, way_m * load * (28 + 14 * v * v), 0.03 * way_m * load * (28 + 14 * v * v), k)
                        for k, v in enumerate(speeds)])


def small(seed: int, robots: int = 4, missions: int = 12, chargers: int = 2, speeds: int = 2) -> Problem:
    """At most so many robots, missions and chargers; batteries are low enough that some robots must charge."""
    chance = random.Random(f"fleet {seed}")
    robots, missions = chance.randint(max(1, robots - 2), robots), chance.randint(max(1, missions - 4), missions)
    places = {f"p{i}": (chance.uniform(0, 40), chance.uniform(0, 25)) for i in range(10)}
    names = list(places)
    kind = RobotType(capacity=400_000, reserve=40_000, standby=100)
    count = min(chargers, chance.randint(1, 2)) if chargers else 0
    at = chance.sample(names, count)
    stations = tuple(Charger(p, 1, chance.choice((1500, 2500)), chance.choice((700, 1000)), chance.choice((0.7, 0.8))) for p in at)
    least, most = (80_000, 320_000) if count else (300_000, 380_000)
    fleet = tuple(Robot(f"r{r}", 0, chance.choice(names), chance.randint(least, most), chance.choice((0, 0, 60)),
                        NEVER, chance.choice((0, 20_000))) for r in range(robots))
    ways = {key: drives[:speeds] for key, drives in _ways(chance, places).items()}
    return Problem((kind,), fleet, stations, tuple(_mission(chance, m, names, ways, robots) for m in range(missions)), ways)


def _mission(chance: random.Random, index: int, names: list[str], ways: dict[tuple[int, str, str], tuple[Drive, ...]],
             robots: int) -> Mission:
    first, last = chance.sample(names, 2)
    load, dwell_s = chance.choice((1.0, 1.2, 1.4)), chance.randint(20, 60)
    drives = undominated([Drive(d.duration_s + dwell_s, round(d.motion * load), math.ceil(d.upper * load), d.point)
                          for d in ways[0, first, last]])
    ready_s = chance.choice((0, 0, chance.randint(0, 600)))
    allowed = tuple(range(robots)) if chance.random() < 0.8 else tuple(sorted(chance.sample(range(robots), max(1, robots - 1))))
    return Mission(f"m{index}", first, last, {0: drives}, allowed, ready_s, ready_s + chance.randint(400, 1500), 500)


def tight(seed: int, robots: int = 4, missions: int = 12, chargers: int = 2) -> Problem:
    """Exactly so many robots, missions and chargers: three speeds of each leg, up to four stops with other payloads, narrow
    windows, batteries that make most robots charge. A third of the fleets has two types of robots, a third has equal robots."""
    chance, kind = random.Random(f"tight fleet {seed} {robots} {missions} {chargers}"), seed % 3
    places = {f"p{i}": (chance.uniform(0, 40), chance.uniform(0, 25)) for i in range(robots + missions)}
    names, scales = list(places), (1.0, 1.3) if kind == 1 else (1.0,)
    ways = {(t, a, b): drives for t, scale in enumerate(scales) for (a, b), drives in _three_speeds(chance, places, scale).items()}
    fleet = [Robot(f"r{r}", chance.randrange(len(scales)), chance.choice(names), chance.randint(80_000, 200_000),
                   chance.choice((0, 0, 60)), NEVER, chance.choice((0, 20_000))) for r in range(robots)]
    if kind == 2:
        fleet = [dataclasses.replace(fleet[0], name=x.name) for x in fleet]
    stations = tuple(Charger(p, 1, chance.choice((1500, 2500)), chance.choice((700, 1000)), chance.choice((0.5, 0.8)))
                     for p in chance.sample(names, chargers))
    types = tuple(RobotType(round(300_000 * x), 40_000, round(100 * x)) for x in scales)
    span_s = 120 * missions // robots
    return Problem(types, tuple(fleet), stations, tuple(_delivery(chance, m, ways, fleet, names, span_s) for m in range(missions)), ways)


def _three_speeds(chance: random.Random, places: dict[str, tuple[float, float]], scale: float) -> dict[tuple[str, str], tuple[Drive, ...]]:
    ways = {}
    for (a, (xa, ya)), (b, (xb, yb)) in itertools.product(places.items(), repeat=2):
        way_m = (abs(xa - xb) + abs(ya - yb)) * chance.uniform(1.0, 1.2) + 2.0
        ways[a, b] = (Drive(0, 0, 0),) if a == b else _speeds(way_m, scale, (0.6, 0.8, 1.0))
    return ways


def _at_speed(legs: list[tuple[float, tuple[Drive, ...]]], k: int, dwell_s: int) -> Drive:
    """Loaded legs at their k-th speeds, or their quickest where a short way has fewer."""
    drives = [(load, leg[min(k, len(leg) - 1)]) for load, leg in legs]
    return Drive(dwell_s + sum(d.duration_s for _, d in drives), round(sum(load * d.motion for load, d in drives)),
                 math.ceil(sum(load * d.upper for load, d in drives)), k)


def _delivery(chance: random.Random, index: int, ways: dict[tuple[int, str, str], tuple[Drive, ...]], fleet: list[Robot],
              names: list[str], span_s: int) -> Mission:
    """Two to four stops, with another payload on each leg."""
    stops, dwell_s = chance.sample(names, chance.randint(2, 4)), chance.randint(10, 40)
    loads = [chance.choice((1.0, 1.15, 1.3, 1.5)) for _ in stops[1:]]
    allowed = range(len(fleet)) if chance.random() < 0.7 else sorted(chance.sample(range(len(fleet)), max(1, len(fleet) - 1)))
    drives = {}
    for t in {fleet[r].type for r in allowed}:
        legs = [(load, ways[t, a, b]) for load, a, b in zip(loads, stops, stops[1:])]
        drives[t] = undominated([_at_speed(legs, k, dwell_s) for k in range(3)])
    ready_s = chance.choice((0, chance.randint(0, span_s)))
    own_s = max(d[0].duration_s for d in drives.values())
    return Mission(f"m{index}", stops[0], stops[-1], drives, tuple(allowed), ready_s, ready_s + own_s + chance.randint(20, 240),
                   chance.choice((200, 500, 2000)))


def queue(robots: int, need: int, power: int = 1100) -> Problem:
    """Equal robots at one charger, each with one mission that needs ``need`` tenths of a joule more than it has.

    The first robot waits for nobody, the k-th for k charges: their ends are known (``queue_cost``).
    """
    kind = RobotType(capacity=1_000_000, reserve=100_000, standby=100)
    way, task = Drive(10, 2_000, 2_000), Drive(50, 20_000, 60_000)
    level = kind.reserve + 2 * way.upper + task.upper + kind.standby * 70 - need
    ways = {(0, a, b): ((Drive(0, 0, 0),) if a == b else (way,)) for a in ("home", "dock", "shelf") for b in ("home", "dock", "shelf")}
    fleet = tuple(Robot(f"r{r}", 0, "home", level) for r in range(robots))
    missions = tuple(Mission(f"m{r}", "shelf", "shelf", {0: (task,)}, (r,), 0, NEVER, 0) for r in range(robots))
    return Problem((kind,), fleet, (Charger("dock", 1, power, power),), missions, ways)


def queue_cost(robots: int, need: int, power: int = 1100) -> int:
    """The least cost of ``queue``: the k-th robot charges for its need and for the standby of its wait.

    A robot that waits w seconds needs ``need + standby w``. It waits at the charger for the charges before its own.
    """
    standby, waits, total = 100, 0, 0
    for _ in range(robots):
        charge_s = -(-(need + standby * waits) // (power - standby))
        total += 2 * 2_000 + 20_000 + standby * (10 + waits + charge_s + 10 + 50)
        waits += charge_s
    return total


def large(seed: int, robots: int = 20, missions: int = 200, chargers: int = 3) -> Problem:
    """A shift of 20 robots on 40 places: windows are wide enough to be kept, and the batteries are not enough for the shift."""
    chance = random.Random(f"large fleet {seed}")
    places = {f"p{i}": (chance.uniform(0, 60), chance.uniform(0, 40)) for i in range(40)}
    names, kind = list(places), RobotType(capacity=800_000, reserve=80_000, standby=100)
    ways = _ways(chance, places)
    at = chance.sample(names, chargers)
    fleet = tuple(Robot(f"r{r}", 0, chance.choice(names), chance.randint(150_000, 500_000), 0, NEVER, 20_000) for r in range(robots))
    tasks = []
    for m in range(missions):
        task = _mission(chance, m, names, ways, robots)
        ready_s = chance.randint(0, 1500)
        tasks.append(dataclasses.replace(task, robots=tuple(range(robots)), ready_s=ready_s, due_s=ready_s + chance.randint(600, 1500)))
    return Problem((kind,), fleet, tuple(Charger(p, 1, 2500, 1000, 0.8) for p in at), tuple(tasks), ways)
