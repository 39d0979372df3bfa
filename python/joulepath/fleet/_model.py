"""The fleet as a constraint program: a tour through all robots and their missions, for CP-SAT of OR-tools.

Robots and missions are the nodes of one circuit: the missions between two robots' nodes are those of the first of them.
A visit of a charger belongs to the node after which it happens. Levels of batteries are lower bounds of 95 %.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from ortools.sat.python import cp_model

from ._alone import Sets, sets_of
from ._bound import Limits
from ._problem import NEVER, Drive, Problem, Schedule, Step, Visit
from ._routes import account


class Node:
    """A robot's start, or a mission's end: the place from which a robot leaves."""

    def __init__(self, index: int, place: str, end: Any, level: Any) -> None:
        self.index, self.place, self.end, self.level = index, place, end, level
        self.visits: dict[tuple[int, int], Any] = {}  # type, charger -> literal


class FleetModel:
    """Variables, constraints and cost of a problem."""

    def __init__(self, problem: Problem, most: int | None = None) -> None:
        """``most``: the cost of a known schedule; dearer ones are left out."""
        self.problem, self.model = problem, cp_model.CpModel()
        self.limits = Limits(problem, most)
        self.horizon = min(problem.horizon_s(), max(x.from_s for x in problem.robots) + self.limits.present_s + 1)
        self.robots, self.missions = range(len(problem.robots)), range(len(problem.missions))
        self.most = max(kind.capacity for kind in problem.types)
        self.equals = [(a, b) for group in _groups(problem) for a, b in zip(group, group[1:])]
        self.cost: list[Any] = []
        self.busy_s: list[Any] = []  # durations of everything that robots do
        self.spent: list[Any] = []  # upper bounds of their energies
        self.gained: list[Any] = []
        self.bought: list[Any] = []
        self.charging: list[Any] = []
        self.arcs: list[tuple[int, int, Any]] = []
        self.taken: dict[tuple[int, int, int, int, int], Any] = {}  # node, mission, type, charger or -1, way -> literal
        self._add_missions()
        self._add_robots()
        for node in self.nodes:
            self._add_visit(node)
            for j in self.missions:
                if node.index != len(self.robots) + j:
                    self._add_ways(node, j)
        self._add_ends()
        self._add_chargers()
        self.model.add_circuit(self.arcs)
        self._add_cuts()
        sets, self.low = None if most is None else sets_of(problem, most, self.limits), self.limits.low
        if sets is not None:
            self.low = max(self.low, sets.bound)
            self._add_sets(sets)
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
        node.begin = m.new_int_var(0, self.horizon, f"begin{i}")  # type: ignore[attr-defined]
        node.charge = m.new_int_var(0, self.horizon, f"charge{i}")  # type: ignore[attr-defined]
        node.done = m.new_int_var(0, self.horizon, f"done{i}")  # type: ignore[attr-defined]
        node.arrives = m.new_int_var(0, self.most, f"arrives{i}")  # type: ignore[attr-defined]
        node.target = m.new_int_var(0, self.most, f"target{i}")  # type: ignore[attr-defined]

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
                m.add(self.start[j] >= node.done + way.duration_s).only_enforce_if(literal)  # type: ignore[attr-defined]
                m.add(self.level[j] <= node.target - way.upper  # type: ignore[attr-defined]
                      - standby * (self.start[j] - node.done)).only_enforce_if(literal)  # type: ignore[attr-defined]
        if not literals:
            return
        arc = m.new_bool_var(f"arc{node.index}_{j}")
        m.add(sum(literals) == arc)
        self.arcs.append((node.index, len(self.robots) + j, arc))
        self._add_same_robot(node, j, arc)

    def _possible(self, node: Node, j: int, t: int, c: int, k: int) -> bool:
        """Whether a way is cheap enough, and short enough for the latest end of its mission."""
        if not self.limits.way((node.index, j), t, c, k):
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

    def _add_chargers(self) -> None:
        p, m = self.problem, self.model
        intervals: list[list[Any]] = [[] for _ in p.chargers]
        for node in self.nodes:
            present: list[Any] = []
            for t in range(len(p.types)):
                for c in range(len(p.chargers)):
                    after = [v for (i, _, u, d, _), v in self.taken.items() if (i, u, d) == (node.index, t, c)]
                    if not after:
                        continue
                    literal = m.new_bool_var(f"visit{node.index}_{t}_{c}")
                    m.add(sum(after) == literal)
                    node.visits[t, c] = literal
                    present.append(literal)
                    self._add_charge(node, t, c, literal)
                    intervals[c].append(m.new_optional_interval_var(
                        node.begin, node.charge, node.done, literal, f"charging{node.index}_{t}_{c}"))  # type: ignore[attr-defined]
            self._add_gain(node, present)
        for c, charger in enumerate(p.chargers):
            fixed = [m.new_fixed_size_interval_var(a, b - a, "") for d, a, b in p.busy if d == c]
            if charger.count == 1:
                m.add_no_overlap(intervals[c] + fixed)
            else:
                m.add_cumulative(intervals[c] + fixed, [1] * len(intervals[c] + fixed), charger.count)

    def _add_charge(self, node: Any, t: int, c: int, literal: Any) -> None:
        """The charge curve: fast below the knee, slow above it."""
        m, p, kind, charger = self.model, self.problem, self.problem.types[t], self.problem.chargers[c]
        way = p.ways[t, node.place, charger.place][0]
        self.cost.append(literal * way.motion)
        self.busy_s.append(literal * way.duration_s)
        self.spent.append(literal * way.upper)
        m.add(node.begin >= node.end + way.duration_s).only_enforce_if(literal)
        m.add(node.arrives <= node.level - way.upper - kind.standby * (node.begin - node.end)).only_enforce_if(literal)
        m.add(node.arrives >= kind.reserve).only_enforce_if(literal)
        m.add(node.target <= kind.capacity).only_enforce_if(literal)
        m.add(node.target >= node.arrives).only_enforce_if(literal)
        fast, slow, knee = charger.power - kind.standby, charger.taper - kind.standby, charger.knee(kind)
        m.add(fast * node.charge >= node.target - node.arrives).only_enforce_if(literal)
        if slow == fast or knee >= kind.capacity:
            return
        below = m.new_bool_var(f"below{node.index}_{t}_{c}")
        m.add(node.arrives <= knee).only_enforce_if(below)
        m.add(node.arrives >= knee).only_enforce_if(~below)
        m.add(fast * slow * node.charge >= fast * (node.target - knee) + slow * (knee - node.arrives)).only_enforce_if(literal, below)
        m.add(slow * node.charge >= node.target - node.arrives).only_enforce_if(literal, ~below)

    def _add_gain(self, node: Any, present: list[Any]) -> None:
        m = self.model
        gain = m.new_int_var(0, self.most, f"gain{node.index}")
        if not present:
            m.add(gain == 0)
        else:
            none = m.new_bool_var(f"stays{node.index}")
            m.add(sum(present) + none == 1)
            m.add(gain == 0).only_enforce_if(none)
            m.add(node.charge == 0).only_enforce_if(none)
            m.add(gain <= node.target - node.arrives).only_enforce_if(~none)
            fastest = max(c.power for c in self.problem.chargers) - min(kind.standby for kind in self.problem.types)
            m.add(gain <= fastest * node.charge)
            self.busy_s.append(node.charge)
            self.bought.append(gain)
            self.charging.append(node.charge)
            # a charge is net of the standby, which the robot's whole time includes
            self.gained.append(max(kind.standby for kind in self.problem.types) * node.charge)
        self.gained.append(gain)

    def _add_cuts(self) -> None:
        """Follow from the rest, for the linear relaxation: robots' time and energy cover what they do."""
        p, m = self.problem, self.model
        present = [self.finish[r] - x.from_s for r, x in enumerate(p.robots)]
        m.add(sum(present) >= sum(self.busy_s))
        m.add(sum((x.level - p.kind(r).reserve) for r, x in enumerate(p.robots)) + sum(self.gained) >=
              sum(self.spent) + sum(p.kind(r).standby * present[r] for r in self.robots))
        for r in self.robots:
            self._add_presence(r, present[r])
        self._add_purchases(present)
        self._add_order_of_equals()

    def _mine(self, r: int) -> list[int]:
        return [j for j in self.missions if r in self.assigned[j]]

    def _add_presence(self, r: int, present: Any) -> None:
        """A robot's time after each moment at which a mission can start first covers its missions from then on, with ways."""
        p, m, t, mine = self.problem, self.model, self.problem.robots[r].type, self._mine(r)
        own_s, way_s = {j: self._own_s(j, t) for j in mine}, {j: self.limits.way_to(j, t)[0] for j in mine}
        for j in mine:
            later = [k for k in mine if self.soonest[k] >= self.soonest[j]]
            head_s = self.soonest[j] - p.robots[r].from_s - max(way_s[k] for k in later)  # the first of them has its way before
            m.add(present >= head_s * self.assigned[j][r] + sum((own_s[k] + way_s[k]) * self.assigned[k][r] for k in later))
        m.add_no_overlap([m.new_optional_fixed_size_interval_var(self.start[j] - way_s[j], way_s[j] + own_s[j], self.assigned[j][r], "")
                          for j in mine])

    def _add_purchases(self, present: list[Any]) -> None:
        """What a robot spends beyond its battery it buys, in visits of its own."""
        p, m = self.problem, self.model
        visits = [sum(node.visits.values()) for node in self.nodes]
        if not p.chargers or not any(node.visits for node in self.nodes):
            return
        bought, charging, own = [], [], []
        for r, robot in enumerate(p.robots):
            kind, mine, literal = p.kind(r), self._mine(r), m.new_bool_var(f"buys{r}")
            own.append(m.new_int_var(0, len(mine) + 1, f"visits{r}"))
            bought.append(m.new_int_var(0, kind.capacity * (len(mine) + 1), f"bought{r}"))
            charging.append(m.new_int_var(0, self.horizon, f"charging{r}"))
            m.add(own[r] >= literal)
            m.add(own[r] <= (len(mine) + 1) * literal)
            m.add(charging[r] <= self.horizon * literal)
            m.add(bought[r] <= (kind.capacity - kind.reserve) * own[r])
            m.add(bought[r] <= (max(c.power for c in p.chargers) - kind.standby) * charging[r])
            least = {j: (min(d.upper for d in p.missions[j].drives[robot.type]), *self.limits.way_to(j, robot.type)) for j in mine}
            m.add(robot.level - kind.reserve + bought[r] >= kind.standby * (present[r] - charging[r]) +
                  sum((mission + way) * self.assigned[j][r] for j, (mission, _, way) in least.items()))
            m.add(present[r] >= charging[r] + sum((self._own_s(j, robot.type) + way_s) * self.assigned[j][r]
                                                  for j, (_, way_s, _) in least.items()))
        m.add(sum(bought) <= sum(self.bought))
        m.add(sum(charging) <= sum(self.charging))
        m.add(sum(own) <= sum(visits))

    def _own_s(self, j: int, t: int) -> int:
        return min(d.duration_s for d in self.problem.missions[j].drives[t])

    def _add_sets(self, sets: Sets) -> None:
        """Each robot drives one of the sets of missions that are left for it; all of them cost what they cost at least."""
        m, prices = self.model, []
        for r, costs in enumerate(sets.costs):
            literals = {mask: m.new_bool_var(f"set{r}_{mask}") for mask in costs}
            m.add_exactly_one(literals.values())
            for j in self._mine(r):
                m.add(sum(v for mask, v in literals.items() if mask >> j & 1) == self.assigned[j][r])
            prices += [costs[mask] * v for mask, v in literals.items()]
        m.add(sum(self.cost) >= sum(prices))
        m.add(sum(self.cost) >= sets.bound)

    def _add_order_of_equals(self) -> None:
        """Of equal robots, the one with the first of their missions comes first."""
        for first, second in self.equals:
            for j in self.missions:
                if second in self.assigned[j]:
                    self.model.add(self.assigned[j][second] <= sum(self.assigned[i][first] for i in range(j) if first in self.assigned[i]))
            self.model.add_implication(self.unused[first], self.unused[second])

    def in_order(self, schedule: Schedule) -> Schedule:
        """The schedule with the routes of equal robots in the model's order."""
        routes = list(schedule.routes)
        for group in _groups(self.problem):
            for r, route in zip(group, sorted((routes[r] for r in group), key=lambda route: min((x.mission for x in route), default=NEVER))):
                routes[r] = route
        return replace(schedule, routes=tuple(routes))

    def hint(self, schedule: Schedule) -> None:
        """Starts the search at a schedule."""
        m = self.model
        for r, route in enumerate(self.in_order(schedule).routes):
            m.add_hint(self.unused[r], not route)
            node = self.nodes[r]
            for step in route:
                for other in self.robots:
                    if other in self.assigned[step.mission]:
                        m.add_hint(self.assigned[step.mission][other], other == r)
                for (i, j, t, c, k), literal in self.taken.items():
                    if j == step.mission:
                        at = step.visit.charger if step.visit else -1
                        m.add_hint(literal, (i, t, c, k) == (node.index, self.problem.robots[r].type, at, step.way))
                for (t, k), literal in self.speed[step.mission].items():
                    m.add_hint(literal, (t, k) == (self.problem.robots[r].type, step.speed))
                m.add_hint(self.start[step.mission], step.start_s)
                if step.visit:
                    for variable, value in ((node.begin, step.visit.from_s), (node.done, step.visit.to_s),  # type: ignore[attr-defined]
                                            (node.charge, step.visit.to_s - step.visit.from_s),  # type: ignore[attr-defined]
                                            (node.target, step.visit.target)):  # type: ignore[attr-defined]
                        m.add_hint(variable, value)
                node = self.nodes[len(self.robots) + step.mission]

    def schedule(self, solver: Any) -> Schedule:
        """The routes of a solution."""
        after: dict[int, tuple[int, Step]] = {}
        for (i, j, t, c, k), literal in self.taken.items():
            if not solver.boolean_value(literal):
                continue
            node: Any = self.nodes[i]
            visit = None if c < 0 else Visit(c, solver.value(node.begin), solver.value(node.done), solver.value(node.target))
            speed = next(s for (u, s), v in self.speed[j].items() if solver.boolean_value(v))
            after[i] = (len(self.robots) + j, Step(j, k, speed, solver.value(self.start[j]), visit))
        routes = []
        for r in self.robots:
            route, node_index = [], r
            while node_index in after:
                node_index, step = after[node_index]
                route.append(step)
            routes.append(tuple(route))
        return Schedule(tuple(routes), round(solver.objective_value), round(solver.best_objective_bound))


