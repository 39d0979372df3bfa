"""Schedules without a solver: orders of missions driven in the order of time, and the dispatcher of the field."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from ._problem import Drive, Problem, RobotType, Schedule, Step, Visit

QUEUES_S = (0, 200, 800)  #: waits at chargers that orders are driven for


@dataclass
class _At:
    """Where a robot is after its last step."""

    place: str
    clock: int
    level: int
    route: list[Step] = field(default_factory=list)


def account(problem: Problem, routes: Sequence[Sequence[Step]]) -> int:
    """The cost of timed routes."""
    return sum(route_cost(problem, r, route) for r, route in enumerate(routes))


def route_cost(problem: Problem, r: int, route: Sequence[Step]) -> int:
    """Mean energy with standby, lateness and use of a robot's timed route."""
    if not route:
        return 0
    robot, place, cost, end = problem.robots[r], problem.robots[r].start, problem.robots[r].use_price, 0
    for step in route:
        mission = problem.missions[step.mission]
        if step.visit:
            dock = problem.chargers[step.visit.charger].place
            cost, place = cost + problem.ways[robot.type, place, dock][0].motion, dock
        speed = mission.drives[robot.type][step.speed]
        cost += problem.ways[robot.type, place, mission.first][step.way].motion + speed.motion
        end = step.start_s + speed.duration_s
        cost += mission.late_price * max(0, end - mission.due_s)
        place = mission.last
    return cost + problem.types[robot.type].standby * (end - robot.from_s)


class Drivers:
    """Drives robots one step at a time; chargers serve in the order of calls."""

    def __init__(self, problem: Problem, to_dock: dict[tuple[int, str], int] | None = None) -> None:
        """``to_dock``: what ``to_dock()`` found before, for the same problem."""
        self.problem, self._to_dock = problem, {} if to_dock is None else to_dock
        self.at = [_At(x.start, x.from_s, x.level) for x in problem.robots]
        self.taken: list[list[tuple[int, int]]] = [[(a, b) for d, a, b in problem.busy if d == c] for c in range(len(problem.chargers))]

    def free_from(self, c: int, time_s: int, duration_s: int = 1) -> int:
        """The earliest begin of a visit of so many seconds."""
        taken, count = sorted(self.taken[c]), self.problem.chargers[c].count
        for begin in sorted({time_s, *(b for _, b in taken if b > time_s)}):
            inside = [(a, b) for a, b in taken if a < begin + duration_s and b > begin]
            moments = [begin, *(a for a, _ in inside if a > begin)]
            if all(sum(a <= t < b for a, b in inside) < count for t in moments):
                return begin
        return max(b for _, b in taken)

    def to_dock(self, r: int, place: str) -> int:
        """Energy that a robot needs to reach its nearest charger; 0 without chargers."""
        p, t = self.problem, self.problem.robots[r].type
        if (t, place) not in self._to_dock:
            needs = [_need(p.ways[t, place, c.place][0], p.types[t]) for c in p.chargers if (t, place, c.place) in p.ways]
            self._to_dock[t, place] = min(needs, default=0)
        return self._to_dock[t, place]

    def needed(self, r: int, m: int, place: str, clock: int) -> int:
        """Energy for a mission from a place, waiting included."""
        p, robot, mission = self.problem, self.problem.robots[r], self.problem.missions[m]
        way, speed = p.ways[robot.type, place, mission.first][0], mission.drives[robot.type][0]
        end = max(clock + way.duration_s, mission.ready_s) + speed.duration_s
        return way.upper + speed.upper + p.types[robot.type].standby * (end - clock)

    def go(self, r: int, m: int, visit: tuple[int, int] | None) -> bool:
        """Drives a robot to a mission, by a charge (charger, target) first; False and nothing done where its battery refuses."""
        p, robot, at, mission = self.problem, self.problem.robots[r], self.at[r], self.problem.missions[m]
        kind = p.types[robot.type]
        place, clock, level, stop = at.place, at.clock, at.level, None
        if visit is not None:
            stop = self._charge(r, *visit)
            if stop is None:
                return False
            place, clock, level = p.chargers[visit[0]].place, stop.to_s, stop.target
        ways, speeds = p.ways[robot.type, place, mission.first], mission.drives[robot.type]
        way = _late_choice(ways, lambda d: max(clock + d.duration_s, mission.ready_s) + speeds[0].duration_s - mission.due_s)
        start = max(clock + ways[way].duration_s, mission.ready_s)
        speed = _late_choice(speeds, lambda d: start + d.duration_s - mission.due_s)
        end = start + speeds[speed].duration_s
        level -= ways[way].upper + speeds[speed].upper + kind.standby * (end - clock)
        if level < kind.reserve or end > robot.to_s:
            return False
        if stop is not None:
            self.taken[stop.charger].append((stop.from_s, stop.to_s))
        at.route.append(Step(m, way, speed, start, stop))
        at.place, at.clock, at.level = mission.last, end, level
        return True

    def _charge(self, r: int, c: int, target: int) -> Visit | None:
        p, robot, at = self.problem, self.problem.robots[r], self.at[r]
        kind, way = p.types[robot.type], p.ways[robot.type, at.place, p.chargers[c].place][0]
        arrival, begin = at.clock + way.duration_s, at.clock + way.duration_s
        for _ in range(20):  # a later begin needs a longer charge
            level = at.level - way.upper - kind.standby * (begin - at.clock)
            if level < kind.reserve:
                return None
            seconds = p.charge_s(c, kind, level, max(level, min(target, kind.capacity)))
            free = self.free_from(c, arrival, max(1, seconds))
            if free <= begin:
                break
            begin = free
        return Visit(c, begin, begin + seconds, max(level, min(target, kind.capacity)))

    def schedule(self) -> Schedule:
        routes = tuple(tuple(at.route) for at in self.at)
        return Schedule(routes, account(self.problem, routes))


