"""What follows from the constraint program and makes its linear relaxation tighter. It removes no schedule that is as cheap as the
known one, except copies by equal robots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._alone import Sets

if TYPE_CHECKING:
    from ._model import FleetModel


def add_cuts(f: FleetModel) -> None:
    """Follow from the rest, for the linear relaxation: robots' time and energy cover what they do."""
    p, m = f.problem, f.model
    present = [f.finish[r] - x.from_s for r, x in enumerate(p.robots)]
    m.add(sum(present) >= sum(f.busy_s))
    m.add(sum((x.level - p.kind(r).reserve) for r, x in enumerate(p.robots)) + sum(f.gained) >=
          sum(f.spent) + sum(p.kind(r).standby * present[r] for r in f.robots))
    for r in f.robots:
        _add_presence(f, r, present[r])
    _add_purchases(f, present)
    _add_order_of_equals(f)


def _mine(f: FleetModel, r: int) -> list[int]:
    return [j for j in f.missions if r in f.assigned[j]]


def _add_presence(f: FleetModel, r: int, present: Any) -> None:
    """A robot's time after each moment at which a mission can start first covers its missions from then on, with ways."""
    p, m, t, mine = f.problem, f.model, f.problem.robots[r].type, _mine(f, r)
    own_s, way_s = {j: _own_s(f, j, t) for j in mine}, {j: f.limits.way_to(j, t)[0] for j in mine}
    for j in mine:
        later = [k for k in mine if f.soonest[k] >= f.soonest[j]]
        head_s = f.soonest[j] - p.robots[r].from_s - max(way_s[k] for k in later)  # the first of them has its way before
        m.add(present >= head_s * f.assigned[j][r] + sum((own_s[k] + way_s[k]) * f.assigned[k][r] for k in later))
    m.add_no_overlap([m.new_optional_fixed_size_interval_var(f.start[j] - way_s[j], way_s[j] + own_s[j], f.assigned[j][r], "")
                      for j in mine])


def _add_purchases(f: FleetModel, present: list[Any]) -> None:
    """What a robot spends beyond its battery it buys, in visits of its own."""
    p, m = f.problem, f.model
    visits = [sum(node.visits.values()) for node in f.nodes]
    if not p.chargers or not any(node.visits for node in f.nodes):
        return
    bought, charging, own = [], [], []
    for r, robot in enumerate(p.robots):
        kind, mine, literal = p.kind(r), _mine(f, r), m.new_bool_var(f"buys{r}")
        own.append(m.new_int_var(0, len(mine) + 1, f"visits{r}"))
        bought.append(m.new_int_var(0, kind.capacity * (len(mine) + 1), f"bought{r}"))
        charging.append(m.new_int_var(0, f.horizon, f"charging{r}"))
        m.add(own[r] >= literal)
        m.add(own[r] <= (len(mine) + 1) * literal)
        m.add(charging[r] <= f.horizon * literal)
        m.add(bought[r] <= (kind.capacity - kind.reserve) * own[r])
        m.add(bought[r] <= (max(c.power for c in p.chargers) - kind.standby) * charging[r])
        least = {j: (min(d.upper for d in p.missions[j].drives[robot.type]), *f.limits.way_to(j, robot.type)) for j in mine}
        m.add(robot.level - kind.reserve + bought[r] >= kind.standby * (present[r] - charging[r]) +
              sum((mission + way) * f.assigned[j][r] for j, (mission, _, way) in least.items()))
        m.add(present[r] >= charging[r] + sum((_own_s(f, j, robot.type) + way_s) * f.assigned[j][r]
                                              for j, (_, way_s, _) in least.items()))
    m.add(sum(bought) <= sum(f.bought))
    m.add(sum(charging) <= sum(f.charging))
    m.add(sum(own) <= sum(visits))


def _own_s(f: FleetModel, j: int, t: int) -> int:
    return min(d.duration_s for d in f.problem.missions[j].drives[t])


def add_sets(f: FleetModel, sets: Sets) -> None:
    """Each robot drives one of the sets of missions that are left for it; all of them cost what they cost at least."""
    m, prices = f.model, []
    for r, costs in enumerate(sets.costs):
        literals = {mask: m.new_bool_var(f"set{r}_{mask}") for mask in costs}
        m.add_exactly_one(literals.values())
        for j in _mine(f, r):
            m.add(sum(v for mask, v in literals.items() if mask >> j & 1) == f.assigned[j][r])
        prices += [costs[mask] * v for mask, v in literals.items()]
    m.add(sum(f.cost) >= sum(prices))
    m.add(sum(f.cost) >= sets.bound)


def _add_order_of_equals(f: FleetModel) -> None:
    """Of equal robots, the one with the first of their missions comes first."""
    for first, second in f.equals:
        for j in f.missions:
            if second in f.assigned[j]:
                f.model.add(f.assigned[j][second] <= sum(f.assigned[i][first] for i in range(j) if first in f.assigned[i]))
        f.model.add_implication(f.unused[first], f.unused[second])
