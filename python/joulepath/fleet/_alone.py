"""Each robot alone, as if no other one used the chargers: what each set of missions costs it at least, and which sets the robots
of a schedule can have that costs no more than a known one. For few missions: the sets are enumerated.

Labels are extended by one mission at a time (set, last mission, end, energy used, paid). A charge counts when a battery lacks it,
not before, and takes the time of constant power; time that a robot waits after a visit charges, too. So no label ends later, has
used more or has paid more than the route that it stands for.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ._bound import FAR, Limits
from ._problem import Problem

MOST_MISSIONS = 14
MOST_LABELS = 60_000  #: of one robot and one number of missions
Array = Any
Choice = tuple[int, int, int, int, int, int]


@dataclass(frozen=True)
class Sets:
    """Of each robot: sets of missions, as bits, with the least that each costs it alone."""

    costs: tuple[dict[int, int], ...]
    bound: int  #: of the cost of all robots


@dataclass
class _Labels:
    """Arrays of equal lengths."""

    mask: Array
    node: Array  #: 0 is the start, m + 1 a mission
    power: Array  #: of the fastest charger that was visited, net of standby; 0: none
    end: Array
    used: Array
    paid: Array

    def pick(self, where: Array) -> _Labels:
        return _Labels(*(getattr(self, name)[where] for name in self.__dataclass_fields__))


def sets_of(problem: Problem, most: int, limits: Limits) -> Sets | None:
    """None for more than ``MOST_MISSIONS`` missions, or too many labels."""
    if len(problem.missions) > MOST_MISSIONS:
        return None
    rest, tables = _rest(limits), {}  # type: tuple[Array, dict[Any, Array]]
    costs = []
    for r in range(len(problem.robots)):
        key = problem.likeness(r)
        if key not in tables:
            table = _Robot(problem, r, most, rest).table()
            if table is None:
                return None
            tables[key] = table
        costs.append(tables[key])
    return _surviving(costs, most)


def _rest(limits: Limits) -> Array:
    """What the missions that a set lacks cost at least."""
    count = len(limits.problem.missions)
    least = [limits.least(m) for m in range(count)]
    masks = np.arange(1 << count)
    return sum(np.where(masks >> m & 1, 0, least[m]) for m in range(count))


class _Robot:
    def __init__(self, problem: Problem, r: int, most: int, rest: Array) -> None:
        self.problem, self.r, self.most, self.rest = problem, r, most, rest
        self.robot, self.kind = problem.robots[r], problem.kind(r)
        self.held = self.robot.level - self.kind.reserve
        self.steps = {m: self._steps(m) for m, x in enumerate(problem.missions) if r in x.robots}

    def _steps(self, m: int) -> Array:
        """Ways from each node to a mission, with its speeds: way's and mission's seconds, motion, energy, power of a visit, energy to
        its charger. Shape (6, nodes, choices)."""
        p, t, mission = self.problem, self.robot.type, self.problem.missions[m]
        rows: list[list[Choice]] = []
        for node in range(len(p.missions) + 1):
            place = self.robot.start if node == 0 else p.missions[node - 1].last
            choices: list[Choice] = []
            possible = node == 0 or (node != m + 1 and self.r in p.missions[node - 1].robots)
            for d in mission.drives[t] if possible else ():
                for way in p.ways[t, place, mission.first]:
                    choices.append((way.duration_s, d.duration_s, way.motion + d.motion, way.upper + d.upper, 0, 0))
                for c in p.chargers:
                    to, way = p.ways[t, place, c.place][0], p.ways[t, c.place, mission.first][0]
                    choices.append((to.duration_s + way.duration_s, d.duration_s, to.motion + way.motion + d.motion,
                                    to.upper + way.upper + d.upper, c.power - self.kind.standby,
                                    to.upper + self.kind.standby * to.duration_s))
            rows.append(_useful(choices))
        longest = max(1, max(map(len, rows)))
        padded = [row + [(0, 0, FAR, 0, 0, 0)] * (longest - len(row)) for row in rows]
        return np.moveaxis(np.array(padded, dtype=np.int64), 2, 0)

    def table(self) -> Array | None:
        """The least cost of each set of missions; ``FAR``: dearer than the known schedule."""
        found = np.full(len(self.rest), FAR, dtype=np.int64)
        found[0] = 0
        zero = np.zeros(1, dtype=np.int64)
        labels = _Labels(zero, zero, zero, zero + self.robot.from_s, zero, zero + self.robot.use_price)
        while len(labels.mask):
            parts = [self._extended(labels.pick((labels.mask >> m & 1) == 0), m) for m in self.steps]
            if not parts:
                break
            labels = _undominated(_Labels(*(np.concatenate([getattr(x, name) for x in parts]) for name in labels.__dataclass_fields__)),
                                  self.kind.standby)
            if len(labels.mask) > MOST_LABELS:
                return None
            np.minimum.at(found, labels.mask, self._total(labels))
        return found

    def _total(self, labels: _Labels) -> Array:
        return labels.paid + self.kind.standby * (labels.end - self.robot.from_s)

    def _extended(self, labels: _Labels, m: int) -> _Labels:
        """Labels with one mission more, by each way and speed that is possible and not too dear."""
        mission, standby = self.problem.missions[m], self.kind.standby
        way_s, own_s, motion, upper, visit, to_dock = self.steps[m][:, labels.node, :]
        before, used = labels.end[:, None], labels.used[:, None]
        power = np.maximum(labels.power[:, None], visit)
        start = np.maximum(before + way_s, mission.ready_s)
        end = start + own_s
        gained = np.where(power > 0, (power + standby) * (start - before - way_s), 0)
        after = np.maximum(used + upper + standby * (end - before) - gained, self.robot.level - self.kind.capacity)
        short = np.maximum(0, after - self.held)
        end = end + short // np.maximum(power, 1)
        paid = labels.paid[:, None] + motion + mission.late_price * np.maximum(0, end - mission.due_s)
        possible = (motion < FAR) & (end <= self.robot.to_s) & ((short == 0) | (power > 0))
        possible &= (visit == 0) | (labels.power[:, None] > 0) | (used + to_dock <= self.held)
        mask = np.broadcast_to((labels.mask | 1 << m)[:, None], end.shape)
        possible &= paid + standby * (end - self.robot.from_s) + self.rest[mask] <= self.most
        node = np.full(end.shape, m + 1, dtype=np.int64)
        return _Labels(*(x[possible] for x in (mask, node, power, end, np.minimum(after, self.held), paid)))


def _useful(choices: list[Choice]) -> list[Choice]:
    """Without those that another one beats: it ends sooner, whenever it begins, and spends and pays no more."""
    kept: list[Choice] = []
    for x in sorted(set(choices), key=lambda x: (x[2], x[0] + x[1], x[1])):
        if not any(y[1] <= x[1] and y[0] + y[1] <= x[0] + x[1] and y[2] <= x[2] and y[3] <= x[3] and y[4] >= x[4] and y[5] <= x[5]
                   for y in kept):
            kept.append(x)
    return kept


def _undominated(labels: _Labels, standby: int) -> _Labels:
    """Of each set and last mission, labels that no other one beats in end, energy without standby, price and power."""
    energy = labels.used - standby * labels.end
    order = np.lexsort((energy, labels.end, labels.paid, labels.node, labels.mask))
    rows = zip(order.tolist(), *(x[order].tolist() for x in (labels.mask, labels.node, labels.paid, labels.end, energy, labels.power)))
    kept: list[int] = []
    group, front = (-1, -1), []  # type: tuple[tuple[int, int], list[tuple[int, int, int]]]
    for index, mask, node, _, end, spent, power in rows:
        if (mask, node) != group:
            group, front = (mask, node), []
        if not any(a <= end and b <= spent and c >= power for a, b, c in front):
            front.append((end, spent, power))
            kept.append(index)
    return labels.pick(np.array(kept, dtype=np.int64))


def _surviving(costs: list[Array], most: int) -> Sets:
    """Sets with which the cheapest sets of all other robots complete a schedule that is not too dear."""
    everything = len(costs[0]) - 1
    kept, bound = [], FAR
    for r, mine in enumerate(costs):
        others = _together([x for k, x in enumerate(costs) if k != r], len(mine))
        masks = np.flatnonzero(mine < FAR)
        totals = mine[masks] + others[everything ^ masks]
        bound = min(bound, int(totals.min(initial=FAR)))
        kept.append({int(mask): int(mine[mask]) for mask in masks[totals <= most]})
    return Sets(tuple(kept), bound)


def _together(costs: list[Array], size: int) -> Array:
    """The least cost of each set, divided among robots."""
    total = np.full(size, FAR, dtype=np.int64)
    total[0] = 0
    masks = np.arange(size)
    for mine in costs:
        after = total.copy()
        done = masks[total < FAR]
        for mask in np.flatnonzero(mine < FAR)[1:]:
            apart = done[(done & mask) == 0]
            after[apart | mask] = np.minimum(after[apart | mask], total[apart] + mine[mask])
        total = after
    return total
