#!/usr/bin/env python3
"""Plans of two programs on the same missions: CPU time and energies, as Markdown.

usage: programs.py FOLDER OLD_PROGRAM NEW_PROGRAM NOTE LEGS SEED
Missions of LEGS legs on three floors with three payloads; every second one names the headings at its stops.
"""
import json
import math
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios"
PAYLOADS_KG = (0, 6, 12)
MISSIONS = 12  # per floor: each payload with and without headings, twice
ROOM_M = 0.45  # to the nearest obstacle about a stop


class Floor:
    """A map whose free places can be drawn."""

    def __init__(self, name, image, resolution_m, origin, keys):
        self.name, self.keys = name, keys
        self.resolution_m, self.origin = resolution_m, origin
        data = image.read_bytes()
        fields, at = [], 0
        while len(fields) < 4:
            end = at
            while data[end : end + 1] not in (b" ", b"\n"):
                end += 1
            if data[at : at + 1] == b"#":
                end = data.index(b"\n", at)
            elif end > at:
                fields.append(data[at:end])
            at = end + 1
        self.width, self.height = int(fields[1]), int(fields[2])
        self.cells = data[at:]

    def free(self, x_m, y_m):
        column = int((x_m - self.origin[0]) / self.resolution_m)
        row = self.height - 1 - int((y_m - self.origin[1]) / self.resolution_m)
        return 0 <= column < self.width and 0 <= row < self.height and self.cells[row * self.width + column] > 250

    def place(self, draw):
        while True:
            x_m = self.origin[0] + draw.random() * self.width * self.resolution_m
            y_m = self.origin[1] + draw.random() * self.height * self.resolution_m
            steps = [k * 0.5 * self.resolution_m for k in range(int(2 * ROOM_M / self.resolution_m) + 1)]
            bearings = [k * math.pi / 16 for k in range(32)]
            if all(self.free(x_m + r * math.cos(b), y_m + r * math.sin(b)) for b in bearings for r in steps):
                return round(x_m, 3), round(y_m, 3)


def hall(folder, draw):
    """Racks in rows on 60 x 40 m, and boxes between them."""
    width, height, resolution_m = 1200, 800, 0.05
    cells = bytearray(b"\xfe" * (width * height))

    def fill(x0, y0, x1, y1):
        for row in range(int(y0 / resolution_m), min(height, int(y1 / resolution_m))):
            for column in range(int(x0 / resolution_m), min(width, int(x1 / resolution_m))):
                cells[(height - 1 - row) * width + column] = 0

    for i in range(12):
        for k in range(5):
            fill(3 + 10.5 * k, 3 + 3 * i, 11 + 10.5 * k, 4.2 + 3 * i)
    for _ in range(40):
        x, y = 60 * draw.random(), 40 * draw.random()
        fill(x, y, x + 0.3 + 0.5 * draw.random(), y + 0.3 + 0.5 * draw.random())
    (folder / "hall.pgm").write_bytes(b"P5\n%d %d\n255\n" % (width, height) + bytes(cells))
    (folder / "hall.yaml").write_text("image: hall.pgm\nmode: trinary\nresolution: 0.05\norigin: [0.0, 0.0, 0]\n"
                                      "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n")
    return Floor("hall of 60 x 40 m", folder / "hall.pgm", 0.05, (0, 0), {"map": str(folder / "hall.yaml")})


def warehouse():
    maps = SCENARIOS / "maps"
    return Floor("Nav2's warehouse", maps / "warehouse.pgm", 0.03, (-15.1, -25), {"map": str(maps / "warehouse.yaml")})


def depot():
    maps = SCENARIOS / "maps"
    return Floor("Nav2's depot", maps / "depot.pgm", 0.05, (0, 0), {"map": str(maps / "depot.yaml")})


