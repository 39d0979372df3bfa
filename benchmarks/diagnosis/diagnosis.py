"""`./dev bench diagnosis`: the labelled practice sets, speed and memory of `joulepath diagnose`.

usage: diagnosis.py [FOLDER OF PRACTICE SETS]
Writes benchmarks/results/diagnosis.md. The practice sets (dataset.yaml and truth.yaml each) are those of
tests/data/practice, or of the folder. Fails if a set does not get the names of its label. Needs python3 (standard
library only).
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "blind" / "harness"))
import workspace  # noqa: E402

import sets  # noqa: E402

PRACTICE = workspace.ROOT / "tests" / "data" / "practice"
REPEATS = 3


def diagnose(dataset, out):
    """(answer, wall s, CPU s, peak MiB) of one run of the program."""
    command = [workspace.program("joulepath"), "diagnose", str(dataset), "--out", str(out), "--force", "--quiet"]
    start = time.monotonic()
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    wall_s = time.monotonic() - start
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit(f"{dataset}: joulepath diagnose failed")
    return json.loads((out / "diagnosis.json").read_text()), wall_s, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def truth_of(folder):
    """[(effect, {parameter: value})] of a label."""
    effects = re.findall(r"\{effect: (\w+)((?:, \w+: [^,}]+)*)\}", (folder / "truth.yaml").read_text())
    return [(name, dict(re.findall(r"(\w+): ([^,}]+)", rest))) for name, rest in effects]


def parameter_text(answer, truth):
    """Relative error of each true effect's first number that was found."""
    texts = []
    for name, parameters in truth:
        key, value = next(((k, float(v)) for k, v in parameters.items() if re.match(r"^-?[\d.e-]+$", v)), (None, None))
        for cause in answer["causes"]:
            said = cause["parameters"].get(key, {}).get("value") if cause["effect"] == name else None
            if said is not None:
                texts.append(f"{key} {100 * (said - value) / abs(value):+.1f} %")
    return "; ".join(texts) or "–"


def is_as_labeled(truth, answer):
    """A null set has no gap, a law outside the catalog is not explained, else exactly the label's effects are causes."""
    if not truth:
        return answer["verdict"] == "no_gap"
    if truth[0][0] == "foreign":
        return answer["verdict"] in ("unexplained", "partly_explained")
    named = [{cause["effect"], *cause["indistinguishable_from"]} for cause in answer["causes"]]
    return len(named) == len(truth) and all(any(name in names for names in named) for name, _ in truth)


def practice_row(folder, scratch):
    """(line of the table, whether the answer is as labeled)"""
    truth = truth_of(folder)
    answer, _, _, _ = diagnose(folder / "dataset.yaml", scratch / folder.name)
    good = is_as_labeled(truth, answer)
    energy = answer["gap"]["energy"]
    names = ", ".join(f"{c['effect']} ({c['probability']:.2f})" for c in answer["causes"]) or "–"
    low, high = energy["shrink_interval_95"]
    shrink = f"{energy['shrink_fraction']:.2f} [{low:.2f}, {high:.2f}]" if answer["causes"] else "–"
    return (f"| {folder.name} | {', '.join(name for name, _ in truth) or 'none'} | {answer['verdict']}{'' if good else ' (wrong)'} | {names} | {parameter_text(answer, truth)} "
            f"| {energy['before_percent']:.2f} → {energy['after_percent']:.2f} | {energy['noise_floor_percent']:.2f} | {shrink} "
            f"| {answer['ceiling']['shrink_fraction']:.2f} | {answer['decisions']['joules_lost_with_nominal_percent']:.2f} |"), good


def speed_row(name, dataset, samples, scratch):
    runs = [diagnose(dataset, scratch / "out") for _ in range(REPEATS)]
    wall_s, cpu_s = min(r[1] for r in runs), min(r[2] for r in runs)
    return f"| {name} | {samples} | {wall_s:.2f} | {cpu_s:.2f} | {max(r[3] for r in runs):.0f} | {runs[0][0]['verdict']} |"


def machine():
    cpu = next((line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "unknown")
    return f"{cpu}, {os.cpu_count()} cores, {os.uname().sysname} {os.uname().release}"


def main():
    practice = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else PRACTICE
    load = os.getloadavg()[0]
    lines = ["# Diagnosis: labelled sets, speed, memory", "",
             f"Command `./dev bench diagnosis`, commit {workspace.head()[:12]}, machine {machine()}; load average at the start {load:.1f}.", "",
             "## Labelled practice sets", ""]
    with tempfile.TemporaryDirectory() as temporary:
        scratch = pathlib.Path(temporary)
        folders = sorted(folder for folder in practice.glob("*/") if (folder / "truth.yaml").exists())
        if not folders:
            sys.exit(f"{practice}: no practice sets (folders with dataset.yaml and truth.yaml)")
        rows = [practice_row(folder, scratch) for folder in folders]
        wrong = [folder.name for folder, (_, good) in zip(folders, rows) if not good]
        source = "`tests/data/practice`" if practice == PRACTICE else "another folder"
        lines += [f"Sets of {source}: runs of a plant that shares no code with this project. Energy gap, shrink with its interval and ceiling on held-out runs; joules lost: additional energy of plans "
                  "with the uncorrected robot.", "",
                  "| set | truth | verdict | names (probability) | error of the first parameter | energy gap %, before → after | noise floor % | shrink [95 %] | ceiling | joules lost % |",
                  "|---|---|---|---|---|---|---|---|---|---|", *(row for row, _ in rows)]
        lines += ["", "## Speed and memory", "", f"The whole program (reading, diagnosis, decisions, report), best of {REPEATS}; memory is the largest of them.",
                  "Wall time says something only on an idle machine (load average near 0 at the start); CPU time is the program's own, spread over the cores.", "",
                  "| dataset | samples | wall s | CPU s | peak MiB | verdict |", "|---|---|---|---|---|---|"]
        for runs, samples in ((24, 1500), (50, 2000)):
            folder = scratch / f"set_{runs}"
            lines.append(speed_row(f"{runs} runs × {samples}", *sets.many_runs(folder, runs, samples), scratch))
        folder = scratch / "long"
        folder.mkdir()
        lines.append(speed_row("one log, an hour at 100 Hz", *sets.one_long_log(folder, 3600, 100), scratch))
    result = workspace.RESULTS / "diagnosis.md"
    result.write_text("\n".join(lines) + "\n")
    print(result.read_text())
    if wrong:
        sys.exit("not as labeled: " + ", ".join(wrong))


main()
