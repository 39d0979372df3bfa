"""Energies of a fleet's legs, from the mission planner: for each pair of places, payload and robot file, both directions."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from typing import Any

from .. import _core
from .._inputs import file_name
from ..mapping import map as in_threads
from ._problem import NEVER, UNITS_PER_J, Charger, Drive, Mission, Problem, Robot, RobotType, drive, undominated

POINTS = 3
Leg = tuple[int, str, str, float]  #: type, from, to, payload_kg
Points = list[tuple[float, float, float]]  #: duration_s, motion J, 1-sigma J


class FleetFile:
    """A checked fleet file, and the problem that it states."""

    def __init__(self, file: str | os.PathLike[str], *, threads: int = 2, cache: bool = True,
                 progress: Callable[[int, int], None] | None = None) -> None:
        """Reads the file and plans its legs. Raises ConfigError with file, line and key, before any leg is planned where it can."""
        self._value = _core.load_fleet(file_name("fleet", file), cache)
        self.reason: dict[str, Any] | None = None  #: why there is no schedule
        self.executions: list[dict[str, Any]] = []
        self.content: dict[str, Any] = json.loads(self._value.json)
        legs = sorted(self._legs())
        self.table: dict[Leg, Points] = {}
        for first in range(0, len(legs), 64):
            part = legs[first:first + 64]
            for leg, found in zip(part, in_threads(self._value.leg_points, part, threads=threads)):
                if isinstance(found, Exception):
                    raise found
                self.table[leg] = found
            if progress:
                progress(len(self.table), len(legs))
        self.problem = self._problem()

    @property
    def map_picture(self) -> Any:
        """Width, height, resolution (m), pose of the lower left corner, runs of cells from the bottom row on."""
        return self._value.map_picture

    def track(self, leg: Leg) -> Points:
        """(time s, x m, y m) of a leg's drive when time is free."""
        return self._value.leg_track(*leg)

    def payload_kg(self, stop: dict[str, Any]) -> float:
        """A payload, rounded up to its band."""
        band = float(self.content["payload_band_kg"])
        return band * math.ceil(float(stop["payload_kg"]) / band - 1e-9)

    def _types(self, mission: dict[str, Any]) -> list[int]:
        return sorted({self.content["robots"][r]["type"] for r in mission["robots"]})

    def mission_legs(self, mission: dict[str, Any], t: int) -> list[Leg]:
        """The legs of a mission between its stops."""
        stops = mission["stops"]
        return [(t, a["station"], b["station"], self.payload_kg(a)) for a, b in zip(stops, stops[1:])]

    def _legs(self) -> set[Leg]:
        c = self.content
        docks = [x["station"] for x in c["chargers"]]
        legs: set[Leg] = set()
        for t in range(len(c["types"])):
            mine = [m for m in c["missions"] if t in self._types(m)]
            firsts = [m["stops"][0]["station"] for m in mine]
            leaves = [m["stops"][-1]["station"] for m in mine] + [r["start"] for r in c["robots"] if r["type"] == t]
            legs |= {(t, a, b, 0.0) for a in leaves + docks for b in firsts + docks}
            legs |= {leg for m in mine for leg in self.mission_legs(m, t)}
        return legs

    def _drives(self, legs: list[Leg], dwell_s: float) -> tuple[Drive, ...]:
        """Several legs at equal places of their fronts: errors of one robot's legs are correlated, so their sigmas add up."""
        drives = []
        for k in range(POINTS):
            points = [self.table[leg][min(k, len(self.table[leg]) - 1)] for leg in legs]
            drives.append(drive(dwell_s + sum(p[0] for p in points), sum(p[1] for p in points), sum(p[2] for p in points), k))
        return undominated(drives)

    def _problem(self) -> Problem:
        c = self.content
        types = tuple(RobotType(math.floor(UNITS_PER_J * t["capacity_J"]), math.ceil(UNITS_PER_J * t["capacity_J"] * t["reserve_fraction"]),
                                math.ceil(UNITS_PER_J * t["standby_W"] - 1e-9)) for t in c["types"])
        robots = tuple(Robot(r["name"], r["type"], r["start"], math.floor(types[r["type"]].capacity * r["battery_fraction"]),
                             math.ceil(r["from_s"]), _whole(r["to_s"]), round(UNITS_PER_J * r["use_price_J"])) for r in c["robots"])
        chargers = tuple(Charger(x["station"], x["count"], math.floor(UNITS_PER_J * x["power_W"]), math.floor(UNITS_PER_J * x["taper_W"]),
                                 x["knee_fraction"]) for x in c["chargers"])
        missions = tuple(self._mission(m) for m in c["missions"])
        ways = {(t, a, b): self._drives([(t, a, b, kg)], 0.0) for t, a, b, kg in self.table if kg == 0.0}
        return Problem(types, robots, chargers, missions, ways)

    def _mission(self, m: dict[str, Any]) -> Mission:
        dwell_s = sum(stop["dwell_s"] for stop in m["stops"])
        drives = {t: self._drives(self.mission_legs(m, t), dwell_s) for t in self._types(m)}
        return Mission(m["name"], m["stops"][0]["station"], m["stops"][-1]["station"], drives, tuple(m["robots"]),
                       math.ceil(m["ready_s"]), _whole(m["due_s"]), round(UNITS_PER_J * m["late_price_W"]))


def _whole(time_s: float | None) -> int:
    return NEVER if time_s is None else math.floor(time_s)
