"""A fleet planned with other numbers of charging places and other batteries: what each costs."""

from __future__ import annotations

import csv
import html
import io
import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path as FilePath
from typing import Any

from .._errors import refused
from .._files import save as written
from ._bound import bound
from ._problem import UNITS_PER_J, Problem, Schedule
from ._report import page_html, table_html
from ._search import search

COLUMNS = ("charging_places", "battery_scale", "status", "cost_J", "bound_J", "robots", "visits", "charged_s", "late_s")
WIDTH, HEIGHT, LEFT, RIGHT, ABOVE, BELOW = 560, 300, 90, 60, 30, 60  #: of the chart


@dataclass(frozen=True)
class FleetStudy:
    """Rows of ``COLUMNS``; costs are None without a schedule, bounds where none exists."""

    fleet: str
    rows: tuple[dict[str, Any], ...]

    def save(self, directory: str | os.PathLike[str], *, force: bool = False) -> FilePath:
        """Writes study.json, study.csv and report.html, all or none. Files that exist are overwritten with ``force`` alone, else
        ConfigError."""
        table = io.StringIO()
        lines = csv.DictWriter(table, COLUMNS, lineterminator="\n")
        lines.writeheader()
        lines.writerows(self.rows)
        content = {"schema": "joulepath/fleet_study/1", "fleet": self.fleet, "rows": list(self.rows)}
        return written(FilePath(directory), {"study.json": json.dumps(content, indent=2) + "\n", "study.csv": table.getvalue(),
                                             "report.html": _page(self)}, force)


def varied(problem: Problem, places: int, scale: float) -> Problem:
    """A fleet with so many places at each charger, and batteries that hold ``scale`` times as much, at their fractions of before."""
    types = tuple(replace(x, capacity=round(x.capacity * scale), reserve=round(x.reserve * scale)) for x in problem.types)
    robots = tuple(replace(x, level=int(x.level * scale)) for x in problem.robots)
    chargers = tuple(replace(x, count=places) for x in problem.chargers) if places else ()
    return replace(problem, types=types, robots=robots, chargers=chargers)


def row_of(problem: Problem, places: int, scale: float, options: dict[str, Any]) -> dict[str, Any]:
    """One row of a study. ``options``: of ``search``."""
    fleet = varied(problem, places, scale)
    status, found = search(fleet, **options)
    row = dict(zip(COLUMNS, (places, scale, status)))
    if found is not None:
        return {**row, **_figures(fleet, found)}
    return {**row, **dict.fromkeys(COLUMNS[3:]), "bound_J": None if status == "infeasible" else bound(fleet) / UNITS_PER_J}


def _figures(problem: Problem, found: Schedule) -> dict[str, Any]:
    visits = [step.visit for route in found.routes for step in route if step.visit]
    late_s = sum(max(0, step.start_s + problem.missions[step.mission].drives[problem.robots[r].type][step.speed].duration_s -
                     problem.missions[step.mission].due_s) for r, route in enumerate(found.routes) for step in route)
    return {"cost_J": found.cost / UNITS_PER_J, "bound_J": found.bound / UNITS_PER_J, "robots": sum(bool(route) for route in found.routes),
            "visits": len(visits), "charged_s": sum(v.to_s - v.from_s for v in visits), "late_s": late_s}


def rows_of(problem: Problem, places: Sequence[int], scales: Sequence[float], client: Any, **options: Any) -> Iterable[dict[str, Any]]:
    """Rows in order; with a client, its workers plan the fleets."""
    jobs = [(n, scale) for scale in scales for n in sorted(places)]
    if client is None:
        rows: Iterable[dict[str, Any]] = (row_of(problem, n, scale, options) for n, scale in jobs)
    else:
        rows = client.gather(client.map(row_of, [problem] * len(jobs), *zip(*jobs), [options] * len(jobs), pure=False))
    return _never_dearer(rows)


def _never_dearer(rows: Iterable[dict[str, Any]]) -> Iterable[dict[str, Any]]:
    """A schedule with fewer places at the same battery is one with more; a bound for fewer is none for more."""
    best: dict[float, dict[str, Any]] = {}
    for row in rows:
        known = best.get(row["battery_scale"])
        if known and (row["cost_J"] is None or row["cost_J"] > known["cost_J"]):
            low_J = min(row["bound_J"] or 0.0, known["cost_J"])
            row = {**known, "charging_places": row["charging_places"], "bound_J": low_J, "status": "optimal" if low_J == known["cost_J"] else "feasible"}
        if row["cost_J"] is not None:
            best[row["battery_scale"]] = row
        yield row


def sentence(study: FleetStudy) -> str:
    """What the rows say, for each battery: the fewest places from which more save less than 1 %."""
    return " ".join(_sentence(scale, [row for row in study.rows if row["battery_scale"] == scale])
                    for scale in dict.fromkeys(row["battery_scale"] for row in study.rows))