def mission_on(floor, draw, payload_kg, headings, legs):
    def station():
        x_m, y_m = floor.place(draw)
        at = {"x_m": x_m, "y_m": y_m}
        turn = round(draw.uniform(-math.pi, math.pi), 3)
        return {**at, "heading_rad": turn} if headings else at

    start = {**station(), "heading_rad": round(draw.uniform(-math.pi, math.pi), 3)}
    stops = []
    for _ in range(legs):
        before = stops[-1] if stops else start
        while True:
            stop = station()
            reach_m = math.hypot(stop["x_m"] - before["x_m"], stop["y_m"] - before["y_m"])
            if 2 <= reach_m <= 14:
                break
        stops.append(stop)
    names = [f"stop_{k + 1}" for k in range(legs)]
    return {"robot": str(SCENARIOS / "robots/nomad_super_scout.yaml"), **floor.keys, "clearance_m": 0.05,
            "stations": {"start": start, **dict(zip(names, stops))}, "start": {"station": "start"},
            "legs": [{"to": name, "payload_kg": payload_kg} for name in names],
            "objective": {"minimize": "energy"}}


def missions(folder, legs, seed):
    draw = random.Random(seed)
    return [(floor.name, payload_kg, headings, mission_on(floor, draw, payload_kg, headings, legs))
            for floor in (hall(folder, draw), warehouse(), depot())
            for k in range(MISSIONS)
            for payload_kg, headings in [(PAYLOADS_KG[k % 3], k % 2 == 1)]]


def plan(program, folder, name, mission):
    file, out = folder / "mission.json", folder / "out"
    shutil.rmtree(out, ignore_errors=True)  # no answer of another mission
    file.write_text(json.dumps({"schema": "joulepath/mission/1", **mission}))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([program, "plan", file, "--out", out, "--force", "--solver", "fast", "--without", "baselines,path_bound", "-q"],
                   check=False, capture_output=True)
    spent_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    answer = json.loads((out / "plan.json").read_text())
    (folder / f"{name}.json").write_text(json.dumps(answer))
    return answer["energy_J"], spent_s


def quantile(values, q):
    return sorted(values)[round(q * (len(values) - 1))]


def main():
    folder, old, new, note = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:5]
    legs, seed = map(int, sys.argv[5:])
    folder.mkdir(parents=True, exist_ok=True)
    rows, spent_s = {}, {}
    for k, (floor, payload_kg, headings, mission) in enumerate(missions(folder, legs, seed)):
        old_J, old_s = plan(old, folder, f"{k}_old", mission)
        new_J, new_s = plan(new, folder, f"{k}_new", mission)
        rows.setdefault(floor, []).append(100 * (new_J / old_J - 1))
        spent_s.setdefault(floor, []).append((old_s, new_s))
        print(k, floor, payload_kg, headings, f"{old_J:.2f} {new_J:.2f} J {rows[floor][-1]:+.2f} % {old_s:.2f} {new_s:.2f} s",
              file=sys.stderr)
    print(f"# Plans of two programs\n\n{note}\n")
    print(f"Missions of {legs} legs of 2 to 14 m, payloads of 0, 6 and 12 kg; every second one names the headings at its "
          "stops. Time is free, solver `fast`, no bound over all paths. User CPU of the whole command.\n")
    print("| floor | missions | change of the energy, mean | best | worst | dearer by more than 0.5 % | CPU before | CPU after |")
    print("|---|---|---|---|---|---|---|---|")
    everything = [value for values in rows.values() for value in values]
    for floor, values in [*rows.items(), ("all", everything)]:
        seconds = [s for name, pairs in spent_s.items() if floor in (name, "all") for s in pairs]
        print(f"| {floor} | {len(values)} | {sum(values) / len(values):+.2f} % | {min(values):+.2f} % | {max(values):+.2f} % | "
              f"{sum(value > 0.5 for value in values)} | {sum(s[0] for s in seconds):.1f} s | {sum(s[1] for s in seconds):.1f} s |")


if __name__ == "__main__":
    main()
