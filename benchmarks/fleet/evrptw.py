"""Converter of E-VRPTW instances [Schneider2014]: electric vehicles, customers with time windows, charging stations without queues.

A customer is a mission at one place, the way back to the depot the last mission of each vehicle. The cost is the distance. Differences
to the published problem: a charge may be partial, at most one station lies between two customers, and loads are checked afterwards.
Published values are for full recharges, so they bound this problem's from above where no two stations in a row are needed.
"""

from __future__ import annotations

import math
import pathlib
import re
from typing import NamedTuple

from joulepath.fleet._problem import NEVER, Charger, Drive, Mission, Problem, Robot, RobotType, Schedule

TIMES, LENGTHS, ENERGIES = 100, 1000, 100_000  #: units of one unit of the text
LATE = 10**7  #: price of a time unit: windows are hard
#: vehicles and distance of [Schneider2014], small instances
PUBLISHED = {"c101C5": (2, 257.75), "c103C5": (1, 176.05), "c206C5": (1, 242.55), "c208C5": (1, 158.48), "r104C5": (2, 136.69),
             "r105C5": (2, 156.08), "r202C5": (1, 128.78), "r203C5": (1, 179.06), "rc105C5": (2, 241.30), "rc108C5": (1, 253.93),
             "rc204C5": (1, 176.39), "rc208C5": (1, 167.98), "c101C10": (3, 393.76), "c104C10": (2, 273.93), "c202C10": (1, 304.06),
             "c205C10": (2, 228.28), "r102C10": (3, 249.19), "r103C10": (2, 207.05), "r201C10": (1, 241.51), "r203C10": (1, 218.21),
             "rc102C10": (4, 423.51), "rc108C10": (3, 345.93), "rc201C10": (1, 412.86), "rc205C10": (2, 325.98)}


class Place(NamedTuple):
    name: str
    kind: str  #: d: depot, f: station, c: customer
    x: float
    y: float
    demand: float
    ready: float
    due: float
    service: float


def read(file: pathlib.Path) -> tuple[list[Place], dict[str, float]]:
    """Places, and the constants Q, C, r, g, v. Columns end with spaces or slashes."""
    places, constants = [], {}
    for line in file.read_text(encoding="utf-8").splitlines()[1:]:
        words = [word for word in re.split(r"[\s/]+", line) if word]
        if len(words) == 8:
            places.append(Place(words[0], words[1], *map(float, words[2:])))
        elif words:
            constants[words[0]] = float(words[-1])
    return places, constants


def problem(file: pathlib.Path, vehicles: int) -> Problem:
    """The instance as a fleet of so many robots, each of which must return to the depot."""
    places, constants = read(file)
    depot = next(p for p in places if p.kind == "d")
    ways = {(0, a.name, b.name): (_way(a, b, constants),) for a in places for b in places}
    power = round(ENERGIES / (constants["g"] * TIMES))
    stations = tuple(Charger(p.name, vehicles, power, power) for p in places if p.kind == "f")
    capacity, end = round(ENERGIES * constants["Q"]), round(TIMES * depot.due)
    robots = tuple(Robot(f"v{k}", 0, depot.name, capacity, 0, end) for k in range(vehicles))
    customers = tuple(Mission(p.name, p.name, p.name, {0: (Drive(round(TIMES * p.service), 0, 0),)}, tuple(range(vehicles)),
                              round(TIMES * p.ready), round(TIMES * (p.due + p.service)), LATE) for p in places if p.kind == "c")
    home = tuple(Mission(f"home {k}", depot.name, depot.name, {0: (Drive(0, 0, 0),)}, (k,), end, NEVER, 0) for k in range(vehicles))
    return Problem((RobotType(capacity, 0, 0),), robots, stations, customers + home, ways)


def _way(a: Place, b: Place, constants: dict[str, float]) -> Drive:
    length = math.hypot(a.x - b.x, a.y - b.y)
    return Drive(round(TIMES * length / constants["v"]), round(LENGTHS * length), round(ENERGIES * constants["r"] * length))


def overloaded(file: pathlib.Path, found: Schedule) -> bool:
    """Whether a vehicle carries more than it may."""
    places, constants = read(file)
    demands = [p.demand for p in places if p.kind == "c"]
    return any(sum(demands[step.mission] for step in route if step.mission < len(demands)) > constants["C"] for route in found.routes)


def instances(folder: str) -> list[pathlib.Path]:
    """The files of the published values, small ones first."""
    known = {path.stem: path for path in pathlib.Path(folder).rglob("*.txt")}
    return [known[name] for name in PUBLISHED if name in known]
