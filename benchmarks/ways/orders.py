#!/usr/bin/env python3
"""Missions of stops in any order against all orders of the same stops as legs, as Markdown.

usage: orders.py FOLDER PROGRAM COUNT SEED NOTE
The judge plans every order as `legs:` with the same program and takes the cheapest.
"""
import itertools
import json
import math
import pathlib
import random
import resource
import subprocess
import sys

from programs import SCENARIOS, depot, hall, quantile, warehouse

REACH_M = 9  # from the start
ENOUGH_PERCENT = 0.1
KINDS = ((3, False), (3, True), (4, False), (4, True))  # stops, whether stations name headings


def stops_on(floor, draw, count, headings):
    def station(heading):
        x_m, y_m = floor.place(draw)
        turn = round(draw.uniform(-math.pi, math.pi), 3)
        return {"x_m": x_m, "y_m": y_m, **({"heading_rad": turn} if heading else {})}

    start, stops = station(True), []
    while len(stops) < count:
        stop = station(headings)
        if 1 < math.hypot(stop["x_m"] - start["x_m"], stop["y_m"] - start["y_m"]) < REACH_M:
            stops.append(stop)
    return start, stops


def plan(program, folder, mission):
    file, out = folder / "mission.json", folder / "out"
    file.write_text(json.dumps({"schema": "joulepath/mission/1", **mission}))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run([program, "plan", file, "--out", out, "--force", "--solver", "fast", "--without",
                    "baselines,path_bound", "-q"], check=False, capture_output=True)
    spent_s = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return json.loads((out / "plan.json").read_text()), spent_s


def case_on(program, folder, floor, draw, count, headings):
    """What the chosen order costs more than the cheapest (percent), planned orders, CPU (s) of it and of a plan."""
    start, stops = stops_on(floor, draw, count, headings)
    names = [f"stop_{k}" for k in range(count)]
    loads_kg = [draw.choice((0, 1, 3)) for _ in names]
    mission = {"robot": str(SCENARIOS / "robots/nomad_super_scout.yaml"), **floor.keys, "clearance_m": 0.05,
               "stations": {"start": start, **dict(zip(names, stops))}, "start": {"station": "start"},
               "objective": {"minimize": "energy"}}
    visits = [{"pick": name, "payload_kg": kg} if kg else {"go": name} for name, kg in zip(names, loads_kg)]
    chosen, spent_s = plan(program, folder, {**mission, "visit": visits})
    least_J, all_s = math.inf, []
    for order in itertools.permutations(range(count)):
        legs, load_kg = [], 0
        for k in order:
            legs.append({"to": names[k], "payload_kg": load_kg})
            load_kg += loads_kg[k]
        one, one_s = plan(program, folder, {**mission, "legs": legs})
        all_s.append(one_s)
        least_J = min(least_J, one["energy_J"] or math.inf)
    above = 100 * (chosen["energy_J"] / least_J - 1) if chosen["energy_J"] else math.inf
    print(floor.name, count, headings, f"{above:+.2f} %", chosen["visit"]["planned_orders"], f"{spent_s:.1f} s",
          file=sys.stderr)
    return above, chosen["visit"]["planned_orders"], spent_s, sum(all_s) / len(all_s)


def main():
    folder, program, count, seed, note = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:]
    folder.mkdir(parents=True, exist_ok=True)
    draw = random.Random(int(seed))
    floors = (hall(folder, draw), warehouse(), depot())
    rows = {}
    for k in range(int(count)):
        kind = KINDS[k % len(KINDS)]
        rows.setdefault(kind, []).append(case_on(program, folder, floors[k % len(floors)], draw, *kind))
    print(f"# Orders of stops against all orders\n\n{note}\n")
    print(f"Stops within {REACH_M} m of the start on a hall, Nav2's warehouse and its depot, loads of 0, 1 and 3 kg, time "
          "free, solver `fast`. The judge is the cheapest of all orders, each planned as `legs:`. User CPU of the whole "
          "command.\n")
    print(f"| stops | stations | missions | dearer than the judge by more than {ENOUGH_PERCENT} % | median | worst | "
          "orders planned, median | most | CPU against one order's, median |")
    print("|---|---|---|---|---|---|---|---|---|")
    for (stops, headings), cases in sorted(rows.items()):
        above, planned, spent_s, one_s = zip(*cases)
        print(f"| {stops} | {'with headings' if headings else 'without headings'} | {len(cases)} | "
              f"{sum(value > ENOUGH_PERCENT for value in above)} | {quantile(above, 0.5):+.2f} % | {max(above):+.2f} % | "
              f"{quantile(planned, 0.5)} | {max(planned)} | "
              f"{quantile([a / b for a, b in zip(spent_s, one_s)], 0.5):.1f} times |")


if __name__ == "__main__":
    main()
