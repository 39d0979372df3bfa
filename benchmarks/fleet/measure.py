"""Measures the planner of fleets on seeded fleets with energies of a made-up floor: measure.py OUT HEAD [--short]."""

from __future__ import annotations

import pathlib
import resource
import sys
import time

import generator
import judge

from joulepath.fleet._bound import bound
from joulepath.fleet._model import solve
from joulepath.fleet._routes import dispatched
from joulepath.fleet._search import first_schedule, improve
from joulepath.fleet._simulate import simulate


def proofs(count: int, limit: float) -> list[str]:
    """Fleets of at most 4 robots, 12 missions and 2 chargers."""
    seconds, proven, broken = [], 0, 0
    for seed in range(100, 100 + count):
        problem, begin = generator.small(seed), time.process_time()
        status, found = solve(problem, workers=4, limit=limit, start=first_schedule(problem))
        proven += status in ("optimal", "infeasible")
        broken += found is not None and bool(judge.faults(problem, found))
        seconds.append(time.process_time() - begin)
    seconds.sort()
    return [f"| fleets of at most 4 x 12 x 2, proven within a deterministic time of {limit:g} | {proven} of {count} |",
            f"| schedules that break a rule, by the judge | {broken} |",
            f"| CPU time to proof or limit, median / 95 % | {seconds[len(seconds) // 2]:.1f} s / {seconds[int(0.95 * (len(seconds) - 1))]:.1f} s |"]


def judges(count: int) -> list[str]:
    """Brute force over permutations, and the queue."""
    equal = less = 0
    for seed in range(200, 200 + count):
        problem = generator.small(seed, robots=2, missions=5, chargers=1, speeds=1)
        found, brute = solve(problem, workers=1)[1], judge.least_cost(problem)
        cost = found.cost if found else float("inf")
        equal += cost == brute
        less += cost < brute
    cases = [(r, need) for r in (1, 2, 3, 4) for need in (20_000, 50_000)]
    met = sum(solve(generator.queue(*case), workers=1)[1].cost == generator.queue_cost(*case) for case in cases)  # type: ignore[union-attr]
    return [f"| fleets of at most 2 x 5 x 1, equal to brute force with one visit of each robot | {equal} of {count} |",
            f"| ... cheaper than it, by a second visit | {less} |", f"| queues at one charger, equal to the closed form | {met} of {len(cases)} |"]


def large(count: int, limit: float) -> list[str]:
    """Fleets of 20 robots, 200 missions and 3 chargers."""
    lines = ["", "| 20 x 200 x 3, seed | cost J | bound J | gap | dispatcher J | cheaper than it | CPU time | breaches where it binds | elsewhere | faults |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    for seed in range(count):
        problem, begin = generator.large(seed), time.process_time()
        start, field = first_schedule(problem), dispatched(problem)
        if start is None:
            lines.append(f"| {seed} | none | | | | | | | | |")
            continue
        found = improve(problem, start, seed=1, workers=1, limit=limit, tell=lambda _: None, stop=lambda: False)
        cpu_s, low = time.process_time() - begin, bound(problem)
        seen = simulate(problem, found, 1000, seed=1)
        dispatcher = (f"{field.cost / 10:.0f}", f"{100 * (1 - found.cost / field.cost):.1f} %") if field else ("none", "")
        lines.append(f"| {seed} | {found.cost / 10:.0f} | {low / 10:.0f} | {100 * (1 - low / found.cost):.1f} % | {dispatcher[0]} | {dispatcher[1]} "
                     f"| {cpu_s:.0f} s | {seen.breaches_binding} of {seen.binding} | {seen.breaches - seen.breaches_binding} of "
                     f"{seen.days - seen.binding} | {len(judge.faults(problem, found))} |")
    return lines


def main(out: str, head: str, short: bool) -> None:
    rows = (judges(6) + proofs(4, 1.0), large(1, 4.0)) if short else (judges(20) + proofs(200, 60.0), large(10, 60.0))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    text = [head, "", "Fleets of `benchmarks/fleet/generator.py`: energies of a made-up floor, not of the planner. Small fleets have two speeds of each leg.",
            "", "| figure | value |", "|---|---|", *rows[0], f"| greatest memory of the process | {memory:.0f} MiB |", *rows[1], ""]
    pathlib.Path(out).write_text("\n".join(text), encoding="utf-8")
    print("\n".join(text))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], "--short" in sys.argv[3:])
