"""Orders of missions: their cost without queues at chargers, a greedy insertion, and removals of strings of missions with an
insertion that now and then skips a place [Christiaens2020]."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ._problem import NEVER, Problem

REMOVED = 10  #: missions of one removal, on average
LONGEST = 10  #: of the strings
SKIPPED = 0.01  #: chance that a place of an order is not tried
LATEST = 10_000  #: price of a second after the end of a robot's shift
State = tuple[str, float, float, float]  #: place, clock, used of what the battery holds above the reserve, motion and lateness paid


class Task(NamedTuple):
    """A mission at its cheapest speed; at its quickest it ends ``save_s`` sooner for ``save_price``."""

    first: str
    last: str
    ready_s: int
    due_s: int
    late_price: int
    duration_s: int
    motion: int
    upper: int
    save_s: int
    save_price: int


class Estimate:
    """The cost of orders at the cheapest speeds, where what a battery lacks is charged at once, at the fastest charger."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.ways = {key: (drives[0].duration_s, drives[0].motion, drives[0].upper) for key, drives in problem.ways.items()}
        self.tasks = [{t: Task(x.first, x.last, x.ready_s, x.due_s, x.late_price, d[0].duration_s, d[0].motion, d[0].upper,
                               d[0].duration_s - d[-1].duration_s, d[-1].motion - d[0].motion) for t, d in x.drives.items()}
                      for x in problem.missions]
        self.held = [x.level - problem.kind(r).reserve for r, x in enumerate(problem.robots)]
        self.likeness = [x.likeness() for x in problem.robots]
        self.power = [max((c.power - kind.standby for c in problem.chargers), default=0) for kind in problem.types]

    def start(self, r: int) -> State:
        robot = self.problem.robots[r]
        return robot.start, robot.from_s, 0.0, 0.0

    def walk(self, r: int, at: State, order: Iterable[int]) -> Iterator[State]:
        """The states after each mission of an order."""
        robot, ways, tasks = self.problem.robots[r], self.ways, self.tasks
        t, to_s, standby, power, held = robot.type, robot.to_s, self.problem.kind(r).standby, self.power[robot.type], self.held[r]
        place, clock, used, paid = at
        for m in order:
            first, last, ready_s, due_s, late_price, duration_s, motion, upper, save_s, save_price = tasks[m][t]
            way_s, way_motion, way_upper = ways[t, place, first]
            end = clock + way_s
            if end < ready_s:
                end = ready_s
            end += duration_s
            used += way_upper + upper + standby * (end - clock)
            paid += way_motion + motion
            if used > held:
                end += (used - held) / power if power else NEVER
                used = held
            if end > due_s:
                if save_s and late_price:
                    end, paid = end - save_s, paid + save_price
                if end > due_s:
                    paid += late_price * (end - due_s)
            if end > to_s:
                paid += LATEST * (end - to_s)
            place, clock = last, end
            yield place, clock, used, paid

    def states(self, r: int, order: Iterable[int]) -> list[State]:
        """Before the first mission, and after each one."""
        return [self.start(r), *self.walk(r, self.start(r), order)]

    def cost(self, r: int, order: Sequence[int]) -> float:
        """Of an order, with standby and the robot's use."""
        return self.total(r, self.states(r, order))

    def total(self, r: int, states: Sequence[State]) -> float:
        """Of an order's states."""
        robot = self.problem.robots[r]
        if len(states) == 1:
            return 0.0
        _, clock, _, paid = states[-1]
        return robot.use_price + paid + self.problem.kind(r).standby * (clock - robot.from_s)

    def insertion(self, r: int, order: Sequence[int], states: Sequence[State], m: int, below: float = math.inf,
                  chance: random.Random | None = None) -> tuple[float, int]:
        """The least extra cost of a mission in an order, and its position; (inf, 0) where none costs less than ``below``."""
        robot, best, position = self.problem.robots[r], below, 0
        if robot.type not in self.tasks[m]:
            return math.inf, 0
        task, now, ways, t = self.tasks[m][robot.type], self.total(r, states), self.ways, robot.type
        for n in range(len(order), -1, -1):
            if chance is not None and chance.random() < SKIPPED:
                continue
            place = states[n][0]
            own = task.motion + ways[t, place, task.first][1]
            if n < len(order):
                following = self.tasks[order[n]][t].first
                own += ways[t, task.last, following][1] - ways[t, place, following][1]
            if own >= best:
                continue
            extra = self._extra(r, order, states, m, n, now, best)
            if extra < best:
                best, position = extra, n
        return (best, position) if best < below else (math.inf, 0)

    def _extra(self, r: int, order: Sequence[int], states: Sequence[State], m: int, n: int, now: float, below: float) -> float:
        """Extra cost of a mission at a position. Ends where the rest of the order is as it was, or dearer than ``below``."""
        steps = self.walk(r, states[n], (m, *order[n:]))
        _, clock, _, paid = next(steps)
        for (_, clock, used, paid), (_, clock_before, used_before, paid_before) in zip(steps, states[n + 1:]):
            if paid - paid_before >= below:
                return math.inf
            if clock == clock_before:
                return paid - paid_before + self._charging(r, states[-1][2] + used - used_before)
        robot = self.problem.robots[r]
        return robot.use_price + paid + self.problem.kind(r).standby * (clock - robot.from_s) - now

    def _charging(self, r: int, used: float) -> float:
        """Standby while a robot charges what it uses beyond its battery."""
        short, power = used - self.held[r], self.power[self.problem.robots[r].type]
        return self.problem.kind(r).standby * short / power if power and short > 0 else 0.0


