"""What each robot does over time, with the mean and the lower 95 % bound of its battery."""

from __future__ import annotations

from typing import Any

from ._problem import UNITS_PER_J, Drive, Problem, Schedule, Step


class _Robot:
    """Walks along a route and notes each stretch of time."""

    def __init__(self, problem: Problem, r: int) -> None:
        self.problem, self.robot, self.kind = problem, problem.robots[r], problem.kind(r)
        self.place, self.clock = self.robot.start, self.robot.from_s
        self.mean = self.low = self.robot.level
        self.items: list[dict[str, Any]] = []

    def note(self, does: str, until_s: int, mean: int = 0, upper: int = 0, **more: Any) -> None:
        """A stretch of time with energies beside standby."""
        standby = self.kind.standby * (until_s - self.clock)
        self.mean, self.low = self.mean - mean - standby, self.low - upper - standby
        self._add(does, until_s, {"energy_J": (mean + standby) / UNITS_PER_J, **more})

    def _add(self, does: str, until_s: int, more: dict[str, Any]) -> None:
        self.items.append({"does": does, "from_s": self.clock, "to_s": until_s, **more,
                           "battery_fraction": round(self.mean / self.kind.capacity, 6),
                           "battery_fraction_lower_95": round(self.low / self.kind.capacity, 6)})
        self.clock = until_s

    def drive(self, to: str, way: Drive) -> None:
        if to != self.place:
            self.note("drive", self.clock + way.duration_s, way.motion, way.upper, **{"from": self.place, "to": to, "point": way.point})
        self.place = to

    def wait(self, until_s: int) -> None:
        if until_s > self.clock:
            self.note("wait", until_s, at=self.place)

    def go(self, step: Step) -> None:
        p, mission = self.problem, self.problem.missions[step.mission]
        if step.visit:
            dock = p.chargers[step.visit.charger].place
            self.drive(dock, p.ways[self.robot.type, self.place, dock][0])
            self.wait(step.visit.from_s)
            charged = max(0, step.visit.target - self.mean)
            self.mean, self.low = max(self.mean, step.visit.target), max(self.low, step.visit.target)
            self._add("charge", step.visit.to_s, {"at": dock, "charged_J": charged / UNITS_PER_J})
        way = p.ways[self.robot.type, self.place, mission.first][step.way]
        self.drive(mission.first, way)
        self.wait(step.start_s)
        speed = mission.drives[self.robot.type][step.speed]
        end_s = step.start_s + speed.duration_s
        self.note("mission", end_s, speed.motion, speed.upper, mission=mission.name, point=speed.point,
                  late_s=max(0, end_s - mission.due_s))
        self.place = mission.last


def timelines(problem: Problem, schedule: Schedule) -> list[list[dict[str, Any]]]:
    """Of each robot: drive, wait, charge and mission, with battery fractions at their ends."""
    found = []
    for r, route in enumerate(schedule.routes):
        robot = _Robot(problem, r)
        for step in route:
            robot.go(step)
        found.append(robot.items)
    return found
