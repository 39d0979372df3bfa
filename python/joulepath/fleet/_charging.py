"""Visits of chargers in the constraint program: the queue at each of them, and the charge curve."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._model import FleetModel, Node


def add_chargers(f: FleetModel) -> None:
    p, m = f.problem, f.model
    intervals: list[list[Any]] = [[] for _ in p.chargers]
    for node in f.nodes:
        present: list[Any] = []
        for t in range(len(p.types)):
            for c in range(len(p.chargers)):
                after = [v for (i, _, u, d, _), v in f.taken.items() if (i, u, d) == (node.index, t, c)]
                if not after:
                    continue
                literal = m.new_bool_var(f"visit{node.index}_{t}_{c}")
                m.add(sum(after) == literal)
                node.visits[t, c] = literal
                present.append(literal)
                _add_charge(f, node, t, c, literal)
                intervals[c].append(m.new_optional_interval_var(
                    node.begin, node.charge, node.done, literal, f"charging{node.index}_{t}_{c}"))
        _add_gain(f, node, present)
    for c, charger in enumerate(p.chargers):
        fixed = [m.new_fixed_size_interval_var(a, b - a, "") for d, a, b in p.busy if d == c]
        if charger.count == 1:
            m.add_no_overlap(intervals[c] + fixed)
        else:
            m.add_cumulative(intervals[c] + fixed, [1] * len(intervals[c] + fixed), charger.count)


def _add_charge(f: FleetModel, node: Node, t: int, c: int, literal: Any) -> None:
    """The charge curve: fast below the knee, slow above it."""
    m, p, kind, charger = f.model, f.problem, f.problem.types[t], f.problem.chargers[c]
    way = p.ways[t, node.place, charger.place][0]
    f.cost.append(literal * way.motion)
    f.busy_s.append(literal * way.duration_s)
    f.spent.append(literal * way.upper)
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


def _add_gain(f: FleetModel, node: Node, present: list[Any]) -> None:
    m = f.model
    gain = m.new_int_var(0, f.most, f"gain{node.index}")
    if not present:
        m.add(gain == 0)
    else:
        none = m.new_bool_var(f"stays{node.index}")
        m.add(sum(present) + none == 1)
        m.add(gain == 0).only_enforce_if(none)
        m.add(node.charge == 0).only_enforce_if(none)
        m.add(gain <= node.target - node.arrives).only_enforce_if(~none)
        fastest = max(c.power for c in f.problem.chargers) - min(kind.standby for kind in f.problem.types)
        m.add(gain <= fastest * node.charge)
        f.busy_s.append(node.charge)
        f.bought.append(gain)
        f.charging.append(node.charge)
        # a charge is net of the standby, which the robot's whole time includes
        f.gained.append(max(kind.standby for kind in f.problem.types) * node.charge)
    f.gained.append(gain)