def _sentence(scale: float, rows: list[dict[str, Any]]) -> str:
    planned = [row for row in rows if row["cost_J"] is not None]
    if not planned:
        return f"Battery x {scale:g}: no schedule was found."
    least = min(row["cost_J"] for row in planned)
    enough = next(row for row in planned if row["cost_J"] <= 1.01 * least)
    count, most = enough["charging_places"], rows[-1]["charging_places"]
    told = f"Battery x {scale:g}: {count} {'place' if count == 1 else 'places'} at each charger {'is' if count == 1 else 'are'} enough, {enough['cost_J']:.0f} J"
    if count == most:
        return told + "; more were not tried."
    saved = 100 * (1 - least / enough["cost_J"]) if enough["cost_J"] else 0.0
    return told + f"; up to {most} save {f'{saved:.1f} %' if saved >= 0.05 else 'nothing'}."


def _page(study: FleetStudy) -> str:
    head = [(name.replace("_", " "), name not in ("status",)) for name in COLUMNS]
    rows = [("", ["" if row[name] is None else f"{row[name]:.0f}" if name.endswith("_J") else str(row[name]) for name in COLUMNS])
            for row in study.rows]
    return page_html(f"Chargers of {study.fleet}", "", f'<p>{html.escape(sentence(study))}</p>'
                     '<p class="soft">The weight of a larger battery is not in the energies of the legs.</p>'
                     f'<section class="long"><h2>Cost by charging places</h2>{_chart(study)}</section>'
                     f'<section class="long"><h2>Fleets</h2>{table_html(head, rows)}</section>')


def _chart(study: FleetStudy) -> str:
    """Cost against places, a line for each battery; the bars below a point reach to its bound."""
    planned = [row for row in study.rows if row["cost_J"] is not None]
    if not planned:
        return "<p>No schedule.</p>"
    most = max(row["cost_J"] for row in planned)
    low = min(0.9 * most, *(row["bound_J"] for row in planned))
    places = sorted({row["charging_places"] for row in study.rows})
    span = max(1, places[-1] - places[0])

    def at(n: int, cost_J: float) -> tuple[float, float]:
        across, down = (n - places[0]) / span, (most - cost_J) / max(most - low, 1e-9)
        return LEFT + (WIDTH - LEFT - RIGHT) * across, ABOVE + (HEIGHT - ABOVE - BELOW) * down

    having = {row["charging_places"] for row in planned}
    parts = [f'<text x="{at(n, low)[0]:.0f}" y="{HEIGHT - 32}" text-anchor="middle">{n}{"" if n in having else ": none"}</text>' for n in places]
    parts.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2:.0f}" y="{HEIGHT - 8}" text-anchor="middle">places at each charger</text>')
    parts += [f'<text x="{LEFT - 12}" y="{at(places[0], value)[1] + 5:.0f}" text-anchor="end">{value:.0f} J</text>' for value in (most, low)]
    for k, scale in enumerate(sorted({row["battery_scale"] for row in study.rows})):
        line = [row for row in planned if row["battery_scale"] == scale]
        points = [(at(row["charging_places"], row["cost_J"]), at(row["charging_places"], row["bound_J"])) for row in line]
        color = ("var(--plan)", "var(--third)", "var(--limit)")[k % 3]
        parts.append(f'<polyline points="{" ".join(f"{x:.1f},{y:.1f}" for (x, y), _ in points)}" style="stroke:{color}"/>')
        for row, ((x, y), (_, bound)) in zip(line, points):
            told = f"{row['charging_places']} places, battery x {scale:g}: {row['cost_J']:.0f} J, bound {row['bound_J']:.0f} J"
            parts.append(f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{y:.1f}" y2="{bound:.1f}" style="stroke:{color}"/>'
                         f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" style="fill:{color}"><title>{told}</title></circle>')
        if points:
            (x, y), _ = points[-1]
            parts.append(f'<text x="{x + 10:.0f}" y="{y - 8 if k % 2 == 0 else y + 18:.0f}">x {scale:g}</text>')
    return (f'<svg class="study" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="Cost by charging places">{"".join(parts)}</svg>'
            '<p class="soft small">A line is a battery, relative to that of the file. The stroke below a point reaches to the bound of its cost. '
            "None: no schedule exists.</p>")


def values(name: str, given: Any, least: float) -> tuple[float, ...]:
    """Numbers of a study, each once. Raises ConfigError."""
    try:
        found = tuple(float(x) for x in given)
    except (TypeError, ValueError):
        found = ()
    if not found or len(set(found)) < len(found) or min(found) < least or not max(found) <= 1000:
        raise refused(name, repr(given), f"different numbers from {least:g} to 1000")
    return found
