#!/usr/bin/env python3
"""Writes the leaderboard of the public problem set: every file of answers, judged by benchmarks/problems/check.py.

usage: leaderboard.py SOURCE_DIR OUT.md    Answers: benchmarks/problems/solutions.json, benchmarks/problems/answers/*.json
"""
import importlib.util
import json
import pathlib
import statistics
import sys

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


def main():
    folder, out = pathlib.Path(sys.argv[1]) / "benchmarks/problems", pathlib.Path(sys.argv[2])
    data, judge = json.loads((folder / "problems.json").read_text()), judge_of(folder)
    files = {"joulepath (examples)": folder / "solutions.json", **{file.stem: file for file in sorted((folder / "answers").glob("*.json"))}}
    rows = [row(name, json.loads(file.read_text()), data, judge) for name, file in files.items()]
    out.write_text(HEAD + "".join(rows) + TAIL + kinds(data))
    print(f"leaderboard: {len(rows)} files of answers")


if __name__ == "__main__":
    main()
