"""Charts over time as HTML: lanes of bars, and batteries with their bands. Places are percentages, so that a page of any width is
readable."""

from __future__ import annotations

import html
from typing import Any

KINDS = ("mission", "drive", "charge", "wait")
TICKS_S = (10, 30, 60, 120, 300, 600, 1800, 3600, 7200, 14400, 43200, 86400)
MOST_TICKS = 12
Bar = tuple[float, float, str, str]  #: from, to, kind, label
Lane = tuple[str, list[Bar]]


def gantt(lanes: list[Lane], end_s: float) -> str:
    """One lane of bars for each name, above an axis."""
    rows = "".join(f'<div class="who">{html.escape(name)}</div><div class="lane">{"".join(_bar(bar, end_s) for bar in bars)}{CURSOR}</div>'
                   for name, bars in lanes)
    return f'<div class="chart">{rows}{_axis(end_s)}</div>'


CURSOR = '<b class="line"></b>'


def _bar(bar: Bar, end_s: float) -> str:
    begin, end, kind, label = bar
    told = html.escape(f"{label or kind}, {begin:g} to {end:g} s")
    return (f'<i class="bar {kind}" style="left:{100 * begin / end_s:.3f}%;width:{100 * (end - begin) / end_s:.3f}%" title="{told}">'
            f"<span>{html.escape(label)}</span></i>")


def _axis(end_s: float) -> str:
    step = next((s for s in TICKS_S if end_s / s <= MOST_TICKS), 86400 * max(1, round(end_s / 86400 / MOST_TICKS)))
    unit, scale = ("s", 1) if step < 60 else ("min", 60) if step < 3600 else ("h", 3600)
    ticks = "".join(f'<span class="{"odd" if k % 2 else ""}" style="left:{100 * k * step / end_s:.3f}%">{k * step / scale:g}</span>'
                    for k in range(int(end_s / step) + 1))
    return f'<div class="who soft">{unit}</div><div class="axis">{ticks}</div>'


def lanes_of(station: str, visits: list[dict[str, Any]], count: int) -> list[Lane]:
    """A lane for each robot that a charger has room for."""
    lanes: list[list[Bar]] = [[] for _ in range(max(1, min(count, len(visits))))]
    for visit in visits:
        free = min(lanes, key=lambda lane: lane[-1][1] if lane else 0.0)
        free.append((visit["from_s"], visit["to_s"], "charge", visit["robot"]))
    return [(station if len(lanes) == 1 else f"{station} {k + 1}", lane) for k, lane in enumerate(lanes)]


def batteries(robots: list[dict[str, Any]], end_s: float) -> str:
    """Of each robot that does something."""
    rows = "".join(_battery(robot, end_s) for robot in robots if robot["timeline"])
    return f'<div class="chart">{rows}{_axis(end_s)}</div>'


def _battery(robot: dict[str, Any], end_s: float) -> str:
    """Mean and lower bound over time, from the robot's own least to its own most."""
    points = [(robot["timeline"][0]["from_s"], robot["start_fraction"], robot["start_fraction"])]
    points += [(x["to_s"], x["battery_fraction"], x["battery_fraction_lower_95"]) for x in robot["timeline"]]
    values = [v for _, a, b in points for v in (a, b)] + [robot["reserve_fraction"]]
    low, high = min(values), max(values)

    def at(time_s: float, value: float) -> str:
        return f"{1000 * time_s / end_s:.1f},{3 + 94 * (high - value) / max(high - low, 1e-6):.1f}"

    mean = " ".join(at(t, a) for t, a, _ in points)
    bound = " ".join(at(t, b) for t, _, b in points)
    back = " ".join(at(t, b) for t, _, b in reversed(points))
    reserve, end = robot["reserve_fraction"], at(end_s, robot["reserve_fraction"])
    return (f'<div class="who">{html.escape(robot["name"])}<small>{100 * high:.1f} %<br>{100 * low:.1f} %</small></div>'
            f'<div class="lane battery"><svg viewBox="0 0 1000 100" preserveAspectRatio="none" role="img" '
            f'aria-label="Battery of {html.escape(robot["name"])}"><polygon points="{mean} {back}"/><polyline points="{bound}" class="bound"/>'
            f'<polyline points="{mean}"/><polyline points="{at(0, reserve)} {end}" class="reserve"/></svg>{CURSOR}</div>')
