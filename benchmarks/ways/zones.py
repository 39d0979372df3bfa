#!/usr/bin/env python3
"""Plans on floors with slow or rough parts against floors with a wall in their place, as Markdown.

usage: zones.py FOLDER OLD_PROGRAM NEW_PROGRAM NOTE COUNT SEED
A speed mask or a patch of rolling resistance covers one to three boxes between the stops of two legs. With walls there,
the problem is harder, so that its plan should never be the cheaper one. The stops lie outside of the boxes.
"""
import json
import pathlib
import random
import sys

import programs

SIDE_M, CELL_M, ORIGIN_M = 16, 0.05, (-3, -8)
KINDS = ("mask", "patch")


def drawn_boxes(draw):
    """Boxes [x0, x1, y0, y1] across the line from (0, 0) to (10, 0)."""
    boxes, x = [], draw.uniform(1.5, 3)
    while x < 8 and len(boxes) < 3:
        deep = draw.uniform(0.3, 2.5)
        boxes.append([x, min(x + deep, 8.5), -draw.uniform(0.1, 3), draw.uniform(0.1, 3)])
        x += deep + draw.uniform(0.8, 3)
    return boxes


def write_map(folder, name, boxes, inside, scale):
    cells = round(SIDE_M / CELL_M)
    rows = []
    for row in reversed(range(cells)):
        y = ORIGIN_M[1] + (row + 0.5) * CELL_M
        line = bytearray(b"\xfe" * cells)
        for column in range(cells):
            x = ORIGIN_M[0] + (column + 0.5) * CELL_M
            if any(x0 < x < x1 and y0 < y < y1 for x0, x1, y0, y1 in boxes):
                line[column] = inside
        rows.append(bytes(line))
    (folder / f"{name}.pgm").write_bytes(b"P5\n%d %d\n255\n" % (cells, cells) + b"".join(rows))
    mode, occupied, free = ("scale", 1.0, 0.0) if scale else ("trinary", 0.65, 0.25)
    (folder / f"{name}.yaml").write_text(
        f"image: {name}.pgm\nmode: {mode}\nresolution: {CELL_M}\norigin: [{ORIGIN_M[0]}, {ORIGIN_M[1]}, 0]\n"
        f"negate: 0\noccupied_thresh: {occupied}\nfree_thresh: {free}\n")


def case(folder, draw, kind, goal):
    """A mission over the boxes, and the same with walls."""
    boxes, slow = drawn_boxes(draw), draw.choice((0.2, 0.4, 0.6, 0.8))
    write_map(folder, "floor", [], 0, False)
    write_map(folder, "walls", boxes, 0, False)
    write_map(folder, "mask", boxes, round(255 * slow), True)
    robot = programs.SCENARIOS / "robots/nomad_super_scout.yaml"
    if kind == "patch":
        effect = {"floor_patch": {"coefficient": draw.choice((0.01, 0.03, 0.1)), "cells": boxes}}
        lines, robot = robot.read_text().splitlines(), folder / "robot.yaml"
        lines = [f"effects: {json.dumps([effect])}" if line.startswith("effects:") else line for line in lines]
        robot.write_text("\n".join(lines) + "\n")
    mission = {"robot": str(robot), "map": "floor.yaml", "clearance_m": 0.05,
               "stations": {"a": {"x_m": 10.0, "y_m": 0.0}, "b": {"x_m": 10.5, "y_m": round(draw.uniform(-4, 4), 2)}},
               "start": {"x_m": 0.0, "y_m": 0.0, "heading_rad": 0.0}, "legs": [{"to": "a"}, {"to": "b"}],
               "objective": {"minimize": goal}}
    if kind == "mask":
        mission["speed_mask"] = {"file": "mask.yaml", "kind": "percent"}
    return mission, {**mission, "map": "walls.yaml"}


def cost(program, folder, name, mission):
    energy_J, spent_s = programs.plan(program, folder, name, mission)
    of_time = mission["objective"]["minimize"] == "time"
    return json.loads((folder / f"{name}.json").read_text())["duration_s"] if of_time else energy_J, spent_s


def main():
    folder, old, new, note = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:5]
    count, seed = map(int, sys.argv[5:])
    folder.mkdir(parents=True, exist_ok=True)
    draw = random.Random(seed)
    print(f"# Slow and rough parts of a floor\n\n{note}\n")
    print("Two legs past one to three boxes, where a speed mask allows 20 to 80 % of the speed or the floor rolls badly; judge: "
          "the same mission with walls for boxes, the harder problem. The cost is the energy, or the time where it is minimized.\n")
    print("| parts | minimized | floors | dearer than with walls by 0.1 %, before | now | worst before | worst now | "
          "change of the cost, mean | worst | CPU before | CPU now |\n|---|---|---|---|---|---|---|---|---|---|---|")
    for kind in KINDS:
        for goal in ("energy", "time"):
            rows = []
            for k in range(count):
                open_floor, walled = case(folder, draw, kind, goal)
                before, now = cost(old, folder, "old", open_floor), cost(new, folder, "new", open_floor)
                walls, _ = cost(new, folder, "walls_plan", walled)
                rows.append((before, now, walls))
                print(kind, goal, k, before, now, walls, file=sys.stderr)
            excess = [[100 * (row[i][0] / row[2] - 1) for row in rows if row[2]] for i in (0, 1)]
            change = [100 * (now[0] / before[0] - 1) for before, now, _ in rows]
            print(f"| {kind} | {goal} | {count} | {sum(e > 0.1 for e in excess[0])} | {sum(e > 0.1 for e in excess[1])} | "
                  f"{max(excess[0]):+.1f} % | {max(excess[1]):+.1f} % | {sum(change) / count:+.1f} % | {max(change):+.2f} % | "
                  f"{sum(row[0][1] for row in rows):.1f} s | {sum(row[1][1] for row in rows):.1f} s |", flush=True)


if __name__ == "__main__":
    main()
