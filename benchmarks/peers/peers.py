"""./dev bench peers: runs the sections, keeps each answer in build/peers, writes benchmarks/results/peers.md and its figure.

A section that is asked for by name runs again; the page is made of the newest answer of each. --quick runs few problems.

Design: docs/decisions/0803-judges.md
"""

import argparse
import importlib.metadata
import json
import sys
import time
import traceback

import baselines
import common
import designs
import diagnosis
import driving
import economy
import figure
import floors
import following
import speed

SECTIONS = {
    "casadi": ("CasADi + Ipopt: the same program as a script", speed.casadi),
    "toppra": ("toppra: least time and fixed duration", speed.toppra),
    "ruckig": ("Ruckig: jerk-limited straight lines", speed.ruckig),
    "baselines": ("Classic profiles", baselines.run),
    "estimators": ("What fleet managers estimate", economy.estimators),
    "costs": ("What other planners minimize", economy.costs),
    "driving": ("Driven by an independent simulator", driving.run),
    "walls": ("Missions between walls, driven", floors.run),
    "following": ("The profile follower, driven", following.run),
    "designs": ("The ranking of designs, driven", designs.run),
    "diagnosis": ("The diagnosis against regressions", diagnosis.run),
}
PACKAGES = ("casadi", "toppra", "ruckig", "mujoco", "pysindy", "scipy", "numpy")


def version(name):
    try:
        return f"{name} {importlib.metadata.version(name)}"
    except importlib.metadata.PackageNotFoundError:
        return f"{name} absent"


def run_section(name, quick):
    """The section's answer; a missing package or a failure is said, and the others go on."""
    start = time.monotonic()
    try:
        answer = SECTIONS[name][1](lambda full, small: small if quick else full)
    except common.Absent as absent:
        answer = {"text": f"Skipped: {absent}.\n", "summary": {}}
    except Exception as error:
        traceback.print_exc()
        answer = {"text": f"Failed: {type(error).__name__}: {error}\n", "summary": {}, "failed": True}
    print(f"{name}: {time.monotonic() - start:.0f} s", file=sys.stderr)
    return answer


def page(note, answers):
    text = f"# Side by side with its peers\n\n{note} Packages: {', '.join(map(version, PACKAGES))}.\n\n"
    text += (
        "All profiles are judged by [check.py](../problems/check.py), which shares no code with the program, on problems of the "
        "[public set](../problems/README.md). CPU times are of one thread. A figure with brackets is a median and its "
        "range: of ratios over "
        "interleaved repeats, of other figures over the problems. Ratios above 1: the peer takes "
        "longer.\n\n"
    )
    text += "".join(f"- {answers[name]['short']}\n" for name in SECTIONS if "short" in answers.get(name, {}))
    text += "\n![Summary](peers.svg)\n"
    for name, (title, _) in SECTIONS.items():
        if name in answers:
            own = answers[name].get("note", note)
            text += f"\n## {title}\n\n" + (f"{own}\n\n" if own != note else "") + answers[name]["text"]
    return text


def main():
    parser = argparse.ArgumentParser(prog="benchmarks/peers/run")
    parser.add_argument("sections", nargs="*", help=" ".join(SECTIONS))
    parser.add_argument("--quick", action="store_true", help="few problems, to see that everything runs; page in build/peers")
    parser.add_argument("--note", default="")
    given = parser.parse_args()
    unknown = set(given.sections) - set(SECTIONS)
    if unknown:
        parser.error(f"no section {' '.join(unknown)}; there are {' '.join(SECTIONS)}")
    folder = common.ROOT / "build/peers"
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / ("quick.json" if given.quick else "sections.json")
    answers = json.loads(kept.read_text()) if given.sections and kept.exists() else {}
    for name in given.sections or SECTIONS:
        answers[name] = {**run_section(name, given.quick), "note": given.note}
        kept.write_text(json.dumps(answers))
    results = folder if given.quick else common.ROOT / "benchmarks/results"
    (results / "peers.md").write_text(page(given.note, answers))
    (results / "peers.svg").write_text(figure.svg({name: answers[name] for name in SECTIONS if name in answers}))
    classic = answers.get("baselines", {})
    if "bars" in classic:
        drawing = figure.classic_profiles(classic["bars"], baselines.MODEL_ERRORS_PERCENT)
        (results / "peers_classic_profiles.svg").write_text(drawing)
    print(results / "peers.md")
    return any(a.get("failed") for a in answers.values())


if __name__ == "__main__":
    sys.exit(main())
