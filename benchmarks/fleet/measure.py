"""Measures the planner of fleets on seeded fleets with energies of a made-up floor.

measure.py OUT HEAD [--short] [--minutes CPU] [--limit S] [--evrptw FOLDER]. With a budget of CPU minutes each part ends when its share is used up
and states how many fleets it had. Exit code 1 where a schedule breaks a rule, or brute force, the queue or the order of visits disagrees.
"""

from __future__ import annotations

import argparse
import json
import math
import pathlib
import random
import resource
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import evrptw
import generator
import judge

import joulepath as jp
from joulepath import fleet
from joulepath.fleet._problem import Problem
from joulepath.fleet._routes import Routing
from joulepath.fleet._search import first_schedule, search
from joulepath.fleet._simulate import simulate
from joulepath.fleet._solve import solve

ROOT = pathlib.Path(__file__).resolve().parents[2]
NONE = float("inf")
wrong: list[str] = []  #: what a judge refused


class Effort(NamedTuple):
    tight: int  #: fleets of each family
    small: int
    judged: int
    proof_limit: float  #: deterministic time
    large: int
    large_limit: float
    visits: int
    instances: int


FULL, SHORT = Effort(100, 100, 20, 60.0, 10, 60.0, 5, 24), Effort(4, 2, 3, 10.0, 1, 4.0, 1, 4)
SHARES = {"large": 0.2, "tight": 0.25, "small": 0.25, "judged": 0.15, "visits": 0.1, "instances": 0.05}  #: of the budget


class Budget:
    """Seeds of a part, until its share of the CPU time is used; what an earlier part leaves, a later one has."""

    def __init__(self, minutes: float) -> None:
        self.left_s = 60 * minutes
        self.rest = sum(SHARES.values())

    def of(self, part: str, items: Iterable[object]) -> Iterator[object]:
        share_s, begin = self.left_s * SHARES[part] / self.rest, time.process_time()
        self.rest -= SHARES[part]
        for item in items:
            if time.process_time() - begin >= share_s:
                break
            yield item
        self.left_s -= time.process_time() - begin


def share(count: int, of: int) -> str:
    """A count with the 95 % interval of its share [Wilson1927]."""
    z, p = 1.96, count / of
    middle, half = p + z * z / (2 * of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of))
    low, high = (middle - half) / (1 + z * z / of), (middle + half) / (1 + z * z / of)
    return f"{count} of {of} ({100 * max(0.0, low):.0f} to {100 * min(1.0, high):.0f} %)"


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def proofs(name: str, made: Callable[[int], Problem], seeds: Iterable[int], limit: float) -> str:
    """One row: fleets that are proven, CPU time, the worst gap of the others, and schedules that break a rule."""
    seconds, gaps, broken = [], [], 0
    for seed in seeds:
        problem, begin = made(seed), time.process_time()
        status, found = search(problem, workers=1, limit=limit)
        seconds.append(time.process_time() - begin)
        proven = status in ("optimal", "infeasible")
        gaps += [] if proven else [1.0 if found is None else 1 - found.bound / found.cost]
        faults = judge.faults(problem, found) if found else []
        wrong.extend(f"{name} {seed}: {fault}" for fault in faults)
        broken += bool(faults)
        say(f"{name} {seed}: {status}, {seconds[-1]:.1f} s")
    if not seconds:
        return f"| {name} | none | | | | |"
    seconds.sort()
    return f"| {name} | {share(len(seconds) - len(gaps), len(seconds))} | {seconds[len(seconds) // 2]:.1f} s " \
           f"| {seconds[math.ceil(0.95 * len(seconds)) - 1]:.1f} s | {100 * max(gaps, default=0.0):.1f} % | {broken} |"


