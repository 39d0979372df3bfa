"""Plots as SVG text, by hand: bars of color for found and missed, lines for curves."""
import html
import math

INK, GRID, HIT, MISS, UNSEEN = "#222", "#ddd", "#1b7f5a", "#c2410c", "#b9b9b9"


def svg(width, height, body):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
            f'font-family="sans-serif" font-size="11"><rect width="{width}" height="{height}" fill="white"/>'
            + "".join(body) + "</svg>\n")


def text(x, y, words, anchor="start", size=11, rotate=None):
    turn = f' transform="rotate({rotate} {x:.1f} {y:.1f})"' if rotate else ""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" font-size="{size}" fill="{INK}"{turn}>{html.escape(str(words))}</text>'


def power_plot(table):
    """One row per effect: every case at its size (logarithmic), green found, red missed, grey undetectable."""
    names = sorted(table)
    left, width, row = 210, 520, 18
    body = [text(8, 16, "size of the effect, smallest to largest drawn (logarithmic); green: found, red: missed, grey: no observer could")]
    for k, name in enumerate(names):
        y = 36 + k * row
        points = table[name]["points"]
        logs = [math.log(s) for s, _, _ in points if s > 0]
        low, high = min(logs, default=0.0), max(logs, default=0.0)
        span = (high - low) or 1.0
        body.append(text(left - 8, y + 4, name, "end"))
        body.append(f'<line x1="{left}" x2="{left + width}" y1="{y}" y2="{y}" stroke="{GRID}"/>')
        for size, found, seen in points:
            if size <= 0:
                continue
            place = (math.log(size) - low) / span
            if name == "wheel_slip":
                place = 1 - place
            color = HIT if found else (MISS if seen else UNSEEN)
            body.append(f'<circle cx="{left + place * width:.1f}" cy="{y}" r="3.5" fill="{color}" fill-opacity="0.75"/>')
    return svg(left + width + 20, 46 + row * len(names), body)


def is_right(true, said):
    """Null sets want silence, foreign causes that none fits, the others their name."""
    if true == "(null)":
        return said == "(no_gap)"
    return said in ("(unexplained)", "(partly_explained)") if true.endswith("(foreign)") else said == true


def confusion_plot(table):
    """Rows: truth; columns: what was said first."""
    rows = sorted(table)
    columns = sorted({said for row in table.values() for said in row}, key=lambda s: (s.startswith("("), s))
    cell, left, top = 17, 200, 170
    body = []
    for j, said in enumerate(columns):
        body.append(text(left + j * cell + 12, top - 6, said, "start", 10, -60))
    for i, true in enumerate(rows):
        y = top + i * cell
        total = sum(table[true].values())
        body.append(text(left - 6, y + 12, true, "end", 10))
        for j, said in enumerate(columns):
            count = table[true].get(said, 0)
            share = count / total
            color = HIT if is_right(true, said) else MISS
            fill = f'fill="{color}" fill-opacity="{0.12 + 0.88 * share:.2f}"' if count else 'fill="#f6f6f6"'
            body.append(f'<rect x="{left + j * cell}" y="{y}" width="{cell - 1}" height="{cell - 1}" {fill}/>')
            if count:
                body.append(text(left + j * cell + cell / 2 - 0.5, y + 12, count, "middle", 8))
    return svg(left + cell * len(columns) + 110, top + cell * len(rows) + 10, body)


def line_plot(title, x_name, y_name, lines, diagonal=False):
    """Curves on the unit square: lines is {name: [(x, y), ...]}."""
    left, top, size = 50, 30, 300
    colors = ["#1d4ed8", "#c2410c", "#1b7f5a", "#7c3aed", "#444"]
    place = lambda x, y: f"{left + x * size:.1f},{top + (1 - y) * size:.1f}"
    body = [text(left, 18, title, size=12)]
    for k in range(6):
        level = k / 5
        body.append(f'<line x1="{left}" x2="{left + size}" y1="{top + level * size:.1f}" y2="{top + level * size:.1f}" stroke="{GRID}"/>')
        body.append(text(left - 6, top + (1 - level) * size + 4, f"{level:.1f}", "end", 9))
        body.append(text(left + level * size, top + size + 14, f"{level:.1f}", "middle", 9))
    if diagonal:
        body.append(f'<polyline points="{place(0, 0)} {place(1, 1)}" fill="none" stroke="#999" stroke-dasharray="4 3"/>')
    for k, (name, points) in enumerate(lines.items()):
        color = colors[k % len(colors)]
        body.append(f'<polyline points="{" ".join(place(min(1, max(0, x)), min(1, max(0, y))) for x, y in points)}" fill="none" stroke="{color}" stroke-width="2"/>')
        for x, y in points if diagonal else []:
            body.append(f'<circle cx="{left + x * size:.1f}" cy="{top + (1 - y) * size:.1f}" r="3" fill="{color}"/>')
        body.append(f'<text x="{left + size + 10}" y="{top + 14 + 16 * k}" fill="{color}">{html.escape(name)}</text>')
    body.append(text(left + size / 2, top + size + 30, x_name, "middle"))
    body.append(text(14, top + size / 2, y_name, "middle", 11, -90))
    return svg(left + size + 170, top + size + 42, body)
