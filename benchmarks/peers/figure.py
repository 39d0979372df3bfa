"""The figures: medians with their ranges, a panel per question, each with its own axis.

Names stand above their lines, so that the figure can be read on a screen of 400 pixels. Orange: ours is better; blue: the
peer is better; gray: neither in all repeats, or no comparison.
"""

import math
import statistics
from xml.sax.saxutils import escape

WIDTH, MARGIN, ROW = 480, 14, 33
BAR = WIDTH - 2 * MARGIN - 74  # the last 74 are the figure's text
INK, OURS, PEER, NEITHER, GRID = "#24292f", "#c2571a", "#1a6fc2", "#6e7781", "#d0d7de"


def percent(value):
    return f"{value:.2g} %" if abs(value) >= 0.01 else "&lt; 0.01 %"


def times(ratio):
    return f"{ratio:.3g} ×" if ratio >= 0.1 else f"1 / {1 / ratio:,.0f}" if ratio > 0.001 else f"1 / {float(f'{1 / ratio:.2g}'):,.0f}"


def color(values, even):
    """By the side of `even` on which all values lie: to the right ours is better. Without it nothing is compared."""
    if even is None:
        return NEITHER
    return OURS if min(values) >= even else PEER if max(values) < even else NEITHER


def panel(parts, y, title, rows, axis, label, even):
    """One panel; the axis is a place in 0..1 for a value, and its ticks. Returns where the next one begins."""
    place, ticks = axis
    parts.append(f'<text x="{MARGIN}" y="{y}" font-weight="600">{escape(title)}</text>')
    bottom = y + 12 + ROW * len(rows)
    for value, tick in ticks:
        x = MARGIN + BAR * place(value)
        parts.append(
            f'<line x1="{x:.1f}" y1="{y + 10}" x2="{x:.1f}" y2="{bottom}" stroke="{GRID}"/>'
            f'<text x="{x:.1f}" y="{bottom + 14}" text-anchor="middle" font-size="11">{tick}</text>'
        )
    for i, (name, values) in enumerate(rows):
        at, ink = y + 36 + ROW * i, color(values, even(name))
        low, middle, high = (MARGIN + BAR * place(v) for v in (min(values), statistics.median(values), max(values)))
        parts.append(
            f'<text x="{MARGIN + 4}" y="{at - 9}" stroke="#ffffff" stroke-width="3" paint-order="stroke">{escape(name)}</text>'
            f'<line x1="{low:.1f}" y1="{at}" x2="{high:.1f}" y2="{at}" stroke="{ink}" stroke-width="2.5"/>'
            f'<circle cx="{middle:.1f}" cy="{at}" r="4.5" fill="{ink}"/>'
            f'<text x="{WIDTH - MARGIN}" y="{at + 4}" text-anchor="end" font-weight="600" fill="{ink}">'
            f"{label(statistics.median(values))}</text>"
        )
    return bottom + 44


def drawing(parts, height):
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}" '
    head += f'font-size="13" fill="{INK}" font-family="Helvetica, Arial, sans-serif">\n'
    return head + f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>\n' + "\n".join(parts) + "\n</svg>\n"


def percent_axis(rows):
    """From the least value (or 0) to the greatest (5 % at least)."""
    every = [v for _, values in rows for v in values]
    most, least = max(5.0, max(every)), min(0.0, min(every))
    step = 20 if most - least > 40 else 10 if most - least > 25 else 5 if most - least > 10 else 1
    ticks = range(step * math.ceil(least / step), int(most) + 1, step)
    return lambda v: (v - least) / (most - least), [(v, f"{v} %") for v in ticks]


def ratio_axis(rows):
    low, high = (math.log10(edge(edge(v) for _, v in rows)) for edge in (min, max))
    first, last = math.floor(min(0, low)), math.ceil(max(0, high))
    names = {0: "1", 1: "10", 2: "100"}
    ticks = [(10.0**p, names.get(p, f"10<tspan dy='-4' font-size='8'>{p}</tspan>")) for p in range(first, last + 1)]
    return lambda v: (math.log10(v) - first) / (last - first), ticks


LEGEND = (
    "Dot: median. Line: range over problems, of CPU times over repeats.",
    "Orange: ours better in all cases. Blue: the peer. Gray: not in all.",
)
TRAPEZOID = "trapezoid at maximum acceleration"
OWN_ERROR = "(for scale: the model's own error on the Nomad)"


def even_at_zero(name):
    return None if name == OWN_ERROR else 0.0


def classic_profiles(bars, own_error):
    """A panel per robot: motor energy that the optimum saves against each classic profile, and the model's own error."""
    parts, y = [], 24
    for robot, found in bars.items():
        rows = [(name.replace("_", " "), values) for name, values in found.items() if values]
        if robot.startswith("nomad"):  # the only one that was measured
            rows.append((OWN_ERROR, own_error))
        title = f"{robot}: motor energy saved in equal time"
        y = panel(parts, y, title, rows, percent_axis(rows), percent, even_at_zero)
    for i, line in enumerate(LEGEND):
        parts.append(f'<text x="{MARGIN}" y="{y - 6 + 15 * i}" font-size="11" fill="{NEITHER}">{line}</text>')
    return drawing(parts, y + 20)


def pooled(bars):
    """Trapezoids over all robots."""
    names = {"trapezoid_max_acceleration": TRAPEZOID, "trapezoid_best_tuned": "best tuned trapezoid"}
    return {title: [x for found in bars.values() for x in found.get(name, [])] for name, title in names.items()}


def svg(answers):
    merged = {key: {} for key in ("summary", "energy", "survive")}
    for answer in answers.values():
        for key, found in merged.items():
            found.update({name.replace("_", " "): values for name, values in answer.get(key, {}).items() if values})
    ratios, bars = list(merged["summary"].items()), answers.get("baselines", {}).get("bars", {})
    saved = [(f"against the {name}", values) for name, values in pooled(bars).items() if values]
    if saved and "own_error" in answers["baselines"]:  # not in a kept answer of an older run
        saved.append((OWN_ERROR, answers["baselines"]["own_error"]))
    panels = [
        ("Energy above the optimum, same path and time", list(merged["energy"].items())),
        ("Motor energy saved on straight lines, three robots", saved),
        ("Energy saved as driven in MuJoCo, standby included", [(f"against the {k}", v) for k, v in merged["survive"].items()]),
    ]
    parts, y = [], 24
    if ratios:
        y = panel(parts, y, "CPU time of the peer over ours (right of 1: ours is faster)", ratios, ratio_axis(ratios), times, lambda _: 1)
    for title, rows in panels:
        if rows:
            y = panel(parts, y, title, rows, percent_axis(rows), percent, even_at_zero)
    for i, line in enumerate(LEGEND):
        parts.append(f'<text x="{MARGIN}" y="{y - 6 + 15 * i}" font-size="11" fill="{NEITHER}">{line}</text>')
    return drawing(parts, y + 20)
