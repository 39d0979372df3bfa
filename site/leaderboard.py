#!/usr/bin/env python3
"""Writes the leaderboard of the public problem set: every file of answers, judged by benchmarks/problems/check.py.

usage: leaderboard.py SOURCE_DIR BENCH_PROBLEMS OUT.md
Answers: those of this build on two grids, and benchmarks/problems/answers/*.json
"""
import importlib.util
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

NODES = (200, 50)

HEAD = """# Leaderboard of the public problem set

For authors of planners who want to compare: who answered how many of the [240
problems](../benchmarks/problems/index.md), how close the answers are to the best known value, and how far that
is from the proven bound. `check.py` judges every answer when this page is built.

| answers of | answered | valid | better than the best known | excess over the best known, median | most |
|---|---:|---:|---:|---:|---:|
"""
TAIL = """
To enter, add a file `benchmarks/problems/answers/NAME.json` ([format and rules](../benchmarks/problems/index.md)).
An answer counts where it is valid.

## The problems

The gap is between the best known value and the lower bound: what a better answer could gain at most.

| kind | problems | gap, median | gap, most |
|---|---:|---:|---:|
"""


def judge_of(folder):
    spec = importlib.util.spec_from_file_location("check", folder / "check.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def percent(value):
    return f"{max(value, 0):.4f} %"


def row(name, answers, data, judge):
    """A line of the leaderboard; only valid answers count for the excess."""
    problems = {problem["id"]: problem for problem in data["problems"]}
    unknown = sorted(set(answers) - set(problems))
    if unknown:
        raise SystemExit(f"leaderboard: {name} answers {unknown[0]}, which is no problem")
    verdicts, excesses = [], []
    for key, solution in answers.items():
        problem = problems[key]
        value, words = judge.verdict(problem, judge.evaluate(problem, data["robots"][problem["robot"]], solution))
        verdicts.append(words)
        if words in ("valid", "better"):
            excesses.append(100 * (value / problem["best"]["value"] - 1))
    valid, better = sum(word in ("valid", "better") for word in verdicts), verdicts.count("better")
    middle, most = (percent(statistics.median(excesses)), percent(max(excesses))) if excesses else ("-", "-")
    return f"| {name} | {len(answers)} | {valid} | {better} | {middle} | {most} |\n"


def kinds(data):
    gaps = {}
    for problem in data["problems"]:
        best = problem["best"]
        kind = problem["path"].get("kind") or problem.get("kind", "path")
        kind += ", jerk limited" if "jerk_m_s3" in problem["limits"] else ""
        gaps.setdefault(kind, []).append(100 * (best["value"] / best["lower_bound"] - 1))
    return "".join(f"| {kind.replace('_', ' ')} | {len(found)} | {percent(statistics.median(found))} | {percent(max(found))} |\n"
                   for kind, found in sorted(gaps.items()))


def answers_of(folder, program):
    """{name: answers} of this build and of the committed files."""
    answers = {}
    with tempfile.TemporaryDirectory() as scratch:
        for nodes in NODES:
            file = pathlib.Path(scratch) / "answers.json"
            subprocess.run([program, "solve", folder / "problems.json", file, str(nodes)], check=True, stdout=subprocess.DEVNULL)
            answers[f"joulepath, {nodes} nodes"] = json.loads(file.read_text())
    return answers | {file.stem: json.loads(file.read_text()) for file in sorted((folder / "answers").glob("*.json"))}


def main():
    folder, program, out = pathlib.Path(sys.argv[1]) / "benchmarks/problems", sys.argv[2], pathlib.Path(sys.argv[3])
    data, judge = json.loads((folder / "problems.json").read_text()), judge_of(folder)
    rows = [row(name, answers, data, judge) for name, answers in answers_of(folder, program).items()]
    out.write_text(HEAD + "".join(rows) + TAIL + kinds(data))
    print(f"leaderboard: {len(rows)} files of answers")


if __name__ == "__main__":
    main()
