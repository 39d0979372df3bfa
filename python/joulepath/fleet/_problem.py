"""A fleet in whole seconds and tenths of a joule: what the planner of fleets and its judges read.

Durations and upper bounds of energies are rounded up, levels of batteries down, so that a plan in these units is one in
seconds and joules. Costs are mean energies, rounded to the nearest tenth.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass, field

UNITS_PER_J = 10
SIGMAS = 1.645  #: one-sided 95 % of a normal distribution
NEVER = 10**7  #: s, later than every end


@dataclass(frozen=True)
class Drive:
    """One speed of a leg, or of all legs and dwells of a mission. Energies without standby."""

    duration_s: int
    motion: int  #: mean
    upper: int  #: 95 % upper bound
    point: int = 0  #: of the legs' fronts: 0 is the cheapest


@dataclass(frozen=True)
class Robot:
    name: str
    type: int
    start: str
    level: int  #: of the battery
    from_s: int = 0
    to_s: int = NEVER
    use_price: int = 0

    def likeness(self) -> tuple[object, ...]:
        """All but its name."""
        return astuple(self)[1:]


@dataclass(frozen=True)
class RobotType:
    capacity: int
    reserve: int
    standby: int  #: per second


@dataclass(frozen=True)
class Charger:
    """The power into the battery is constant below the knee and constant above it."""

    place: str
    count: int
    power: int  #: per second
    taper: int  #: per second, above the knee
    knee_fraction: float = 1.0

    def knee(self, kind: RobotType) -> int:
        return round(self.knee_fraction * kind.capacity)


@dataclass(frozen=True)
class Mission:
    name: str
    first: str
    last: str
    drives: dict[int, tuple[Drive, ...]]  #: of each type of robot that may drive it
    robots: tuple[int, ...]
    ready_s: int = 0
    due_s: int = NEVER
    late_price: int = 0  #: per second


@dataclass(frozen=True)
class Problem:
    types: tuple[RobotType, ...]
    robots: tuple[Robot, ...]
    chargers: tuple[Charger, ...]
    missions: tuple[Mission, ...]
    ways: dict[tuple[int, str, str], tuple[Drive, ...]]  #: type, from, to: an empty drive, from the cheapest to the quickest
    busy: tuple[tuple[int, int, int], ...] = field(default=())  #: charger, from, to: visits of other robots

    def kind(self, robot: int) -> RobotType:
        return self.types[self.robots[robot].type]

    def likeness(self, robot: int) -> tuple[object, ...]:
        """The same of robots that differ by their names alone, and by their numbers."""
        return self.robots[robot].likeness() + tuple(robot in m.robots for m in self.missions)

    def equals(self) -> list[list[int]]:
        """Groups of equal robots."""
        groups: dict[tuple[object, ...], list[int]] = {}
        for r in range(len(self.robots)):
            groups.setdefault(self.likeness(r), []).append(r)
        return list(groups.values())

    def charge_s(self, charger: int, kind: RobotType, level: int, target: int) -> int:
        """Whole seconds, rounded up, of a charge from a level to a target. Standby is drawn meanwhile."""
        at = self.chargers[charger]
        knee, fast, slow = at.knee(kind), at.power - kind.standby, at.taper - kind.standby
        below, above = max(0, min(target, knee) - level), max(0, target - max(level, knee))
        return -(-(below * slow + above * fast) // (fast * slow))

    def horizon_s(self) -> int:
        """No optimal plan ends later: all missions one after the other, each with the longest way and a full charge."""
        longest = max((w[0].duration_s for w in self.ways.values()), default=0)
        charge = max((self.charge_s(c, kind, kind.reserve, kind.capacity) for c in range(len(self.chargers)) for kind in self.types),
                     default=0)
        driving = sum(max(d.duration_s for drives in m.drives.values() for d in drives) + 2 * longest + charge for m in self.missions)
        latest = max([r.from_s for r in self.robots] + [m.ready_s for m in self.missions] + [b[2] for b in self.busy])
        return min(NEVER, latest + driving + len(self.busy) * charge + 1)


def drive(duration_s: float, motion_J: float, sigma_J: float, point: int = 0) -> Drive:
    """A drive in whole units."""
    upper = math.ceil(UNITS_PER_J * (motion_J + SIGMAS * sigma_J) - 1e-6)
    return Drive(math.ceil(duration_s - 1e-6), round(UNITS_PER_J * motion_J), upper, point)


def undominated(drives: list[Drive]) -> tuple[Drive, ...]:
    """Those that no other drive beats in time and energy; the cheapest first."""
    kept: list[Drive] = []
    for one in sorted(drives, key=lambda d: (d.motion, d.duration_s)):
        if not kept or one.duration_s < kept[-1].duration_s:
            kept.append(one)
    return tuple(kept)


@dataclass(frozen=True)
class Visit:
    """A charge on the way to a mission."""

    charger: int
    from_s: int
    to_s: int
    target: int  #: level at its end


@dataclass(frozen=True)
class Step:
    """A mission in a robot's route, with the way to it."""

    mission: int
    way: int  #: index of the empty drive's speed; 0 with a visit
    speed: int  #: index of the mission's speed
    start_s: int
    visit: Visit | None = None


@dataclass(frozen=True)
class Schedule:
    routes: tuple[tuple[Step, ...], ...]  #: of each robot
    cost: int
    bound: int = 0
    proven: bool = False
