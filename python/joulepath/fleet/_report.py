"""report.html of a fleet: one self-contained page without scripts of others."""

from __future__ import annotations

import html
from typing import Any

COLORS = {"drive": "#7a8794", "wait": "#d9dee3", "charge": "#2f9e62", "mission": "#2f6db3"}
STYLE = """body{font:15px/1.45 system-ui,sans-serif;margin:0 auto;max-width:1500px;padding:16px;color:#1c2733;background:#fff}
h1{font-size:1.5em;margin:.2em 0}h2{font-size:1.15em;margin:1.4em 0 .3em}svg{width:100%;height:auto;display:block}
table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:4px 8px;border-bottom:1px solid #dde3e9}
.n{text-align:right;font-variant-numeric:tabular-nums}.late{color:#b3261e}.wide{overflow-x:auto}.wide svg{min-width:720px}
.key span{display:inline-block;margin-right:14px}.key i{display:inline-block;width:12px;height:12px;margin-right:5px;border-radius:2px}
text{font:12px system-ui,sans-serif;fill:#1c2733}.on{fill:#fff}
@media(prefers-color-scheme:dark){body{background:#12181f;color:#e3e9ef}text{fill:#e3e9ef}td,th{border-color:#2c3742}}"""
LEFT, WIDTH, ROW = 90.0, 1100.0, 26.0


def report_html(source: Any, content: dict[str, Any]) -> str:
    """The page: verdict, Gantt charts of robots and chargers, batteries, map, missions."""
    title = html.escape(f"Fleet {content['fleet']}")
    head = f"<h1>{title}</h1><p>{html.escape(_sentence(content))}</p><p>{html.escape(content['traffic'])}</p>"
    body = _helps(content) if "robots" not in content else _charts(source, content)
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>{title}</title><style>{STYLE}</style></head><body>{head}{body}</body></html>\n")


def _sentence(content: dict[str, Any]) -> str:
    if "cost_J" not in content:
        return f"No schedule exists: {content['reason']['says']}; " + ("one of these helps works." if content["help"] else "no help that was tried works.")
    late = sum(m["late_s"] > 0 for m in content["missions"])
    return (f"The schedule is {content['status']}: {content['cost_J']:.0f} J, bound {content['bound_J']:.0f} J, "
            f"gap {content['gap_percent']:.2f} %; {late} of {len(content['missions'])} missions are late.")


def _helps(content: dict[str, Any]) -> str:
    return "<ul>" + "".join(f"<li>{html.escape(h['says'])}</li>" for h in content["help"]) + "</ul>"


def _charts(source: Any, content: dict[str, Any]) -> str:
    end_s = max([item["to_s"] for robot in content["robots"] for item in robot["timeline"]] or [1])
    key = "".join(f'<span><i style="background:{color}"></i>{does}</span>' for does, color in COLORS.items())
    rows = [(robot["name"], [(x["from_s"], x["to_s"], x["does"], x.get("mission", "")) for x in robot["timeline"]])
            for robot in content["robots"]]
    docks = [(c["station"], [(v["from_s"], v["to_s"], "charge", v["robot"]) for v in c["visits"]]) for c in content["chargers"]]
    parts = [f'<h2>Robots</h2><p class="key">{key}</p>{_gantt(rows, end_s)}']
    if docks:
        parts.append(f"<h2>Chargers</h2>{_gantt(docks, end_s)}")
    parts.append("<h2>Batteries</h2><p>Mean, and below it the lower 95 % bound, which guards the reserve (dashed).</p>" +
                 "".join(_battery(robot, end_s) for robot in content["robots"] if robot["timeline"]))
    parts += [f"<h2>Map</h2>{_map(source, content)}", f"<h2>Missions</h2>{_table(content)}"]
    return "".join(parts)


def _x(time_s: float, end_s: float) -> float:
    return LEFT + (WIDTH - LEFT - 10) * time_s / end_s


def _ticks(end_s: float, height: float) -> str:
    step = next(s for s in (10, 30, 60, 120, 300, 600, 1800, 3600, 7200, 36000, 10**9) if end_s / s <= 10)
    return "".join(f'<line x1="{_x(t, end_s):.1f}" x2="{_x(t, end_s):.1f}" y1="0" y2="{height:.0f}" stroke="#8884"/>'
                   f'<text x="{_x(t, end_s):.1f}" y="{height + 14:.0f}" text-anchor="middle">{t / 60:g}</text>'
                   for t in range(0, int(end_s) + 1, step)) + f'<text x="4" y="{height + 14:.0f}">minutes</text>'


def _gantt(rows: list[tuple[str, list[tuple[int, int, str, str]]]], end_s: float) -> str:
    height, drawn = ROW * len(rows), []
    for n, (name, items) in enumerate(rows):
        drawn.append(f'<text x="4" y="{n * ROW + 17:.0f}">{html.escape(name)}</text>')
        for begin, end, does, label in items:
            x, width = _x(begin, end_s), _x(end, end_s) - _x(begin, end_s)
            told = html.escape(f"{label or does}, {begin} to {end} s")
            drawn.append(f'<rect x="{x:.1f}" y="{n * ROW + 3:.0f}" width="{max(width, 0.8):.1f}" height="{ROW - 6:.0f}" rx="2" '
                         f'fill="{COLORS[does]}"><title>{told}</title></rect>')
            if label and width > 8 * len(label) + 6:
                drawn.append(f'<text class="on" x="{x + 4:.1f}" y="{n * ROW + 17:.0f}">{html.escape(label)}</text>')
    return (f'<div class="wide"><svg viewBox="0 0 {WIDTH:.0f} {height + 20:.0f}" role="img">{_ticks(end_s, height)}'
            f"{''.join(drawn)}</svg></div>")


