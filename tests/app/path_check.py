#!/usr/bin/env python3
"""path_check.py PROGRAM [COUNT]: holds the program's answer about random paths on a random map against a footprint
check of its own (Bezier curves, turns in place and cells' squares written anew; standard library alone)."""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

WIDTH, HEIGHT, CELL_M = 60, 40, 0.2
STEP_M = 0.004
UNSURE_M = 0.006  # a clearance missed or kept by less is nobody's business here


def make_map(folder, rng):
    blocked = {(c, r) for c in range(WIDTH) for r in range(HEIGHT) if rng.random() < 0.02}
    rows = [" ".join("0" if (c, r) in blocked else "254" for c in range(WIDTH)) for r in reversed(range(HEIGHT))]
    (folder / "map.pgm").write_text(f"P2 {WIDTH} {HEIGHT} 255\n" + "\n".join(rows) + "\n")
    (folder / "map.yaml").write_text(f"image: map.pgm\nresolution: {CELL_M}\norigin: [0, 0, 0]\nnegate: 0\n"
                                     "occupied_thresh: 0.65\nfree_thresh: 0.25\n")
    rim = {(c, r) for c in range(-15, WIDTH + 15) for r in range(-15, HEIGHT + 15)
           if not (0 <= c < WIDTH and 0 <= r < HEIGHT)}
    return [(CELL_M * c, CELL_M * r) for c, r in blocked | rim]


def bezier(p, t):
    u = 1 - t
    weights = (u ** 3, 3 * u * u * t, 3 * u * t * t, t ** 3)
    return [sum(w * q[i] for w, q in zip(weights, p)) for i in (0, 1)]


def poses_along(start, p):
    """(x, y, heading, arc length) from the start: the turn to the curve's heading, then the curve."""
    heading = math.atan2(p[1][1] - p[0][1], p[1][0] - p[0][0])
    turn = math.remainder(heading - start[2], 2 * math.pi)
    count = int(abs(turn) / STEP_M) + 1
    poses = [(start[0], start[1], start[2] + turn * i / count, 0.0) for i in range(count + 1)]
    length, before = 0.0, bezier(p, 0)
    n = int(sum(math.dist(a, b) for a, b in zip(p, p[1:])) / STEP_M) + 1
    for i in range(1, n + 1):
        here = bezier(p, i / n)
        a, b = bezier(p, max(0, i / n - 1e-5)), bezier(p, min(1, i / n + 1e-5))
        length += math.dist(before, here)
        before = here
        poses.append((here[0], here[1], math.atan2(b[1] - a[1], b[0] - a[0]), length))
    return poses


def point_to_segment(p, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    t = max(0.0, min(1.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)))
    return math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy)


def convex_distance(p, q):
    """Between two convex polygons; 0 where they overlap (separating axes)."""
    for polygon in (p, q):
        for a, b in zip(polygon, polygon[1:] + polygon[:1]):
            nx, ny = b[1] - a[1], a[0] - b[0]
            mine = [nx * x + ny * y for x, y in p]
            other = [nx * x + ny * y for x, y in q]
            if max(mine) < min(other) or max(other) < min(mine):
                return min(point_to_segment(x, a, b) for one, two in ((p, q), (q, p)) for x in one
                           for a, b in zip(two, two[1:] + two[:1]))
    return 0.0


def clearance_at(pose, robot, cells):
    """Distance from the robot's outline to the nearest cell, 0 where they overlap."""
    x, y, heading, _ = pose
    least, c, s = math.inf, math.cos(heading), math.sin(heading)
    radius = robot.get("radius_m") or max(math.hypot(*corner) for corner in robot["polygon_m"])
    outline = [(x + c * u - s * v, y + s * u + c * v) for u, v in robot.get("polygon_m", [])]
    for left, low in cells:
        to_square = math.hypot(max(left - x, 0, x - left - CELL_M), max(low - y, 0, y - low - CELL_M))
        if to_square - radius >= min(least, 0.3):
            continue
        if not outline:
            least = min(least, max(0.0, to_square - radius))
            continue
        square = [(left, low), (left + CELL_M, low), (left + CELL_M, low + CELL_M), (left, low + CELL_M)]
        least = min(least, convex_distance(outline, square))
    return least


def shrunk(robot):
    """Smaller by at least UNSURE_M on all sides: an overlap of this one is nobody's rounding."""
    if "radius_m" in robot:
        return {"radius_m": robot["radius_m"] - UNSURE_M}
    return {"polygon_m": [[0.96 * x, 0.96 * y] for x, y in robot["polygon_m"]]}


