"""``python -m joulepath fleet FLEET.yaml --out DIR``."""

from __future__ import annotations

import argparse
import json
import signal
import sys
from pathlib import Path as FilePath

from .._errors import ConfigError, refused
from . import FleetPlan, plan, study

DONE, NO_SCHEDULE, BAD_INPUT = 0, 1, 2


def main(words: list[str]) -> int:
    """Runs the command; its exit code is that of ``joulepath plan``: 0, 1 without a schedule, 2 for bad input."""
    line = _parser().parse_args(words)
    stopped: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: stopped.append(number))
    try:
        if line.places or line.battery_scales:
            return _study(line)
        found = plan(line.fleet, seed=line.seed, workers=line.workers, limit=line.limit, cache=not line.no_cache,
                     tell=None if line.quiet else lambda text: print("  " + text, file=sys.stderr), stop=lambda: bool(stopped))
        executions = found.simulate(line.simulate, seed=line.seed) if line.simulate else []
        if line.out:
            found.save(line.out, force=line.force)
    except (ConfigError, ImportError) as error:
        print(f"joulepath: {error}", file=sys.stderr)
        return BAD_INPUT
    if line.json:
        print(json.dumps(found.json, indent=2))
    elif not line.quiet:
        print("\n".join(_answer(found)))
        if line.out:
            print(f"results in {line.out}: fleet.json, report.html" + (", missions/" if found.schedule else ""))
    if executions and not line.json and not line.quiet:
        from ._simulate import told

        print(told(executions))
    return DONE if found.schedule else NO_SCHEDULE


def _answer(found: FleetPlan) -> list[str]:
    """The cost and what each robot does, or the reason why there is no schedule."""
    content = found.json
    if not found.schedule:
        return [f"infeasible: {content['reason']['says']}; what works: " + ("; ".join(h["says"] for h in found.help) or "nothing that was tried")]
    lines = [f"{found.status}: {found.cost_J:.1f} J, bound {found.bound_J:.1f} J, gap {found.gap_percent:.2f} %"]
    for robot in content["robots"]:
        counts = {what: sum(item["does"] == what for item in robot["timeline"]) for what in ("mission", "charge")}
        told = [f"{count} {what}{'' if count == 1 else 's'}" for what, count in counts.items()]
        lines.append(f"{robot['name']}: " + (f"{', '.join(told)}, until {robot['timeline'][-1]['to_s']} s" if any(counts.values()) else "stays"))
    late = [mission["late_s"] for mission in content["missions"] if mission["late_s"]]
    return lines + ([f"{len(late)} of {len(content['missions'])} missions late, {sum(late)} s in all"] if late else [])


def _study(line: argparse.Namespace) -> int:
    if line.simulate:
        raise refused("simulate", str(line.simulate), "a plan, without --places and --battery-scales")
    if line.out and not line.force and (FilePath(line.out) / "study.json").exists():  # before the fleets are planned
        raise refused("directory", f"{FilePath(line.out) / 'study.json'}, a file that exists", "a new name", "--force overwrites it")
    found = study(line.fleet, places=_numbers(line.places or "1,2,3"), battery_scales=_numbers(line.battery_scales or "1"),  # type: ignore[arg-type]
                  seed=line.seed, workers=line.workers, limit=line.limit, cache=not line.no_cache,
                  tell=None if line.quiet else lambda text: print("  " + text, file=sys.stderr))
    if line.out:
        found.save(line.out, force=line.force)
    if line.json:
        print(json.dumps(list(found.rows), indent=2))
    elif not line.quiet:
        from ._study import sentence

        print(sentence(found))
    return DONE if any(row["cost_J"] is not None for row in found.rows) else NO_SCHEDULE


def _numbers(text: str) -> list[str | int]:
    """Numbers between commas; ``study`` checks them."""
    return [int(word) if word.isdigit() else word for word in text.split(",")]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="joulepath fleet", allow_abbrev=False, description="Who drives what, when and where to charge.")
    parser.add_argument("fleet", metavar="FLEET", help="fleet file")
    parser.add_argument("--out", help="directory for fleet.json, report.html and missions/; without it nothing is written")
    parser.add_argument("--force", action="store_true", help="overwrite files of an earlier plan")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=8, help="interleaved searches of CP-SAT")
    parser.add_argument("--limit", type=float, default=60.0, help="deterministic time of the search, about CPU seconds")
    parser.add_argument("--simulate", type=int, default=0, metavar="N",
                        help="drive the schedule N times with energies of the model's uncertainty")
    parser.add_argument("--places", metavar="N,N,...", help="a study: places at each charger, 0 for none")
    parser.add_argument("--battery-scales", metavar="X,X,...", help="a study: batteries relative to those of the robot files")
    parser.add_argument("--no-cache", action="store_true", help="no cache of legs on disk")
    parser.add_argument("--json", action="store_true", help="fleet.json on standard output")
    parser.add_argument("-q", "--quiet", action="store_true")
    return parser
