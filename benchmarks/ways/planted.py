#!/usr/bin/env python3
"""Floors that are built about a known drive: the plan must exist and take no more than that drive, as Markdown.

usage: planted.py FOLDER PROGRAM COUNT SEED NOTE
A drive of straight lines and turns in place is drawn first; obstacles then stand only where its outline never comes.
"""
import json
import math
import pathlib
import random
import sys

from orders import plan
from programs import SCENARIOS, quantile

WIDTH_M, HEIGHT_M = 9, 7
CLEARANCE_M = 0.05
SPARE_M = 0.012  # beyond the clearance; 0.01 m of it is what the swept outline moves between two samples
STEP_M, STEP_RAD = 0.02, 0.02
ENOUGH_PERCENT = 0.1
OUTLINES = {"disc": None, "slim": (-0.45, 0.45, 0.18), "axle in front": (-0.527, 0.296, 0.296)}  # rear, front, half width, m
RADIUS_M = 0.25
FLOORS = ("carved", "posts", "walls")
RESOLUTIONS_M = (0.05, 0.1, 0.2)


def outline_distance_m(outline, x_m, y_m):
    """From the outline to a point of the robot's frame."""
    if outline is None:
        return math.hypot(x_m, y_m) - RADIUS_M
    rear_m, front_m, half_m = outline
    return math.hypot(max(rear_m - x_m, 0, x_m - front_m), max(abs(y_m) - half_m, 0))


def drawn_drive(draw, room_m):
    """Corners of a drive that is far from straight."""
    while True:
        corners = [(draw.uniform(room_m, WIDTH_M - room_m), draw.uniform(room_m, HEIGHT_M - room_m))
                   for _ in range(draw.choice((3, 4, 5)))]
        steps_m = [math.dist(a, b) for a, b in zip(corners, corners[1:])]
        if min(steps_m) > 1 and math.dist(corners[0], corners[-1]) > 3:
            return corners


def poses_of(corners):
    bearings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in zip(corners, corners[1:])]
    for k, (a, b) in enumerate(zip(corners, corners[1:])):
        if k:
            turn = (bearings[k] - bearings[k - 1] + math.pi) % (2 * math.pi) - math.pi
            count = math.ceil(abs(turn) / STEP_RAD)
            yield from ((*a, bearings[k - 1] + turn * i / count) for i in range(count + 1))
        count = math.ceil(math.dist(a, b) / STEP_M)
        yield from ((a[0] + (b[0] - a[0]) * i / count, a[1] + (b[1] - a[1]) * i / count, bearings[k]) for i in range(count + 1))


class Cells:
    """A floor in its own frame."""

    def __init__(self, resolution_m):
        self.resolution_m = resolution_m
        self.width, self.height = round(WIDTH_M / resolution_m), round(HEIGHT_M / resolution_m)
        self.blocked = [[False] * self.width for _ in range(self.height)]
        self.swept = [[False] * self.width for _ in range(self.height)]

    def sweep(self, outline, corners):
        far_m = CLEARANCE_M + SPARE_M + self.resolution_m * math.sqrt(0.5)
        reach = math.ceil((RADIUS_M if outline is None else math.hypot(max(-outline[0], outline[1]), outline[2]) + far_m)
                          / self.resolution_m) + 2
        for x_m, y_m, heading_rad in poses_of(corners):
            c, s = math.cos(heading_rad), math.sin(heading_rad)
            column, row = int(x_m / self.resolution_m), int(y_m / self.resolution_m)
            for i in range(max(0, row - reach), min(self.height, row + reach + 1)):
                for k in range(max(0, column - reach), min(self.width, column + reach + 1)):
                    dx, dy = (k + 0.5) * self.resolution_m - x_m, (i + 0.5) * self.resolution_m - y_m
                    if outline_distance_m(outline, c * dx + s * dy, c * dy - s * dx) < far_m:
                        self.swept[i][k] = True

    def block(self, hit):
        for i, row in enumerate(self.swept):
            for k, swept in enumerate(row):
                if not swept and hit((k + 0.5) * self.resolution_m, (i + 0.5) * self.resolution_m):
                    self.blocked[i][k] = True

    def fill(self, kind, draw):
        rim_m = 2 * self.resolution_m
        self.block(lambda x, y: min(x, y, WIDTH_M - x, HEIGHT_M - y) < rim_m)
        if kind == "carved":
            self.block(lambda x, y: True)
        for _ in range(70 if kind == "posts" else 0):
            left, low = draw.uniform(0, WIDTH_M), draw.uniform(0, HEIGHT_M)
            width_m, height_m = draw.uniform(0.05, 0.4), draw.uniform(0.05, 0.4)
            self.block(lambda x, y: 0 <= x - left < width_m and 0 <= y - low < height_m)
        for _ in range(9 if kind == "walls" else 0):  # each with a slit that some outlines pass
            x0, y0, bearing = draw.uniform(1, WIDTH_M - 1), draw.uniform(1, HEIGHT_M - 1), draw.uniform(0, math.pi)
            slit_m, half_m, reach_m = draw.uniform(0.5, 0.9), 0.05 + 0.35 * self.resolution_m, draw.uniform(1, 2.5)
            c, s = math.cos(bearing), math.sin(bearing)
            self.block(lambda x, y: abs(c * (y - y0) - s * (x - x0)) < half_m
                       and slit_m / 2 < abs(c * (x - x0) + s * (y - y0)) < reach_m)

    def write(self, folder, origin):
        image = b"".join(bytes(0 if blocked else 254 for blocked in row) for row in reversed(self.blocked))
        (folder / "planted.pgm").write_bytes(b"P5\n%d %d\n255\n" % (self.width, self.height) + image)
        (folder / "planted.yaml").write_text(
            f"image: planted.pgm\nmode: trinary\nresolution: {self.resolution_m}\norigin: {list(origin)}\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.25\n")