def _need(way: Drive, kind: RobotType) -> int:
    return way.upper + kind.standby * way.duration_s


def _late_choice(drives: tuple[Drive, ...], late_s: Callable[[Drive], int]) -> int:
    """The cheapest speed that is not late, else the quickest."""
    return next((k for k, d in enumerate(drives) if late_s(d) <= 0), len(drives) - 1)


def drive_orders(problem: Problem, orders: Sequence[Sequence[int]], waits_s: Sequence[int] = QUEUES_S,
                 to_dock: dict[tuple[int, str], int] | None = None) -> Schedule | None:
    """Robots drive their missions in a given order and charge when the next one would not leave them the way to a charger, with
    standby for a wait there: the cheapest of several waits."""
    found = [schedule for wait_s in waits_s if (schedule := _driven(problem, orders, wait_s, to_dock)) is not None]
    return min(found, key=lambda schedule: schedule.cost, default=None)


def _driven(problem: Problem, orders: Sequence[Sequence[int]], wait_s: int, to_dock: dict[tuple[int, str], int] | None) -> Schedule | None:
    drivers, left = Drivers(problem, to_dock), [list(order) for order in orders]
    queue = [(at.clock, r) for r, at in enumerate(drivers.at) if left[r]]
    heapq.heapify(queue)
    while queue:
        _, r = heapq.heappop(queue)
        if not _next(drivers, r, left[r], wait_s):
            return None
        left[r].pop(0)
        if left[r]:
            heapq.heappush(queue, (drivers.at[r].clock, r))
    return drivers.schedule()


def _next(drivers: Drivers, r: int, order: list[int], wait_s: int) -> bool:
    p, robot, at = drivers.problem, drivers.problem.robots[r], drivers.at[r]
    kind, mission = p.types[robot.type], p.missions[order[0]]
    spare = at.level - kind.reserve - drivers.needed(r, order[0], at.place, at.clock)
    onward = drivers.to_dock(r, mission.last) + kind.standby * wait_s if len(order) > 1 else 0
    if spare >= onward and drivers.go(r, order[0], None):
        return True
    rest = _rest(drivers, r, order)
    tries = []
    for c, charger in enumerate(p.chargers):
        way = p.ways[robot.type, at.place, charger.place][0]
        tries.append((drivers.free_from(c, at.clock + way.duration_s), c))
    for _, c in sorted(tries):
        least = kind.reserve + drivers.needed(r, order[0], p.chargers[c].place, at.clock) + onward
        for target in (max(least, min(kind.reserve + rest, p.chargers[c].knee(kind))), kind.capacity):
            if drivers.go(r, order[0], (c, target)):
                return True
    return drivers.go(r, order[0], None)


def _rest(drivers: Drivers, r: int, order: list[int]) -> int:
    """Energy for the rest of an order, without waiting."""
    p, t, place, total = drivers.problem, drivers.problem.robots[r].type, drivers.at[r].place, 0
    for m in order:
        mission = p.missions[m]
        for d in (p.ways[t, place, mission.first][0], mission.drives[t][0]):
            total += _need(d, p.types[t])
        place = mission.last
    return total * 21 // 20


def dispatched(problem: Problem, low: float = 0.2, high: float = 0.9) -> Schedule | None:
    """The dispatcher of the field: the next mission goes to the nearest robot that is free; below 20 % it charges until 90 %."""
    drivers, open_ = Drivers(problem), sorted(range(len(problem.missions)), key=lambda m: (problem.missions[m].ready_s, m))
    for m in open_:
        mission = problem.missions[m]
        allowed = sorted(mission.robots, key=lambda r: (max(drivers.at[r].clock, mission.ready_s), r))
        soonest = max(drivers.at[allowed[0]].clock, mission.ready_s)
        free = [r for r in allowed if max(drivers.at[r].clock, mission.ready_s) <= soonest]
        free.sort(key=lambda r: problem.ways[problem.robots[r].type, drivers.at[r].place, mission.first][0].duration_s)
        if not any(_dispatch(drivers, r, m, low, high) for r in free + [r for r in allowed if r not in free]):
            return None
    return drivers.schedule()


def _dispatch(drivers: Drivers, r: int, m: int, low: float, high: float) -> bool:
    p, robot, at = drivers.problem, drivers.problem.robots[r], drivers.at[r]
    kind = p.types[robot.type]
    after = at.level - drivers.needed(r, m, at.place, at.clock) - drivers.to_dock(r, p.missions[m].last)
    if p.chargers and (at.level < low * kind.capacity or after < kind.reserve):
        near = sorted(range(len(p.chargers)), key=lambda c: p.ways[robot.type, at.place, p.chargers[c].place][0].duration_s)
        return any(drivers.go(r, m, (c, round(high * kind.capacity))) for c in near) or drivers.go(r, m, None)
    return drivers.go(r, m, None)
