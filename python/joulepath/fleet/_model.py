"""The fleet as a constraint program: a tour through all robots and their missions, for CP-SAT of OR-tools.

Robots and missions are the nodes of one circuit: the missions between two robots' nodes are those of the first of them.
A visit of a charger belongs to the node after which it happens. Levels of batteries are lower bounds of 95 %.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

from ortools.sat.python import cp_model

from ._alone import Leg, Sets
from ._bound import Limits
from ._charging import add_chargers
from ._cuts import add_cuts, add_sets
from ._problem import Drive, Problem


class Node:
    """A robot's start, or a mission's end: the place from which a robot leaves."""

    def __init__(self, index: int, place: str, end: Any, level: Any) -> None:
        self.index, self.place, self.end, self.level = index, place, end, level
        self.visits: dict[tuple[int, int], Any] = {}  # type, charger -> literal
        self.begin = self.charge = self.done = self.arrives = self.target = None  # type: Any  # of a visit


class FleetModel:
    """Variables, constraints and cost of a problem."""

    def __init__(self, problem: Problem, most: int | None = None, sets: Sets | None = None,
                 routes: Sequence[Sequence[Leg]] | None = None) -> None:
        """``most``: the cost of a known schedule; dearer ones are left out, and so are sets of missions but ``sets``. ``routes``: all but
        times."""
        self.problem, self.model = problem, cp_model.CpModel()
        self.limits = Limits(problem, most)
        self.horizon = min(problem.horizon_s(), max(x.from_s for x in problem.robots) + self.limits.present_s + 1)
        self.robots, self.missions = range(len(problem.robots)), range(len(problem.missions))
        self.most = max(kind.capacity for kind in problem.types)
        self.equals = [(a, b) for group in problem.equals() for a, b in zip(group, group[1:])]
        self.cost: list[Any] = []
        self.busy_s: list[Any] = []  # durations of everything that robots do
        self.spent: list[Any] = []  # upper bounds of their energies
        self.gained: list[Any] = []
        self.bought: list[Any] = []
        self.charging: list[Any] = []
        self.arcs: list[tuple[int, int, Any]] = []
        self.taken: dict[tuple[int, int, int, int, int], Any] = {}  # node, mission, type, charger or -1, way -> literal
        self.only = None if routes is None else {(r if n == 0 else len(self.robots) + route[n - 1][0], leg[0], c, way)
                                                 for r, route in enumerate(routes) for n, leg in enumerate(route)
                                                 for way, c in [(leg[1], leg[3])]}
        self._add_missions()
        for j, _, speed, _ in itertools.chain.from_iterable(routes or ()):
            self.model.add_exactly_one(v for (_, k), v in self.speed[j].items() if k == speed)
        self._add_robots()
        for node in self.nodes:
            self._add_visit(node)
            for j in self.missions:
                if node.index != len(self.robots) + j:
                    self._add_ways(node, j)
        self._add_types_of_ways()
        self._add_ends()
        add_chargers(self)
        self.model.add_circuit(self.arcs)
        add_cuts(self)
        self.low = self.limits.low
        if sets is not None:
            self.low = max(self.low, sets.bound)
            add_sets(self, sets)
        if most is not None:
            self.model.add(sum(self.cost) <= most)
        self.model.minimize(sum(self.cost))

    def _add_missions(self) -> None:
        m, p = self.model, self.problem
        self.soonest = [min(self.horizon, self.limits.soonest_start(j)) for j in self.missions]
        self.latest = [min(self.horizon, self.limits.latest_end(j)) for j in self.missions]
        self.start = [m.new_int_var(self.soonest[j], self.horizon, f"start{j}") for j in self.missions]
        self.level = [m.new_int_var(0, self.most, f"level{j}") for j in self.missions]
        self.assigned = [{r: m.new_bool_var(f"robot{r}_{j}") for r in x.robots} for j, x in enumerate(p.missions)]
        self.speed: list[dict[tuple[int, int], Any]] = []
        self.nodes: list[Node] = []
        for j, mission in enumerate(p.missions):
            m.add_exactly_one(self.assigned[j].values())
            speed = {(t, k): m.new_bool_var(f"speed{j}_{t}_{k}") for t, drives in mission.drives.items() for k in range(len(drives))
                     if self.limits.speed(j, t, k)}
            for t in mission.drives:
                m.add(sum(v for (u, _), v in speed.items() if u == t) ==
                      sum(v for r, v in self.assigned[j].items() if p.robots[r].type == t))
            self.speed.append(speed)
            self._add_mission_energy(j)

    def _add_mission_energy(self, j: int) -> None:
        m, p, mission = self.model, self.problem, self.problem.missions[j]
        drives = [(v, mission.drives[t][k], p.types[t]) for (t, k), v in self.speed[j].items()]
        duration = sum(v * d.duration_s for v, d, _ in drives)
        need = sum(v * (d.upper + kind.standby * d.duration_s) for v, d, kind in drives)
        end = m.new_int_var(0, self.latest[j], f"end{j}")
        m.add(end == self.start[j] + duration)
        after = m.new_int_var(0, self.most, f"after{j}")
        m.add(after == self.level[j] - need)
        m.add(after >= sum(v * kind.reserve for v, _, kind in drives))
        self.cost += [v * d.motion for v, d, _ in drives]
        self.busy_s.append(duration)
        self.spent += [v * d.upper for v, d, _ in drives]
        if mission.late_price and mission.due_s < self.horizon:
            late = m.new_int_var(0, max(0, self.latest[j] - mission.due_s), f"late{j}")
            m.add(late >= end - mission.due_s)
            self.cost.append(mission.late_price * late)
        for r, literal in self.assigned[j].items():
            if p.robots[r].to_s < self.horizon:
                m.add(end <= p.robots[r].to_s).only_enforce_if(literal)
        self.nodes.append(Node(len(self.robots) + j, mission.last, end, after))

    def _add_robots(self) -> None:
        p, m = self.problem, self.model
        starts = [Node(r, x.start, x.from_s, x.level) for r, x in enumerate(p.robots)]
        self.nodes = starts + self.nodes
        self.unused = [m.new_bool_var(f"unused{r}") for r in self.robots]
        self.finish = [m.new_int_var(min(x.from_s, self.horizon), self.horizon, f"finish{r}") for r, x in enumerate(p.robots)]
        for r, robot in enumerate(p.robots):
            self.cost.append(p.kind(r).standby * (self.finish[r] - robot.from_s) + robot.use_price * (1 - self.unused[r]))
            for j in self.missions:
                if r in self.assigned[j]:
                    m.add_implication(self.unused[r], ~self.assigned[j][r])

    def _types(self, node: Node, j: int) -> list[int]:
        """Types of robots that may go from a node to a mission."""
        if node.index < len(self.robots):
            t = self.problem.robots[node.index].type
            return [t] if node.index in self.assigned[j] else []
        before = self.problem.missions[node.index - len(self.robots)].drives
        return [t for t in self.problem.missions[j].drives if t in before]

    def _add_visit(self, node: Node) -> None:
        m, i = self.model, node.index
        node.begin = m.new_int_var(0, self.horizon, f"begin{i}")
        node.charge = m.new_int_var(0, self.horizon, f"charge{i}")
        node.done = m.new_int_var(0, self.horizon, f"done{i}")
        node.arrives = m.new_int_var(0, self.most, f"arrives{i}")
        node.target = m.new_int_var(0, self.most, f"target{i}")

    def _add_ways(self, node: Node, j: int) -> None:
        """The ways from a node to a mission: direct at several speeds, or by a charger."""
        m, p, mission = self.model, self.problem, self.problem.missions[j]
        literals: list[Any] = []
        for t in self._types(node, j):
            standby = p.types[t].standby
            for k, way in enumerate(p.ways[t, node.place, mission.first]):
                if not self._possible(node, j, t, -1, k):
                    continue
                literal = self._taken(literals, node, j, t, -1, k, way)
                m.add(self.start[j] >= node.end + way.duration_s).only_enforce_if(literal)
                m.add(self.level[j] <= node.level - way.upper - standby * (self.start[j] - node.end)).only_enforce_if(literal)
            for c, charger in enumerate(p.chargers):
                way = p.ways[t, charger.place, mission.first][0]
                if not self._possible(node, j, t, c, 0):
                    continue
                literal = self._taken(literals, node, j, t, c, 0, way)
                m.add(self.start[j] >= node.done + way.duration_s).only_enforce_if(literal)
                m.add(self.level[j] <= node.target - way.upper
                      - standby * (self.start[j] - node.done)).only_enforce_if(literal)
        if not literals:
            return
        arc = m.new_bool_var(f"arc{node.index}_{j}")
        m.add(sum(literals) == arc)
        self.arcs.append((node.index, len(self.robots) + j, arc))
        self._add_same_robot(node, j, arc)

    def _add_types_of_ways(self) -> None:
        """A way to a mission is one of its robot's type."""
        for j, mission in enumerate(self.problem.missions):
            for t in mission.drives:
                ways = [v for (_, k, u, _, _), v in self.taken.items() if (k, u) == (j, t)]
                self.model.add(sum(ways) == sum(v for r, v in self.assigned[j].items() if self.problem.robots[r].type == t))

    def _possible(self, node: Node, j: int, t: int, c: int, k: int) -> bool:
        """Whether a way is cheap enough, and short enough for the latest end of its mission."""
        if not self.limits.way((node.index, j), t, c, k) or (self.only is not None and (node.index, j, c, k) not in self.only):
            return False
        p, first = self.problem, self.problem.missions[j].first
        before = node.index - len(self.robots)
        leaves = p.robots[node.index].from_s if before < 0 else self.soonest[before] + _shortest(p, before)
        place = node.place if c < 0 else p.chargers[c].place
        way_s = p.ways[t, place, first][k].duration_s + (0 if c < 0 else p.ways[t, node.place, place][0].duration_s)
        return leaves + way_s + min(d.duration_s for d in p.missions[j].drives[t]) <= self.latest[j]

    def _taken(self, literals: list[Any], node: Node, j: int, t: int, c: int, k: int, way: Drive) -> Any:
        literal = self.model.new_bool_var(f"way{node.index}_{j}_{t}_{c}_{k}")
        literals.append(literal)
        self.taken[node.index, j, t, c, k] = literal
        self.cost.append(literal * way.motion)
        self.busy_s.append(literal * way.duration_s)
        self.spent.append(literal * way.upper)
        return literal

    def _add_same_robot(self, node: Node, j: int, arc: Any) -> None:
        m = self.model
        if node.index < len(self.robots):
            m.add_implication(arc, self.assigned[j][node.index])
            return
        before = self.assigned[node.index - len(self.robots)]
        for r in self.robots:
            here, there = before.get(r), self.assigned[j].get(r)
            if here is not None and there is not None:
                m.add(here == there).only_enforce_if(arc)
            elif here is not None:
                m.add_implication(arc, ~here)
            elif there is not None:
                m.add_implication(arc, ~there)

    def _add_ends(self) -> None:
        m, count = self.model, len(self.robots)
        for r in self.robots:
            self.arcs.append((r, (r + 1) % count, self.unused[r]))
            for j in self.missions:
                if r in self.assigned[j]:
                    last = m.new_bool_var(f"last{j}_{r}")
                    self.arcs.append((count + j, (r + 1) % count, last))
                    m.add_implication(last, self.assigned[j][r])
                    m.add(self.finish[r] >= self.nodes[count + j].end).only_enforce_if(self.assigned[j][r])

def _shortest(problem: Problem, m: int) -> int:
    """Duration of a mission at its quickest."""
    return min(d.duration_s for drives in problem.missions[m].drives.values() for d in drives)