def judges(seeds: Iterable[int]) -> list[str]:
    """Brute force over permutations, and the queue."""
    equal = twice = count = 0
    for seed in seeds:
        count += 1
        problem = generator.tight(seed, robots=3, missions=5 + seed % 3, chargers=1)
        found = solve(problem, workers=1, limit=60.0, start=first_schedule(problem))[1]
        cost = found.cost if found else NONE
        brute = judge.least_cost(problem, cost + 1)
        visits = max((sum(step.visit is not None for step in route) for route in found.routes), default=0) if found else 0
        equal += brute == cost
        twice += brute != cost and brute > cost and visits > 1
        say(f"judge {seed}: {cost}, brute force {brute}")
    if equal + twice < count:
        wrong.append(f"brute force disagrees with {count - equal - twice} of {count} fleets")
    cases = [(r, need) for r in (1, 2, 3, 4) for need in (20_000, 50_000)]
    met = sum(solve(generator.queue(*case), workers=1)[1].cost == generator.queue_cost(*case) for case in cases)  # type: ignore[union-attr]
    if met < len(cases):
        wrong.append(f"{len(cases) - met} queues differ from the closed form")
    return [f"| fleets of 3 x (5 to 7) x 1, three speeds: as cheap as brute force, with one visit of each robot | {share(equal, count) if count else 'none'} |",
            f"| ... cheaper, since a robot charges twice | {twice} |",
            f"| queues at one charger, equal to the closed form | {met} of {len(cases)} |"]