def _groups(problem: Problem) -> list[list[int]]:
    """Equal robots."""
    groups: dict[tuple[Any, ...], list[int]] = {}
    for r, x in enumerate(problem.robots):
        key = (x.type, x.start, x.level, x.from_s, x.to_s, x.use_price, tuple(r in m.robots for m in problem.missions))
        groups.setdefault(key, []).append(r)
    return list(groups.values())


def _shortest(problem: Problem, m: int) -> int:
    """Duration of a mission at its quickest."""
    return min(d.duration_s for drives in problem.missions[m].drives.values() for d in drives)


class _Progress(cp_model.CpSolverSolutionCallback):
    def __init__(self, tell: Any, stop: Any) -> None:
        super().__init__()
        self._tell, self._stop = tell, stop

    def on_solution_callback(self) -> None:
        self._tell(round(self.objective_value), round(self.best_objective_bound))
        if self._stop():
            self.stop_search()


def solve(problem: Problem, *, seed: int = 1, workers: int = 8, limit: float = 120.0, start: Schedule | None = None,
          tell: Any = None, stop: Any = None, relative_gap: float = 0.0, takes_sigint: bool = True) -> tuple[str, Schedule | None]:
    """The cheapest schedule: ``optimal``, ``feasible``, ``infeasible`` or ``unknown``, and the schedule.

    ``limit``: deterministic time of CP-SAT, in its seconds. ``workers`` interleave, so that the same seed, workers and limit give the
    same schedule. ``tell(cost, bound)`` is called for each better schedule; ``stop()`` ends the search; so does SIGINT with
    ``takes_sigint``.
    """
    fleet = FleetModel(problem, None if start is None else start.cost)
    if start is not None:
        if fleet.low >= start.cost:
            return "optimal", replace(start, bound=start.cost, proven=True)
        fleet.hint(start)
    solver = cp_model.CpSolver()
    solver.parameters.random_seed = seed
    solver.parameters.num_workers = workers
    solver.parameters.interleave_search = workers > 1
    solver.parameters.max_deterministic_time = limit
    solver.parameters.relative_gap_limit = relative_gap
    solver.parameters.catch_sigint_signal = takes_sigint
    status = solver.solve(fleet.model, _Progress(tell or (lambda *_: None), stop or (lambda: False)))
    if status == cp_model.INFEASIBLE:
        return "infeasible", None
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return ("unknown", None) if start is None else ("feasible", replace(start, bound=fleet.low))
    found = fleet.schedule(solver)
    word = "optimal" if status == cp_model.OPTIMAL else "feasible"
    cost = account(problem, found.routes)  # a schedule that is not proven may have slack in its variables
    return word, Schedule(found.routes, cost, min(max(found.bound, fleet.low), cost), status == cp_model.OPTIMAL)


__all__ = ["NEVER", "FleetModel", "solve"]