def write_mission(folder, number, rng):
    start = (rng.uniform(0.8, 11), rng.uniform(0.8, 7), rng.uniform(-3, 3))
    p, away = [(0.0, 0.0)], 0.0
    for _ in range(3):
        away += rng.uniform(-0.7, 0.7)
        reach = rng.uniform(0.4, 1.2)
        p.append((p[-1][0] + reach * math.cos(away), p[-1][1] + reach * math.sin(away)))
    frame = rng.choice(["start", "map"])
    c, s = math.cos(start[2]), math.sin(start[2])
    on_map = [(start[0] + c * x - s * y, start[1] + s * x + c * y) for x, y in p]
    if frame == "map":
        p = on_map
    clearance = rng.choice([0, 0.05, 0.1])
    file = folder / f"m{number}.yaml"
    file.write_text(
        f"robot: robot.yaml\nmap: map.yaml\nclearance_m: {clearance}\n"
        f"start: {{x_m: {start[0]!r}, y_m: {start[1]!r}, heading_rad: {start[2]!r}}}\n"
        f"legs: [{{path: {{frame: {frame}, bezier_m: [{[list(q) for q in p]!r}]}}}}]\n")
    return file, start, on_map, clearance


def answer(program, folder, file):
    out = folder / "out"
    run = subprocess.run([program, "plan", file, "--out", out, "--force", "-q", "--solver", "fast", "--nodes", "20",
                          "--accuracy", "0.1", "--without", "baselines"], capture_output=True, text=True, check=False)
    plan = json.loads((out / "plan.json").read_text()) if run.returncode in (0, 1) else {}
    return run, plan


def compare(program, folder, number, rng, robot, cells):
    """Complaint or None, and whether the path is free; None as well where it is too close to call."""
    file, start, curve, clearance = write_mission(folder, number, rng)
    poses = poses_along(start, curve)
    near = [(x, y) for x, y in cells
            if min(math.hypot(x - q[0], y - q[1]) for q in poses[::50]) < 1.6]
    slack = [clearance_at(pose, robot, near) - clearance for pose in poses]
    least = min(slack)
    if abs(least) < UNSURE_M and (clearance > 0 or min(clearance_at(q, shrunk(robot), near) for q in poses) > 0):
        return None, None
    run, plan = answer(program, folder, file)
    free = least > 0
    if run.returncode != (0 if free else 1):
        return f"{file.name}: least slack {least:.4f} m, but exit {run.returncode}: {run.stderr}", free
    if free:
        return None, True
    verdict = plan["infeasibility"]
    at = min(poses, key=lambda q: abs(q[3] - verdict["arc_length_m"]) + math.dist(q[:2], (verdict["x_m"], verdict["y_m"])))
    if math.dist(at[:2], (verdict["x_m"], verdict["y_m"])) > 0.02:
        return f"{file.name}: no place of the path: {verdict}", False
    place = (verdict["x_m"], verdict["y_m"])  # a turn in place has many poses there
    here = min(slack[i] for i, q in enumerate(poses)
               if math.dist(q[:2], place) <= 0.02 and abs(q[3] - verdict["arc_length_m"]) <= 0.02)
    if here > UNSURE_M:
        return f"{file.name}: free by {here:.4f} m where the verdict is: {verdict}", False
    if verdict["constraint"] != "path" or verdict["amount"] < -least - UNSURE_M:
        return f"{file.name}: short by {-least:.4f} m: {verdict}", False
    return None, False


def main(program, count):
    source = pathlib.Path(__file__).resolve().parents[2] / "scenarios" / "robots" / "nomad_super_scout.yaml"
    counts = {True: 0, False: 0, None: 0}
    with tempfile.TemporaryDirectory() as name:
        folder, rng = pathlib.Path(name), random.Random(14)
        for number in range(count):
            robot = rng.choice([{"radius_m": 0.25}, {"polygon_m": [[0.45, 0.2], [-0.25, 0.2], [-0.25, -0.2], [0.45, -0.2]]},
                                {"polygon_m": [[0.3, 0.0], [0.0, 0.3], [-0.5, 0.1], [-0.5, -0.1], [0.0, -0.3]]}])
            lines = source.read_text().splitlines()
            lines = [f"footprint: {json.dumps(robot)}" if line.startswith("footprint:") else line for line in lines]
            (folder / "robot.yaml").write_text("\n".join(lines) + "\n")
            if number % 20 == 0:
                cells = make_map(folder, rng)
            complaint, free = compare(program, folder, number, rng, robot, cells)
            counts[free] += 1
            if complaint:
                print(complaint)
                return 1
    print(f"path check: {counts[True]} free, {counts[False]} blocked, {counts[None]} too close to call; all agree")
    return 0 if min(counts[True], counts[False]) > count / 20 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 40))