def large(seeds: Iterable[int], limit: float) -> list[str]:
    """Fleets of 20 robots, 200 missions and 3 chargers."""
    lines = ["| 20 x 200 x 3, seed | cost J | bound J | gap | dispatcher J | cheaper than it | CPU time | breaches where it binds | elsewhere | faults |",
             "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for seed in seeds:
        problem, begin = generator.large(seed), time.process_time()
        field, found = Routing(problem).dispatch(), search(problem, workers=1, limit=limit)[1]
        if found is None:
            lines.append(f"| {seed} | none | | | | | | | | |")
            continue
        cpu_s, seen = time.process_time() - begin, simulate(problem, found, 1000, seed=1)
        wrong.extend(f"large {seed}: {fault}" for fault in judge.faults(problem, found))
        dispatcher = (f"{field.cost / 10:.0f}", f"{100 * (1 - found.cost / field.cost):.1f} %") if field else ("none", "")
        lines.append(f"| {seed} | {found.cost / 10:.0f} | {found.bound / 10:.0f} | {100 * (1 - found.bound / found.cost):.1f} % "
                     f"| {dispatcher[0]} | {dispatcher[1]} | {cpu_s:.0f} s | {breaches(seen.breaches_binding, seen.binding)} "
                     f"| {breaches(seen.breaches - seen.breaches_binding, seen.days - seen.binding)} | {len(judge.faults(problem, found))} |")
        say(lines[-1])
    return lines


def breaches(count: int, days: int) -> str:
    return share(count, days) if days else "0 of 0"


def visits(seeds: Iterable[int]) -> str:
    """One robot without a charger on the warehouse: its order is that of a mission with `visit:`, which the core proves."""
    floor = {"map": str(ROOT / "scenarios/maps/warehouse.yaml"), "clearance_m": 0.05}
    robot = str(ROOT / "scenarios/robots/nomad_super_scout.yaml")
    places = {"dock": (2.0, -23.5, 0.0), "charger": (4.0, -23.5, 0.0), "shelf_3": (-6.9, -11.0, 1.5708), "shelf_7": (12.45, -16.25, 1.5708),
              "shelf_9": (8.5, 2.0, 3.1416)}
    stations = {name: {"x_m": x, "y_m": y, "heading_rad": w} for name, (x, y, w) in places.items()}
    count = equal = 0
    for seed in seeds:
        start, *stops = random.Random(f"visits {seed}").sample(list(places), 4)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "fleet.json"
            file.write_text(json.dumps({**floor, "stations": stations, "robots": [{"name": "one", "robot": robot, "start": start}],
                                        "missions": [{"name": stop, "stops": [{"station": stop}]} for stop in stops]}))
            found = fleet.plan(file, workers=1)
        assert found.schedule is not None
        order = [found.problem.missions[step.mission].name for step in found.schedule.routes[0]]
        today = jp.plan({**floor, "stations": stations, "robot": robot, "start": {"station": start}, "visit": [{"go": stop} for stop in stops]},
                        solver="fast", baselines=False)
        count, equal = count + 1, equal + (order == [leg.to for leg in today.legs])
        say(f"visits {seed}: {order}, {[leg.to for leg in today.legs]}")
    if equal < count:
        wrong.append(f"{count - equal} orders of one robot differ from the core's")
    return f"| one robot, no charger: the order of visits that the core plans | {share(equal, count) if count else 'none'} |"


def published(files: Iterable[pathlib.Path], limit: float) -> list[str]:
    """Public instances: equal, cheaper by partial charges, dearer by the one station between two customers."""
    rows = ["| E-VRPTW [Schneider2014] | vehicles | published | here | bound | CPU time | |", "|---|---:|---:|---:|---:|---:|---|"]
    for file in files:
        vehicles, value = evrptw.PUBLISHED[file.stem]
        problem, begin = evrptw.problem(file, vehicles), time.process_time()
        status, found = search(problem, workers=1, limit=limit)
        if found is None:
            rows.append(f"| {file.stem} | {vehicles} | {value:.2f} | {status} | | {time.process_time() - begin:.1f} s | |")
            continue
        wrong.extend(f"{file.stem}: {fault}" for fault in judge.faults(problem, found))
        cost, low = found.cost / evrptw.LENGTHS, found.bound / evrptw.LENGTHS
        word = "equal" if abs(cost - value) < 0.015 else "less: charges are partial" if cost < value else "more"
        word += ", overloaded" if evrptw.overloaded(file, found) else ""
        rows.append(f"| {file.stem} | {vehicles} | {value:.2f} | {cost:.2f} | {low:.2f} | {time.process_time() - begin:.1f} s | {word} |")
        say(rows[-1])
    return [*rows, ""]


def main() -> None:
    line = arguments()
    effort, budget = SHORT if line.short else FULL, Budget(line.minutes)
    if line.limit:
        effort = effort._replace(proof_limit=line.limit, large_limit=line.limit)
    far = large(budget.of("large", range(effort.large)), effort.large_limit)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    rows = [proofs("`tight`, 4 x 12 x 2: three speeds, narrow windows", generator.tight, budget.of("tight", range(100, 100 + effort.tight)),
                   effort.proof_limit),
            proofs("`small`, at most 4 x 12 x 2: two speeds", generator.small, budget.of("small", range(100, 100 + effort.small)),
                   effort.proof_limit)]
    judged = judges(budget.of("judged", range(201, 201 + effort.judged)))
    judged.append(visits(budget.of("visits", range(effort.visits))))
    files = evrptw.instances(line.evrptw)[:effort.instances] if line.evrptw else []
    known = published(budget.of("instances", files), effort.proof_limit) if files else []
    text = ["# Fleets", "", line.head, "", "Energies are of the made-up floor of `benchmarks/fleet/generator.py`. CPU times of one process, one worker;",
            f"limits in CP-SAT's deterministic time ({effort.proof_limit:g} a proof, {effort.large_limit:g} a large fleet)."
            + (f" A budget of {line.minutes:g} CPU minutes decides how many fleets each part has." if line.minutes < NONE else ""), "",
            "| fleets | proven (95 % interval) | CPU time, median | 95 % | worst gap | break a rule |", "|---|---:|---:|---:|---:|---:|", *rows, "",
            "| figure | value |", "|---|---:|", *judged, f"| greatest memory of the process after the large fleets | {memory:.0f} MiB |", "",
            *far, "", *known]
    pathlib.Path(line.out).write_text("\n".join(text), encoding="utf-8")
    print("\n".join(text + wrong))
    sys.exit(bool(wrong))


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    parser.add_argument("out")
    parser.add_argument("head")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--minutes", type=float, default=NONE)
    parser.add_argument("--limit", type=float, default=0.0, help="deterministic time of a search, instead of the form's")
    parser.add_argument("--evrptw", help="folder with the texts of the instances, which are not in this repository")
    return parser.parse_args()


if __name__ == "__main__":
    main()
