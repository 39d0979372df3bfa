"""Each robot alone, as if no other one used the chargers: what each set of missions costs it at least, and which sets the robots
of a schedule can have that costs no more than a known one. For few missions: the sets are enumerated.

Labels are extended by one mission at a time (set, last mission, end, energy used, paid). A charge grows, in whole seconds, when a
battery lacks it, and delays the missions since, as far as no wait takes that up. It has constant power and no end; the fastest of
several chargers counts. So no label ends later, has used more or has paid more than the route that it stands for.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ._bound import FAR, drive_cost, late_cost, way_cost
from ._problem import Problem

MOST_MISSIONS = 14
MOST_LABELS = 300_000
WEIGHTS = ((1, 100, 0.1), (1, 100, 1), (1, 1000, 0.1), (10, 100, 0.1), (0.1, 10, 1))  #: of price, end and energy
FREE = 10**9  #: s, no limit
Array = Any
Choice = tuple[int, int, int, int, int, int, int, int, int]
Leg = tuple[int, int, int, int]  #: mission, way, speed, charger or -1


@dataclass(frozen=True)
class Sets:
    """Of each robot: sets of missions, as bits, with the least that each costs it alone."""

    costs: tuple[dict[int, int], ...]
    bound: int  #: of the cost of all robots; dearer than asked: there is no division
    least: tuple[Array, ...]  #: of each robot: what each set of missions costs it at least
    labels: int  #: that were left
    routes: tuple[tuple[Leg, ...], ...] = ()  #: of the cheapest division


@dataclass
class _Labels:
    """Arrays of equal lengths."""

    mask: Array
    node: Array  #: 0 is the start, m + 1 a mission
    power: Array  #: of the fastest charger that was visited, net of standby; 0: none
    end: Array
    used: Array
    paid: Array
    wait: Array  #: so many seconds longer the last charge can be, and the end stays
    slack: Array  #: of each mission: so many seconds longer the last charge can be before the mission is late; ``FREE``: before it
    parent: Array  #: the label of one mission less
    choice: Array  #: of the ways and speeds of the last mission

    def pick(self, where: Array) -> _Labels:
        return _Labels(*(getattr(self, name)[where] for name in self.__dataclass_fields__))


def sets_of(problem: Problem, most: int, before: Sequence[Array] | None = None, labels: int = MOST_LABELS) -> Sets | None:
    """None for more than ``MOST_MISSIONS`` missions, or more labels. ``before``: ``least`` of a search below a lower cost."""
    if len(problem.missions) > MOST_MISSIONS:
        return None
    costs = list(before or _untimed_costs(problem))
    least, done = list(costs), {}  # type: list[Array], dict[Any, tuple[_Robot, Array]]
    for r in range(len(problem.robots)):
        key = problem.likeness(r)
        if key not in done:
            others = _together([x for k, x in enumerate(costs) if k != r], 1 << len(problem.missions))
            done[key] = _Robot(problem, r, most, _onward(_untimed(problem, r), others)), others
            left = done[key][0].drive(labels)
            if left < 0:
                return None
            labels = left
        costs[r] = done[key][0].costs
        least[r] = np.where(costs[r] < FAR, costs[r], np.maximum(least[r], most + 1 - done[key][1][::-1]))  # of the missions that are left
    sets = _surviving(costs, least, most, labels)
    if sets.bound > most:
        return sets
    divided = zip(range(len(costs)), _divided(costs))
    return replace(sets, routes=tuple(done[problem.likeness(r)][0].route(mask) for r, mask in divided))


def _untimed_costs(problem: Problem) -> list[Array]:
    """Of each robot: what each set of missions costs it at least, without times and batteries."""
    nothing = np.full(1 << len(problem.missions), FAR, dtype=np.int64)
    nothing[0] = 0
    return [np.minimum(_onward(_untimed(problem, r), nothing)[0], FAR) for r in range(len(problem.robots))]


def _divided(costs: list[Array]) -> list[int]:
    """The sets of the cheapest division."""
    found, left = [], len(costs[0]) - 1
    for r, mine in enumerate(costs):
        others, masks = _together(costs[r + 1:], len(mine)), np.flatnonzero(mine < FAR)
        masks = masks[(masks & ~left) == 0]
        found.append(int(masks[(mine[masks] + others[left ^ masks]).argmin()]))
        left ^= found[-1]
    return found


def untimed_bound(problem: Problem) -> int:
    """The least cost without times, batteries and queues; 0 for more than ``MOST_MISSIONS`` missions."""
    small = len(problem.missions) <= MOST_MISSIONS
    return int(_together(_untimed_costs(problem), 1 << len(problem.missions))[-1]) if small else 0


def _untimed(problem: Problem, r: int) -> Array:
    """The least cost of each way of a robot with the mission after it, whenever that is; ``FAR``: not its own. Row 0 is its start."""
    robot, count = problem.robots[r], len(problem.missions)
    found = np.full((count + 1, count), FAR, dtype=np.int64)
    for m, mission in enumerate(problem.missions):
        if r in mission.robots:
            own = min(drive_cost(d, problem.kind(r)) for d in mission.drives[robot.type]) + late_cost(problem, m)
            found[0, m] = robot.use_price + way_cost(problem, robot.type, robot.start, mission.first, drive_cost) + own
            for k, before in enumerate(problem.missions):
                if k != m and r in before.robots:
                    found[k + 1, m] = way_cost(problem, robot.type, before.last, mission.first, drive_cost) + own
    return found


def _onward(steps: Array, others: Array) -> Array:
    """The least cost of each set of missions that are left, from each node on: by this robot, and by others when it has ended.
    Shape (nodes, sets)."""
    count = steps.shape[1]
    found, masks = np.tile(others, (count + 1, 1)), np.arange(1 << count)
    sizes = sum(masks >> m & 1 for m in range(count))
    for size, m in itertools.product(range(1, count + 1), range(count)):
        left = masks[(sizes == size) & (masks >> m & 1 == 1)]
        found[:, left] = np.minimum(found[:, left], steps[:, m, None] + found[m + 1, left ^ 1 << m])
    return found


class _Robot:
    def __init__(self, problem: Problem, r: int, most: int, rest: Array) -> None:
        """``rest``: what the missions that are left cost at least, from each node on."""
        self.problem, self.r, self.most, self.rest = problem, r, most, rest
        self.robot, self.kind = problem.robots[r], problem.kind(r)
        self.held = self.robot.level - self.kind.reserve
        self.prices = np.array([x.late_price for x in problem.missions], dtype=np.int64)
        self.steps = {m: self._steps(m) for m, x in enumerate(problem.missions) if r in x.robots}

    def _steps(self, m: int) -> Array:
        """Ways from each node to a mission, with its speeds: way's and mission's seconds, motion, energy, power of a visit, energy to
        its charger; then way, speed, and charger or -1. Shape (9, nodes, choices)."""
        p, t, mission = self.problem, self.robot.type, self.problem.missions[m]
        rows: list[list[Choice]] = []
        for node in range(len(p.missions) + 1):
            place = self.robot.start if node == 0 else p.missions[node - 1].last
            choices: list[Choice] = []
            possible = node == 0 or (node != m + 1 and self.r in p.missions[node - 1].robots)
            for speed, d in enumerate(mission.drives[t] if possible else ()):
                for k, way in enumerate(p.ways[t, place, mission.first]):
                    choices.append((way.duration_s, d.duration_s, way.motion + d.motion, way.upper + d.upper, 0, 0, k, speed, -1))
                for number, c in enumerate(p.chargers):
                    to, way = p.ways[t, place, c.place][0], p.ways[t, c.place, mission.first][0]
                    choices.append((to.duration_s + way.duration_s, d.duration_s, to.motion + way.motion + d.motion,
                                    to.upper + way.upper + d.upper, c.power - self.kind.standby,
                                    to.upper + self.kind.standby * to.duration_s, 0, speed, number))
            rows.append(_useful(choices))
        longest = max(1, max(map(len, rows)))
        padded = [row + [(0, 0, FAR, 0, 0, 0, 0, 0, 0)] * (longest - len(row)) for row in rows]
        return np.moveaxis(np.array(padded, dtype=np.int64), 2, 0)

    def drive(self, most_labels: int) -> int:
        """Finds ``costs``, the least of each set of missions; ``FAR``: dearer than the known schedule. Returns how many labels are
        left; negative: too many."""
        self.costs = np.full(self.rest.shape[1], FAR, dtype=np.int64)
        self.costs[0] = 0
        zero = np.zeros(1, dtype=np.int64)
        self.layers = [_Labels(zero, zero, zero, zero + self.robot.from_s, zero, zero + self.robot.use_price, zero,
                               np.zeros((1, len(self.prices)), dtype=np.int32), zero, zero)]
        while True:
            labels = self.layers[-1]
            parts = [self._extended(labels, np.flatnonzero((labels.mask >> m & 1) == 0), m) for m in self.steps]
            if not sum(len(x.mask) for x in parts):
                return most_labels
            labels = _undominated(_Labels(*(np.concatenate([getattr(x, name) for x in parts]) for name in labels.__dataclass_fields__)),
                                  self.kind.standby)
            most_labels -= len(labels.mask)
            if most_labels < 0:
                return most_labels
            np.minimum.at(self.costs, labels.mask, self._total(labels))
            self.layers.append(labels)

    def route(self, mask: int) -> tuple[Leg, ...]:
        """The cheapest route of a set."""
        legs: list[Leg] = []
        size = mask.bit_count()
        last = self.layers[size]
        index = int(np.flatnonzero((last.mask == mask) & (self._total(last) == (self.costs[mask] if size else self.robot.use_price)))[0])
        for n in range(size, 0, -1):
            node, parent, choice = (int(getattr(self.layers[n], name)[index]) for name in ("node", "parent", "choice"))
            way, speed, charger = (int(x) for x in self.steps[node - 1][6:, int(self.layers[n - 1].node[parent]), choice])
            legs.append((node - 1, way, speed, charger))
            index = parent
        return tuple(reversed(legs))

    def _total(self, labels: _Labels) -> Array:
        return labels.paid + self.kind.standby * (labels.end - self.robot.from_s)

    def _extended(self, all_labels: _Labels, these: Array, m: int) -> _Labels:
        """Labels with one mission more, by each way and speed that is possible and not too dear."""
        mission, standby, labels = self.problem.missions[m], self.kind.standby, all_labels.pick(these)
        way_s, own_s, motion, upper, visit, to_dock = self.steps[m][:6, labels.node, :]
        possible = (motion < FAR) & ((visit == 0) | (labels.power[:, None] > 0) | (labels.used[:, None] + to_dock <= self.held))
        start = np.maximum(labels.end[:, None] + way_s, mission.ready_s)
        cost = labels.paid[:, None] + motion + standby * (start + own_s - self.robot.from_s)
        possible &= cost + self._left(labels.mask, m)[:, None] <= self.most
        row, choice = np.nonzero(possible)
        start, own_s, visit, way_s = start[row, choice], own_s[row, choice], visit[row, choice], way_s[row, choice]
        before, paid, end = labels.end[row], labels.paid[row] + motion[row, choice], start + own_s
        power = np.maximum(labels.power[row], visit)
        wait = np.where(power > 0, labels.wait[row] + start - before - way_s, 0)
        slack = np.where((visit > 0)[:, None], np.int32(FREE), labels.slack[row])
        used = labels.used[row] + upper[row, choice] + standby * (end - before)
        short, per_s = np.maximum(0, used - self.held), np.maximum(power, 1)
        within_s = np.minimum(wait, -(-short // (per_s + standby)))
        beyond_s = -(-np.maximum(0, short - (per_s + standby) * within_s) // per_s)
        longer_s, end = within_s + beyond_s, end + beyond_s
        longer = np.flatnonzero(longer_s)
        paid[longer] += np.maximum(0, longer_s[longer, None] - slack[longer]) @ self.prices
        paid = paid + mission.late_price * np.maximum(0, end - mission.due_s)
        slack = np.maximum(0, slack - longer_s[:, None].astype(np.int32))
        slack[:, m] = np.where(power > 0, wait - within_s + np.maximum(0, mission.due_s - end), 0)
        kept = (end <= self.robot.to_s) & ((short == 0) | (power > 0))
        kept &= paid + standby * (end - self.robot.from_s) + self._left(labels.mask[row], m) <= self.most
        used = used - (per_s + standby) * within_s - per_s * beyond_s
        node = np.full(len(row), m + 1, dtype=np.int64)
        values = labels.mask[row] | 1 << m, node, power, end, used, paid, wait - within_s, slack, these[row], choice
        return _Labels(*(x[kept] for x in values))

    def _left(self, masks: Array, m: int) -> Array:
        """What is left costs at least, after one mission more."""
        return self.rest[m + 1, (self.rest.shape[1] - 1) ^ (masks | 1 << m)]


def _useful(choices: list[Choice]) -> list[Choice]:
    """Without those that another one beats: it ends sooner, whenever it begins, and spends and pays no more."""
    kept: list[Choice] = []
    for x in sorted(set(choices), key=lambda x: (x[2], x[0] + x[1], x[1])):
        if not any(y[1] <= x[1] and y[0] + y[1] <= x[0] + x[1] and y[2] <= x[2] and y[3] <= x[3] and y[4] >= x[4] and y[5] <= x[5]
                   for y in kept):
            kept.append(x)
    return kept


def _undominated(labels: _Labels, standby: int) -> _Labels:
    """Of each set and last mission, labels that no other one beats in price, end, energy without standby, power and delays that
    cost nothing."""
    energy = labels.used - standby * labels.end
    order = np.lexsort((-labels.power, energy, labels.end, labels.paid, labels.node, labels.mask))
    group = ((labels.mask << 5) + labels.node)[order]  # nodes are fewer than 32
    values = [x[order] for x in (labels.paid, labels.end, energy, -labels.power, labels.end - labels.wait, *-labels.slack.T)]
    kept = _cheaper_than_the_best(group, values)
    for lags in (4, 32, len(order)):  # the first that can beat a label are beside it
        kept = kept[_lagged(group[kept], [x[kept] for x in values], lags)]
    return labels.pick(order[kept])


def _cheaper_than_the_best(group: Array, values: Sequence[Array]) -> Array:
    """Without labels that the best of their group by some weights beat."""
    begins = np.flatnonzero(np.diff(group, prepend=-1))
    number, kept = np.cumsum(np.diff(group, prepend=-1) != 0) - 1, np.ones(len(group), dtype=bool)
    for weights in WEIGHTS:
        score = sum(weight * row for weight, row in zip(weights, values))
        best = np.flatnonzero(score == np.minimum.reduceat(score, begins)[number])
        champion = best[np.flatnonzero(np.diff(number[best], prepend=-1))][number]
        beaten = np.flatnonzero(kept & (champion != np.arange(len(group))))
        kept[_beaten(values, champion[beaten], beaten)] = False
    return np.flatnonzero(kept)


def _beaten(values: Sequence[Array], better: Array, worse: Array) -> Array:
    """The worse of pairs, where it is beaten in all values."""
    for row in values:
        pairs = np.flatnonzero(row[better] <= row[worse])
        better, worse = better[pairs], worse[pairs]
    return worse


def _lagged(group: Array, values: Sequence[Array], lags: int) -> Array:
    """Which labels none of so many before them beats; sorted labels are beaten by earlier ones alone, which are no dearer."""
    begins = np.diff(group, prepend=-1) != 0
    place = np.arange(len(group)) - np.flatnonzero(begins)[np.cumsum(begins) - 1]
    kept, left = np.ones(len(group), dtype=bool), np.arange(len(group))
    for lag in range(1, lags + 1):
        left = left[place[left] >= lag]
        if not len(left):
            break
        kept[_beaten(values[1:], left - lag, left)] = False
        left = left[kept[left]]
    return kept


def _surviving(costs: list[Array], least: list[Array], most: int, labels: int) -> Sets:
    """Sets with which the cheapest sets of all other robots complete a schedule that is not too dear."""
    everything = len(costs[0]) - 1
    kept, bound = [], FAR
    for r, mine in enumerate(costs):
        others = _together([x for k, x in enumerate(costs) if k != r], len(mine))
        masks = np.flatnonzero(mine < FAR)
        totals = mine[masks] + others[everything ^ masks]
        bound = min(bound, int(totals.min(initial=FAR)))
        kept.append({int(mask): int(mine[mask]) for mask in masks[totals <= most]})
    return Sets(tuple(kept), bound, tuple(least), labels)


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