def inserted(problem: Problem) -> list[list[int]]:
    """Orders of missions by insertion where they cost least, from the one that is due first on."""
    estimate = Estimate(problem)
    orders: list[list[int]] = [[] for _ in problem.robots]
    states = [estimate.states(r, ()) for r in range(len(problem.robots))]
    for m in sorted(range(len(problem.missions)), key=lambda m: (problem.missions[m].due_s, m)):
        insert(estimate, orders, states, m)
    return orders


def insert(estimate: Estimate, orders: list[list[int]], states: list[list[State]], m: int, chance: random.Random | None = None) -> None:
    """A mission is inserted where it costs least; of equal robots without missions one is tried. ``chance`` skips places."""
    best, position, robot = math.inf, 0, estimate.problem.missions[m].robots[0]
    empty: set[tuple[object, ...]] = set()
    for r in estimate.problem.missions[m].robots:
        if not orders[r] and estimate.likeness[r] in empty:
            continue
        if not orders[r]:
            empty.add(estimate.likeness[r])
        extra, n = estimate.insertion(r, orders[r], states[r], m, best, chance)
        if extra < best:
            best, position, robot = extra, n, r
    orders[robot].insert(position, m)
    states[robot] = estimate.states(robot, orders[robot])


class Neighborhood:
    """Orders near others."""

    def __init__(self, problem: Problem, chance: random.Random) -> None:
        self.problem, self.chance, self.estimate = problem, chance, Estimate(problem)
        self.near = [sorted(range(len(problem.missions)), key=lambda m: self._far(center, m)) for center in range(len(problem.missions))]

    def _far(self, a: int, b: int) -> float:
        """Missions are near each other where one can follow the other soon."""
        p, one, other = self.problem, self.problem.missions[a], self.problem.missions[b]
        t = next(iter(one.drives))
        ways = [p.ways[t, x, y][0].duration_s for x, y in ((one.last, other.first), (other.last, one.first)) if (t, x, y) in p.ways]
        return min(ways, default=0) + 0.1 * abs(one.ready_s - other.ready_s) if a != b else -1.0

    def of(self, orders: Sequence[Sequence[int]]) -> list[list[int]]:
        """Orders with some strings of missions taken out and inserted anew."""
        left = [list(order) for order in orders]
        taken = self._taken_out(left)
        states = [self.estimate.states(r, order) for r, order in enumerate(left)]
        self._sort(taken)
        for m in taken:
            insert(self.estimate, left, states, m, self.chance)
        return left

    def _taken_out(self, orders: list[list[int]]) -> list[int]:
        """Strings of some routes, near a mission, are removed from the orders."""
        used = sum(1 for order in orders if order)
        longest = max(1.0, min(LONGEST, len(self.problem.missions) / max(1, used)))
        strings = int(self.chance.uniform(1, 4 * REMOVED / (1 + longest)))
        where = {m: r for r, order in enumerate(orders) for m in order}
        touched, taken = set(), []  # type: tuple[set[int], list[int]]
        for m in self.near[self.chance.randrange(len(self.near))]:
            r = where[m]
            if r in touched:
                continue
            touched.add(r)
            length = int(self.chance.uniform(1, 1 + min(longest, len(orders[r]))))
            at = orders[r].index(m)
            first = self.chance.randint(max(0, at - length + 1), min(at, len(orders[r]) - length))
            taken += orders[r][first:first + length]
            del orders[r][first:first + length]
            if len(touched) >= strings:
                break
        return taken

    def _sort(self, taken: list[int]) -> None:
        missions = self.problem.missions
        self.chance.shuffle(taken)
        rule = self.chance.choice(("random", "due", "ready", "long"))
        if rule == "due":
            taken.sort(key=lambda m: missions[m].due_s)
        elif rule == "ready":
            taken.sort(key=lambda m: missions[m].ready_s)
        elif rule == "long":
            taken.sort(key=lambda m: -max(d[0].motion for d in missions[m].drives.values()))
