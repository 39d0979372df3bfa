"""Executions of a schedule with energies drawn from the model's own uncertainty, or with a hidden effect."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any

from ._problem import SIGMAS, Drive, Problem, Schedule, Step


@dataclass(frozen=True)
class Executions:
    runs: int
    days: int  #: of robots that drive
    binding: int  #: of these, days on which the plan's lower bound comes within 1 % of the battery of the reserve
    breaches: int  #: days on which a battery falls below its reserve
    breaches_binding: int
    late_s: float  #: mean of all missions of a run
    waited_s: float  #: at chargers, mean of a run


def simulate(problem: Problem, schedule: Schedule, runs: int, seed: int, *, factor: dict[int, float] | None = None,
             charge_now: bool = False) -> Executions:
    """Drives a schedule. One normal number for each robot and run shifts all of its legs, because their errors are correlated.

    ``factor``: of the energies of robots, a hidden effect. ``charge_now``: a dispatcher's rule. A robot whose level is below the
    plan's lower bound drives to the nearest charger before its next mission and charges what it lacks; at a visit of the plan it
    stays until the level of the plan is reached.
    """
    chance, binding = random.Random(seed), [_binds(problem, r, route) for r, route in enumerate(schedule.routes)]
    breaches = [0] * len(problem.robots)
    late = waited = 0.0
    for _ in range(runs):
        free: dict[int, list[float]] = {c: [0.0] * charger.count for c, charger in enumerate(problem.chargers)}
        drivers = [_Driver(problem, r, chance.gauss(0, 1), (factor or {}).get(r, 1.0)) for r in range(len(problem.robots))]
        steps = sorted((step.visit.from_s if step.visit else step.start_s, r, n)
                       for r, route in enumerate(schedule.routes) for n, step in enumerate(route))
        for _, r, n in steps:
            waited += drivers[r].step(schedule.routes[r][n], free, charge_now)
        late += sum(driver.late_s for driver in drivers)
        for r, driver in enumerate(drivers):
            breaches[r] += driver.lowest < 0
    used = [r for r, route in enumerate(schedule.routes) if route]
    return Executions(runs, runs * len(used), runs * sum(binding), sum(breaches), sum(n for r, n in enumerate(breaches) if binding[r]),
                      late / runs, waited / runs)


class _Driver:
    def __init__(self, problem: Problem, r: int, shift: float, factor: float) -> None:
        self.problem, self.robot, self.kind = problem, problem.robots[r], problem.kind(r)
        self.shift, self.factor = shift, factor
        self.place, self.clock, self.level = self.robot.start, float(self.robot.from_s), float(self.robot.level)
        self.plan = float(self.robot.level)  # the lower bound of the level in the plan
        self.lowest, self.late_s = self.level - self.kind.reserve, 0.0

    def spend(self, drive: Drive, until_s: float) -> None:
        standby = self.kind.standby * (until_s - self.clock)
        self.level -= self.factor * (drive.motion + self.shift * (drive.upper - drive.motion) / SIGMAS) + standby
        self.plan -= drive.upper + standby
        self.clock, self.lowest = until_s, min(self.lowest, self.level - self.kind.reserve)

    def step(self, step: Step, free: dict[int, list[float]], charge_now: bool) -> float:
        """Drives one step; seconds that it waited at a charger beyond the plan."""
        p, mission, waited, way_index = self.problem, self.problem.missions[step.mission], 0.0, step.way
        if step.visit:
            c = step.visit.charger
            waited, slot = self._dock(c, float(step.visit.from_s), free)
            self._charge(step, c, charge_now)
            free[c][slot] = self.clock
        elif charge_now and self.level < self.plan and p.chargers:
            waited, way_index = self._detour(mission.first, step.way, free), 0
        way = p.ways[self.robot.type, self.place, mission.first][way_index]
        self.spend(way, max(self.clock + way.duration_s, mission.ready_s))
        speed = mission.drives[self.robot.type][step.speed]
        self.spend(speed, self.clock + speed.duration_s)
        self.place, self.late_s = mission.last, self.late_s + max(0.0, self.clock - mission.due_s)
        return waited

    def _dock(self, c: int, planned_s: float, free: dict[int, list[float]]) -> tuple[float, int]:
        """Drives to a charger and waits there; seconds of the wait beyond the plan, and the place that is taken."""
        dock = self.problem.chargers[c].place
        way = self.problem.ways[self.robot.type, self.place, dock][0]
        self.spend(way, self.clock + way.duration_s)
        slot = min(range(len(free[c])), key=lambda k: free[c][k])
        arrival = max(self.clock, planned_s)
        self.spend(Drive(0, 0, 0), max(arrival, free[c][slot]))
        self.place = dock
        return self.clock - arrival, slot

    def _detour(self, to: str, way_index: int, free: dict[int, list[float]]) -> float:
        """A charge that the plan lacks: to the plan's level, and for the longer way."""
        p, t, place, plan = self.problem, self.robot.type, self.place, self.plan
        c = min(range(len(p.chargers)), key=lambda k: p.ways[t, place, p.chargers[k].place][0].duration_s)
        waited, slot = self._dock(c, self.clock, free)
        longer = p.ways[t, self.place, to][0].upper - p.ways[t, place, to][way_index].upper
        target = min(self.kind.capacity, max(round(self.level), round(plan) + longer))
        self.clock += p.charge_s(c, self.kind, round(self.level), target)
        self.level = self.plan = float(target)
        free[c][slot] = self.clock
        return waited

    def _charge(self, step: Step, c: int, charge_now: bool) -> None:
        """Until the target, in the time of the plan; with the rule, in the time that it takes."""
        assert step.visit is not None
        target, planned_s = step.visit.target, step.visit.to_s - step.visit.from_s
        needed_s = self.problem.charge_s(c, self.kind, round(self.level), max(round(self.level), target))
        seconds = needed_s if charge_now else min(needed_s, planned_s)
        share = 1.0 if needed_s <= seconds else seconds / needed_s
        self.level += share * max(0.0, target - self.level)
        self.plan, self.clock = float(target), self.clock + max(seconds, planned_s if not charge_now else 0)


