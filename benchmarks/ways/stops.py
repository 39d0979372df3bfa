#!/usr/bin/env python3
"""Missions with free headings at their stops against a search over those headings, as Markdown.

usage: stops.py FOLDER PROGRAM COUNT SEED NOTE
The judge plans the same mission with headings given at every stop: those of the plan, eight about each stop in turn, then a
pattern search one stop at a time. A given heading is the harder problem: it should never be cheaper.
"""
import csv
import math
import pathlib
import random
import sys

from orders import plan
from programs import PAYLOADS_KG, depot, hall, mission_on, quantile, warehouse

LEGS = 3
FIRST_STEP_RAD, LAST_STEP_RAD, SHORTER = 0.3, 0.02, 2.5
AIM_PERCENT = 0.1


def arrivals_rad(folder, legs):
    """The headings with which the plan in `folder` arrives."""
    with open(folder / "out/trajectory.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    ends_s = [leg["start_s"] + leg["duration_s"] for leg in legs]
    return [float(min(rows, key=lambda row: abs(float(row["time_s"]) - end_s))["heading_rad"]) for end_s in ends_s]


def least_J(energy_J, headings, best_J):
    """The least energy that the search over headings finds, from `best_J` of these, and how many plans it took."""
    planned = 0

    def better(stop, heading_rad):
        nonlocal best_J, headings, planned
        trial = [*headings[:stop], heading_rad, *headings[stop + 1:]]
        energy, planned = energy_J(trial), planned + 1
        if energy >= best_J * (1 - 1e-6):
            return False
        best_J, headings = energy, trial
        return True

    for stop in range(len(headings)):
        for eighth in range(8):
            better(stop, 0.1 + (eighth - 4) * math.pi / 4)
        step_rad = FIRST_STEP_RAD
        while step_rad > LAST_STEP_RAD:
            if not any(better(stop, headings[stop] + sign * step_rad) for sign in (1, -1)):
                step_rad /= SHORTER
    return best_J, planned


def case_on(program, folder, floor, draw, payload_kg):
    """What the free plan costs more than its own headings given, and than the best found (percent); plans of the search."""
    mission = mission_on(floor, draw, payload_kg, False, LEGS)
    free, _ = plan(program, folder, mission)
    headings = arrivals_rad(folder, free["legs"])

    def energy_J(trial):
        stations = dict(mission["stations"])
        for leg, heading_rad in zip(mission["legs"], trial):
            stations[leg["to"]] = {**stations[leg["to"]], "heading_rad": heading_rad}
        return plan(program, folder, {**mission, "stations": stations})[0].get("energy_J") or math.inf

    own_J = energy_J(headings)
    best_J, planned = least_J(energy_J, headings, own_J)
    above = [100 * (free["energy_J"] / other_J - 1) for other_J in (own_J, min(best_J, free["energy_J"]))]
    print(floor.name, payload_kg, f"own {above[0]:+.3f} % best {above[1]:+.3f} %", planned, file=sys.stderr, flush=True)
    return above


def main():
    folder, program, count, seed, note = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], *map(int, sys.argv[3:5]), sys.argv[5]
    folder.mkdir(parents=True, exist_ok=True)
    draw = random.Random(seed)
    floors = (hall(folder, draw), warehouse(), depot())
    rows = {}
    for k in range(count):
        floor = floors[k % len(floors)]
        rows.setdefault(floor.name, []).append(case_on(program, folder, floor, draw, PAYLOADS_KG[k // len(floors) % 3]))
    print(f"# Free headings at stops against a search over them\n\n{note}\n")
    print(f"Missions of {LEGS} legs of 2 to 14 m, headings free at all stops, payloads of 0, 6 and 12 kg, time free, solver `fast`. "
          "The judge is the same program with headings given: the plan's own, then the best of a search (eight about each stop "
          f"and a pattern search down to {LAST_STEP_RAD} rad). Aim: a given heading saves at most {AIM_PERCENT} %.\n")
    print("| floor | missions | own headings given save, median | most | searched headings save, median | most | within the aim |")
    print("|---|---|---|---|---|---|---|")
    for name, cases in [*rows.items(), ("all", [case for cases in rows.values() for case in cases])]:
        own, best = zip(*cases)
        print(f"| {name} | {len(cases)} | {quantile(own, 0.5):.3f} % | {max(own):.3f} % | {quantile(best, 0.5):.3f} % | "
              f"{max(best):.3f} % | {sum(value <= AIM_PERCENT for value in best)} of {len(cases)} |")


if __name__ == "__main__":
    main()