def robot_of(folder, outline):
    text = (SCENARIOS / "robots/nomad_super_scout.yaml").read_text()
    footprint = f"{{radius_m: {RADIUS_M}}}"
    if outline:
        rear_m, front_m, half_m = outline
        footprint = "{polygon_m: " + str([[front_m, half_m], [rear_m, half_m], [rear_m, -half_m], [front_m, -half_m]]) + "}"
    lines = [f"footprint: {footprint}" if line.startswith("footprint:") else line for line in text.splitlines()]
    (folder / "robot.yaml").write_text("\n".join(lines) + "\n")


def case_of(folder, program, draw, shape, kind, resolution_m):
    """What a search's plan costs more than the planted drive (percent; infinite: none was found), and its CPU (s)."""
    outline = OUTLINES[shape]
    room_m = 2 * resolution_m + CLEARANCE_M + (RADIUS_M if outline is None else math.hypot(max(-outline[0], outline[1]), outline[2])) + 0.1
    corners = drawn_drive(draw, room_m)
    cells = Cells(resolution_m)
    cells.sweep(outline, corners)
    cells.fill(kind, draw)
    yaw = draw.choice((0, round(draw.uniform(-math.pi, math.pi), 3)))
    origin = (round(draw.uniform(-5, 5), 3), round(draw.uniform(-5, 5), 3), yaw)
    cells.write(folder, origin)
    robot_of(folder, outline)
    c, s = math.cos(yaw), math.sin(yaw)
    places = [[origin[0] + c * x - s * y, origin[1] + s * x + c * y] for x, y in corners]
    (x0, y0), (x1, y1) = places[:2]
    start = {"x_m": x0, "y_m": y0, "heading_rad": math.atan2(y1 - y0, x1 - x0)}
    mission = {"robot": str(folder / "robot.yaml"), "map": str(folder / "planted.yaml"), "clearance_m": CLEARANCE_M,
               "stations": {"start": start, "goal": {"x_m": places[-1][0], "y_m": places[-1][1]}}, "start": {"station": "start"},
               "objective": {"minimize": "energy"}}
    lines = [[a, [a[0] + (b[0] - a[0]) / 3, a[1] + (b[1] - a[1]) / 3], [a[0] + (b[0] - a[0]) * 2 / 3, a[1] + (b[1] - a[1]) * 2 / 3], b]
             for a, b in zip(places, places[1:])]
    known, _ = plan(program, folder, {**mission, "legs": [{"path": {"bezier_m": lines, "frame": "map"}, "payload_kg": 3}]})
    assert known.get("energy_J"), f"the planted drive is refused: {known.get('infeasibility')}"
    found, spent_s = plan(program, folder, {**mission, "legs": [{"to": "goal", "payload_kg": 3}]})
    above = 100 * (found["energy_J"] / known["energy_J"] - 1) if found.get("energy_J") else math.inf
    print(shape, kind, resolution_m, f"{above:+.2f} %", f"{spent_s:.1f} s", file=sys.stderr, flush=True)
    return above, spent_s


def main():
    folder, program, count, seed, note = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:]
    folder.mkdir(parents=True, exist_ok=True)
    rows = {}
    for k in range(int(count)):
        shape, kind = list(OUTLINES)[k % 3], FLOORS[k // 3 % 3]
        draw = random.Random(f"{seed} {k}")
        rows.setdefault((shape, kind), []).append(
            case_of(folder, program, draw, shape, kind, RESOLUTIONS_M[k // 9 % 3]))
    print(f"# Floors about a known drive\n\n{note}\n")
    print("A drive of straight lines and turns in place is drawn, then obstacles where its outline and clearance never come. "
          "`carved`: everywhere else; `posts`: 70 boxes; `walls`: nine with slits of 0.5 to 0.9 m. Cells of 0.05, 0.1 and 0.2 m, "
          "half of the maps turned. A search must find a plan, and none that takes more than the drive. "
          "Solver `fast`, user CPU of the whole command.\n")
    print(f"| outline | floor | missions | no plan | dearer than the drive by more than {ENOUGH_PERCENT} % | against the drive, median | "
          "worst | CPU, median | most |")
    print("|---|---|---|---|---|---|---|---|---|")
    for (shape, kind), cases in rows.items():
        above, spent_s = zip(*cases)
        found = [value for value in above if math.isfinite(value)]
        against = f"{quantile(found, 0.5):+.2f} % | {max(found):+.2f} %" if found else "none | none"
        print(f"| {shape} | {kind} | {len(cases)} | {len(above) - len(found)} | {sum(value > ENOUGH_PERCENT for value in found)} | {against} | "
              f"{quantile(spent_s, 0.5):.1f} s | {max(spent_s):.1f} s |")



if __name__ == "__main__":
    main()