def _binds(problem: Problem, r: int, route: tuple[Step, ...]) -> bool:
    driver = _Driver(problem, r, SIGMAS, 1.0)
    free = {c: [0.0] * charger.count for c, charger in enumerate(problem.chargers)}
    for step in route:
        driver.step(step, free, False)
    return bool(route) and driver.lowest < 0.01 * problem.kind(r).capacity


def most_driven(schedule: Schedule) -> int:
    """The robot with the most missions."""
    return max(range(len(schedule.routes)), key=lambda r: len(schedule.routes[r]))


def cases(problem: Problem, schedule: Schedule, runs: int, seed: int, hidden: float = 1.1,
          cause: str = "10 % more energy") -> list[dict[str, Any]]:
    """Figures of executions: the model's own uncertainty, and a hidden factor of the energies of the robot with the most missions;
    each without and with the rule."""
    most = most_driven(schedule)
    effects = [("the model's uncertainty", {}), (f"{cause} of {problem.robots[most].name}", {most: hidden})]
    return [_row(name + rule, simulate(problem, schedule, runs, seed, factor=factor, charge_now=bool(rule)))
            for name, factor in effects for rule in ("", ", with the rule: charge now")]


def _row(name: str, x: Executions) -> dict[str, Any]:
    return {"case": name, "runs": x.runs, "days": x.days, "breaches": x.breaches, "days_binding": x.binding,
            "breaches_binding": x.breaches_binding, "late_s": round(x.late_s, 3), "waited_s": round(x.waited_s, 3)}


def told(rows: list[dict[str, Any]]) -> str:
    """The rows as text."""
    return "\n".join(f"{x['case']}: {x['breaches']} of {x['days']} days of robots below the reserve ({x['breaches_binding']} of "
                     f"{x['days_binding']} where it binds), late {x['late_s']:.1f} s, waits at chargers {x['waited_s']:.1f} s" for x in rows)
