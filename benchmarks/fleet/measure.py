"""Measures the planner of fleets on seeded fleets with energies of a made-up floor: measure.py OUT HEAD [--short].

Exit code 1 where a schedule breaks a rule, or brute force or the queue disagrees.
"""

from __future__ import annotations

import math
import pathlib
import resource
import sys
import time
from collections.abc import Callable
from typing import NamedTuple

import generator
import judge

from joulepath.fleet._bound import bound
from joulepath.fleet._solve import solve
from joulepath.fleet._problem import Problem
from joulepath.fleet._routes import dispatched
from joulepath.fleet._search import first_schedule, improve, search
from joulepath.fleet._simulate import simulate

NONE = float("inf")
wrong: list[str] = []  #: what a judge refused


class Effort(NamedTuple):
    tight: int  #: fleets of each family
    small: int
    judged: int
    proof_limit: float  #: deterministic time
    large: int
    large_limit: float


FULL, SHORT = Effort(40, 40, 20, 60.0, 3, 60.0), Effort(4, 2, 3, 10.0, 1, 4.0)


def share(count: int, of: int) -> str:
    """A count with the 95 % interval of its share [Wilson1927]."""
    z, p = 1.96, count / of
    middle, half = p + z * z / (2 * of), z * math.sqrt(p * (1 - p) / of + z * z / (4 * of * of))
    low, high = (middle - half) / (1 + z * z / of), (middle + half) / (1 + z * z / of)
    return f"{count} of {of} ({100 * max(0.0, low):.0f} to {100 * min(1.0, high):.0f} %)"


def say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def proofs(name: str, fleet: Callable[[int], Problem], seeds: range, limit: float) -> str:
    """One row: fleets that are proven, CPU time, the worst gap of the others, and schedules that break a rule."""
    seconds, gaps, broken = [], [], 0
    for seed in seeds:
        problem, begin = fleet(seed), time.process_time()
        status, found = search(problem, workers=1, limit=limit)
        seconds.append(time.process_time() - begin)
        proven = status in ("optimal", "infeasible")
        gaps += [] if proven else [1.0 if found is None else 1 - found.bound / found.cost]
        faults = judge.faults(problem, found) if found else []
        wrong.extend(f"{name} {seed}: {fault}" for fault in faults)
        broken += bool(faults)
        say(f"{name} {seed}: {status}, {seconds[-1]:.1f} s")
    seconds.sort()
    return f"| {name} | {share(len(seeds) - len(gaps), len(seeds))} | {seconds[len(seconds) // 2]:.1f} s " \
           f"| {seconds[math.ceil(0.95 * len(seconds)) - 1]:.1f} s | {100 * max(gaps, default=0.0):.1f} % | {broken} |"


def judges(count: int) -> list[str]:
    """Brute force over permutations, and the queue."""
    equal = twice = 0
    for seed in range(200, 200 + count):
        problem = generator.tight(seed, robots=2 + seed % 2, missions=5 + seed % 3, chargers=1)
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
    return [f"| fleets of at most 3 x 7 x 1, three speeds: as cheap as brute force, with one visit of each robot | {share(equal, count)} |",
            f"| ... cheaper, since a robot charges twice | {twice} |",
            f"| queues at one charger, equal to the closed form | {met} of {len(cases)} |"]


def large(count: int, limit: float) -> list[str]:
    """Fleets of 20 robots, 200 missions and 3 chargers."""
    lines = ["| 20 x 200 x 3, seed | cost J | bound J | gap | dispatcher J | cheaper than it | CPU time | breaches where it binds | elsewhere | faults |",
             "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for seed in range(count):
        problem, begin = generator.large(seed), time.process_time()
        start, field = first_schedule(problem), dispatched(problem)
        if start is None:
            lines.append(f"| {seed} | none | | | | | | | | |")
            continue
        found = improve(problem, start, seed=1, workers=1, limit=limit, tell=lambda _: None, stop=lambda: False)
        cpu_s, low = time.process_time() - begin, bound(problem)
        seen = simulate(problem, found, 1000, seed=1)
        wrong.extend(f"large {seed}: {fault}" for fault in judge.faults(problem, found))
        dispatcher = (f"{field.cost / 10:.0f}", f"{100 * (1 - found.cost / field.cost):.1f} %") if field else ("none", "")
        lines.append(f"| {seed} | {found.cost / 10:.0f} | {low / 10:.0f} | {100 * (1 - low / found.cost):.1f} % | {dispatcher[0]} | {dispatcher[1]} "
                     f"| {cpu_s:.0f} s | {seen.breaches_binding} of {seen.binding} | {seen.breaches - seen.breaches_binding} of "
                     f"{seen.days - seen.binding} | {len(judge.faults(problem, found))} |")
        say(lines[-1])
    return lines


def main(out: str, head: str, short: bool) -> None:
    effort = SHORT if short else FULL
    rows = [proofs("`tight`, 4 x 12 x 2: three speeds, narrow windows", generator.tight, range(100, 100 + effort.tight), effort.proof_limit),
            proofs("`small`, at most 4 x 12 x 2: two speeds", generator.small, range(100, 100 + effort.small), effort.proof_limit)]
    judged, far = judges(effort.judged), large(effort.large, effort.large_limit)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    text = ["# Fleets", "", head, "", "Energies are of the made-up floor of `benchmarks/fleet/generator.py`. CPU times of one process, one worker;",
            f"limits in CP-SAT's deterministic time ({effort.proof_limit:g} a proof, {effort.large_limit:g} a large fleet).", "",
            "| fleets | proven (95 % interval) | CPU time, median | 95 % | worst gap | break a rule |", "|---|---:|---:|---:|---:|---:|", *rows, "",
            "| figure | value |", "|---|---:|", *judged, f"| greatest memory of the process | {memory:.0f} MiB |", "", *far, ""]
    pathlib.Path(out).write_text("\n".join(text), encoding="utf-8")
    print("\n".join(text + wrong))
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], "--short" in sys.argv[3:])
