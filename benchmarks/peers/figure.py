"""The summary figure: CPU-time ratios on a logarithmic axis, joules above the optimum on a linear one."""

import math
import statistics
from xml.sax.saxutils import escape

WIDTH, LEFT, ROW, BAR = 860, 330, 22, 470
INK, PEER, GRID = "#24292f", "#c2571a", "#d0d7de"


def rows_of(answers):
    ratios, joules = {}, {}
    for answer in answers.values():
        ratios.update({k: v for k, v in answer.get("summary", {}).items() if v})
        joules.update({k: v for k, v in answer.get("energy", {}).items() if v})
        for robot, found in answer.get("bars", {}).items():
            joules.update(
                {f"{robot}: {name.replace('_', ' ')}": v for name, v in found.items() if v and name.startswith("trapezoid")}
            )
        joules.update({f"driven in MuJoCo: {name.replace('_', ' ')}": v for name, v in answer.get("survive", {}).items() if v})
    return ratios, joules


def percent(value):
    return f"{value:.2g} %" if abs(value) >= 0.01 else "below 0.01 %"


def panel(parts, y, title, rows, place, ticks, label):
    """One panel of medians with their ranges; `place` maps a value to 0..1, `label` to a text."""
    parts.append(f'<text x="16" y="{y}" font-weight="600">{escape(title)}</text>')
    bottom = y + 12 + ROW * len(rows)
    for value, tick in ticks:
        x = LEFT + BAR * place(value)
        parts.append(
            f'<line x1="{x:.1f}" y1="{y + 10}" x2="{x:.1f}" y2="{bottom}" stroke="{GRID}"/>'
            f'<text x="{x:.1f}" y="{bottom + 14}" text-anchor="middle" font-size="11">{tick}</text>'
        )
    for i, (name, values) in enumerate(rows):
        at = y + 22 + ROW * i
        low, middle, high = (LEFT + BAR * place(v) for v in (min(values), statistics.median(values), max(values)))
        parts.append(
            f'<text x="{LEFT - 10}" y="{at + 4}" text-anchor="end">{escape(name)}</text>'
            f'<line x1="{low:.1f}" y1="{at}" x2="{high:.1f}" y2="{at}" stroke="{PEER}" stroke-width="2"/>'
            f'<circle cx="{middle:.1f}" cy="{at}" r="4.5" fill="{PEER}"/>'
            f'<text x="{min(high + 8, WIDTH - 40):.1f}" y="{at + 4}" font-size="11">{label(statistics.median(values))}</text>'
        )
    return bottom + 44


def drawing(parts, height):
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-size="12" fill="{INK}" '
    head += f'font-family="Helvetica, Arial, sans-serif">\n<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>\n'
    return head + "\n".join(parts) + "\n</svg>\n"


def percent_axis(values):
    """Place on the axis, and its ticks: from 0 to the greatest value, 60 % at most."""
    most = max(5.0, min(60.0, max(values)))
    step = 10 if most > 25 else 5 if most > 10 else 1
    return lambda v: min(1.0, max(0.0, v / most)), [(v, f"{v} %") for v in range(0, int(most) + 1, step)]


def classic_profiles(bars, own_error):
    """A panel per robot: motor energy that the optimum saves against each classic profile, and the model's own error."""
    place, ticks = percent_axis([v for found in bars.values() for values in found.values() for v in values])
    parts, y = [], 28
    for robot, found in bars.items():
        rows = [(name.replace("_", " "), values) for name, values in found.items() if values]
        if robot.startswith("nomad"):  # the only one that was measured
            rows.append(("(the model's own error)", own_error))
        y = panel(
            parts, y, f"{robot}: motor energy that the optimum saves, equal time, no jerk limit", rows, place, ticks, percent
        )
    return drawing(parts, y - 16)


def svg(answers):
    ratios, joules = rows_of(answers)
    parts, y = [], 28
    if ratios:
        powers = range(
            math.floor(math.log10(min(min(v) for v in ratios.values()))),
            math.ceil(math.log10(max(max(v) for v in ratios.values()))) + 1,
        )
        span = max(1, len(powers) - 1)
        place = lambda v: min(1.0, max(0.0, (math.log10(v) - powers[0]) / span))
        labels = [(10.0**p, f"10<tspan dy='-4' font-size='8'>{p}</tspan>" if p not in (0, 1, 2) else str(10**p)) for p in powers]
        y = panel(
            parts,
            y,
            "CPU time of the peer over ours (right of 1: the peer takes longer)",
            list(ratios.items()),
            place,
            labels,
            "{:.3g}".format,
        )
    if joules:
        place, labels = percent_axis([v for values in joules.values() for v in values])
        title = "Energy above the optimum in the same time; of trapezoids: motor energy saved; in MuJoCo: whole energy saved"
        y = panel(parts, y, title, list(joules.items()), place, labels, percent)
    return drawing(parts, y - 16)