def _battery(robot: dict[str, Any], end_s: float) -> str:
    """Mean and lower bound over time, from the robot's own least to its own most."""
    start = robot["timeline"][0]["from_s"]
    points = [(start, robot["start_fraction"], robot["start_fraction"])]
    points += [(x["to_s"], x["battery_fraction"], x["battery_fraction_lower_95"]) for x in robot["timeline"]]
    values = [v for _, a, b in points for v in (a, b)] + [robot["reserve_fraction"]]
    low, high, height = min(values), max(values), 90.0
    span = max(high - low, 1e-6)

    def y(value: float) -> float:
        return float(6 + (height - 12) * (high - value) / span)

    mean = " ".join(f"{_x(t, end_s):.1f},{y(a):.1f}" for t, a, _ in points)
    bound = " ".join(f"{_x(t, end_s):.1f},{y(b):.1f}" for t, _, b in reversed(points))
    reserve = y(robot["reserve_fraction"])
    return (f'<div class="wide"><svg viewBox="0 0 {WIDTH:.0f} {height + 20:.0f}" role="img">{_ticks(end_s, height)}'
            f'<polygon points="{mean} {bound}" fill="#2f6db355"/><polyline points="{mean}" fill="none" stroke="#2f6db3" stroke-width="2"/>'
            f'<line x1="{LEFT}" x2="{WIDTH - 10}" y1="{reserve:.1f}" y2="{reserve:.1f}" stroke="#b3261e" stroke-dasharray="5 4"/>'
            f'<text x="4" y="20">{html.escape(robot["name"])}</text><text x="4" y="38">{100 * high:.1f} %</text>'
            f'<text x="4" y="{height - 4:.0f}">{100 * low:.1f} %</text></svg></div>')


def _map(source: Any, content: dict[str, Any]) -> str:
    """Places, and each robot's way between them as straight lines; the robots move along them in a loop of 30 s."""
    stations = source.content["floor"]["stations"]
    xs, ys = [p["x_m"] for p in stations.values()], [p["y_m"] for p in stations.values()]
    least, most = (min(xs) - 3, min(ys) - 3), (max(xs) + 3, max(ys) + 3)
    scale = 700 / max(most[0] - least[0], most[1] - least[1])
    end_s = max([item["to_s"] for robot in content["robots"] for item in robot["timeline"]] or [1])

    def at(name: str) -> tuple[float, float]:
        return (stations[name]["x_m"] - least[0]) * scale, (most[1] - stations[name]["y_m"]) * scale

    colors, drawn = ["#2f6db3", "#c2571a", "#2f9e62", "#8a4fb0", "#b3261e", "#0f8b8d"], []
    for n, robot in enumerate(content["robots"]):
        stops = _stops(source, robot)
        if not stops:
            continue
        ways = " ".join(f"{at(place)[0]:.1f},{at(place)[1]:.1f}" for _, place in stops)
        times = ";".join(f"{min(1.0, t / end_s):.4f}" for t, _ in stops)
        color = colors[n % len(colors)]
        moves = "".join(f'<animate attributeName="{axis}" dur="30s" repeatCount="indefinite" keyTimes="0;{times};1" values="{values}"/>'
                        for axis, values in (("cx", _values(stops, at, 0)), ("cy", _values(stops, at, 1))))
        drawn.append(f'<polyline points="{ways}" fill="none" stroke="{color}" stroke-opacity=".35" stroke-width="2"/>'
                     f'<circle r="7" fill="{color}">{moves}<title>{html.escape(robot["name"])}</title></circle>')
    marks = "".join(f'<rect x="{at(p)[0] - 4:.1f}" y="{at(p)[1] - 4:.1f}" width="8" height="8" fill="#7a8794"/>'
                    f'<text x="{at(p)[0] + 7:.1f}" y="{at(p)[1] - 6:.1f}">{html.escape(p)}</text>' for p in stations)
    width, height = (most[0] - least[0]) * scale, (most[1] - least[1]) * scale
    return (f'<p>Straight lines between places; the driven paths are in missions/.</p><svg style="max-width:{width:.0f}px" '
            f'viewBox="0 0 {width:.0f} {height:.0f}" role="img">{marks}{"".join(drawn)}</svg>')


def _values(stops: list[tuple[float, str]], at: Any, axis: int) -> str:
    values = [at(place)[axis] for _, place in stops]
    return ";".join(f"{v:.1f}" for v in (values[0], *values, values[-1]))


def _stops(source: Any, robot: dict[str, Any]) -> list[tuple[float, str]]:
    """Times at which a robot is at a place; inside of a mission, evenly over its stops."""
    missions, found = {m["name"]: m for m in source.content["missions"]}, []
    for item in robot["timeline"]:
        places = [s["station"] for s in missions[item["mission"]]["stops"]] if "mission" in item else [item.get("from", item.get("at", ""))]
        places += [item["to"]] if "to" in item else []
        for k, place in enumerate(places):
            found.append((item["from_s"] + (item["to_s"] - item["from_s"]) * k / max(1, len(places) - 1), place))
    return found


def _table(content: dict[str, Any]) -> str:
    rows = "".join(f'<tr class="{"late" if m["late_s"] else ""}"><td>{html.escape(m["name"])}</td><td>{html.escape(m["robot"])}</td>'
                   f'<td class="n">{m["from_s"]}</td><td class="n">{m["to_s"]}</td><td class="n">{m["late_s"]}</td>'
                   f'<td>{html.escape(m["why"])}</td></tr>' for m in content["missions"])
    return ('<div class="wide"><table><tr><th>mission</th><th>robot</th><th class="n">begins, s</th><th class="n">ends, s</th>'
            f'<th class="n">late, s</th><th>why</th></tr>{rows}</table></div>')
