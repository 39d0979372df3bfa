#!/usr/bin/env python3
"""Mutants: changes one operator or constant at a time and looks whether a test notices.

usage: ./dev mutate [--area model|nlp|profile|diagnosis] [--sites N] [--minutes M] [--site FILE:LINE] [--list]

Draws sites by a fixed seed, 75 in each of four areas, in an order in which every prefix is a fair sample. Each
mutant is compiled in build/mutants/tree (its object alone, then the relinked tests of its area) and tested: quick
tests first, then those of tests/slow_tests.txt. Verdicts are kept in build/mutants/verdicts.jsonl, so that a later
call goes on; the table is mutants.md in benchmarks/results/.
"""
import argparse
import hashlib
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import time

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
TREE = os.path.join(ROOT, "build/mutants/tree")
BUILD = os.path.join(TREE, "build/release")  # as deep as in the tree itself, so that ccache knows the objects
VERDICTS = os.path.join(ROOT, "build/mutants/verdicts.jsonl")
SEED, PER_AREA, TEST_LIMIT_S = 20261122, 75, 600
AREAS = {
    "model": (["model/"], ["test_model"]),
    "nlp": (["planner/nlp/"], ["test_nlp"]),
    "profile": (["planner/accounts/", "planner/profile/"], ["test_nlp", "test_energy", "test_mission"]),
    "diagnosis": (["diagnosis/"], ["test_estimation", "test_calibration", "test_diagnosis"]),
}
# (name, pattern, replacement); group 1 is what is replaced.
OPERATORS = [
    ("sign of a term", r"(?<=[\w)\]]) (\+) (?=[\w(-])", "-"),
    ("sign of a term", r"(?<=[\w)\]]) (-) (?=[\w(])", "+"),
    ("product", r"(?<=[\w)\]]) (\*) (?=[\w(])", "/"),
    ("quotient", r"(?<=[\w)\]]) (/) (?=[\w(])", "*"),
    ("sum", r" (\+=) ", "-="),
    ("dropped term", r" (\+=) ", "="),
    ("comparison", r"(?<=[\w)\]]) (<) (?=[\w(-])", "<="),
    ("comparison", r"(?<=[\w)\]]) (>) (?=[\w(-])", "<"),
    ("comparison", r"(?<=[\w)\]]) (<=) (?=[\w(-])", ">"),
    ("comparison", r"(?<=[\w)\]]) (>=) (?=[\w(-])", "<"),
    ("logic", r" (&&) ", "||"),
    ("logic", r" (\|\|) ", "&&"),
    ("extremum", r"std::(max)\(", "min"),
    ("extremum", r"std::(min)\(", "max"),
    ("absolute value", r"(std::abs)\(", ""),
    ("negation", r"(?<=[(=,] )(-)(?=[A-Za-z(])", ""),
    ("constant", r"(?<![\w.])(\d+\.\d+(?:e-?\d+)?|\d+e-?\d+)(?![\w.])", None),
]


def code_lines(text):
    """(number, line) of lines of code: no comment, string, directive, table of words or tolerance of a loop."""
    for number, line in enumerate(text.split("\n")):
        bare = re.sub(r'"(?:[^"\\]|\\.)*"', lambda m: '"' + "_" * (len(m.group()) - 2) + '"', line)
        bare = bare.split("//")[0]
        if bare.strip() and not bare.lstrip().startswith(("#", "*", "template", "static_assert")):
            yield number, bare


def other_constant(text):
    return repr(float(text) * 1.25) if float(text) != 0 else "1.0"


def sites_of(file):
    with open(os.path.join(ROOT, file)) as stream:
        text = stream.read()
    for number, line in code_lines(text):
        for name, pattern, new in OPERATORS:
            for found in re.finditer(pattern, line):
                yield {"file": file, "line": number + 1, "column": found.start(1), "name": name, "code": line.strip(),
                       "old": found.group(1), "new": other_constant(found.group(1)) if new is None else new}


def lot(site):
    """Decides the order of the draw; it does not change with lines elsewhere."""
    text = "%d %s %d %s %s %s" % (SEED, site["file"], site["column"], site["code"], site["old"], site["new"])
    return hashlib.sha256(text.encode()).hexdigest()


def drawn(area):
    files = subprocess.run(["git", "-C", ROOT, "ls-files", *AREAS[area][0]], capture_output=True, text=True,
                           check=True).stdout.split()
    return sorted((site for file in files if file.endswith((".cpp", ".hpp")) for site in sites_of(file)), key=lot)


def key(site):
    return "%s:%d:%d %s -> %s" % (site["file"], site["line"], site["column"] + 1, site["old"], site["new"])


def source_line(site):
    with open(os.path.join(ROOT, site["file"])) as stream:
        return stream.read().split("\n")[site["line"] - 1].strip()


def equivalents():
    """Mutants that no test can notice: file, code, old, new, argument; separated by tabs."""
    with open(os.path.join(ROOT, "tests/mutants/equivalent.tsv")) as stream:
        rows = [line.rstrip("\n").split("\t") for line in stream if line.strip() and not line.startswith("#")]
    return {tuple(row[:4]): row[4] for row in rows}


def prepare():
    """A copy of the tree, so that no mutant is ever in the tree itself; unchanged files keep their time."""
    os.makedirs(TREE, exist_ok=True)
    files = subprocess.run(["git", "-C", ROOT, "ls-files"], capture_output=True, text=True, check=True).stdout.split("\n")
    for file in filter(None, files):
        source, target = os.path.join(ROOT, file), os.path.join(TREE, file)
        if not os.path.exists(source):
            continue
        os.makedirs(os.path.dirname(target), exist_ok=True)
        if not os.path.exists(target) or open(source, "rb").read() != open(target, "rb").read():
            shutil.copy(source, target)
    if not os.path.exists(os.path.join(BUILD, "build.ninja")):
        subprocess.run(["cmake", "--preset", "release", "-Wno-dev"], cwd=TREE, check=True, stdout=subprocess.DEVNULL)


def build_error(programs):
    """Empty after a build; else what the compiler says."""
    done = subprocess.run(["ninja", "-C", BUILD, *programs], capture_output=True, text=True, errors="replace")
    return done.stdout + done.stderr if done.returncode else ""


def slow_tests():
    with open(os.path.join(ROOT, "tests/slow_tests.txt")) as stream:
        return ":".join(line.strip() for line in stream if line.strip() and not line.startswith("#"))


def killer(programs):
    """The first test that fails, or None. Quick tests run before slow ones."""
    for choice, program in itertools.product(("-" + slow_tests(), slow_tests()), programs):
        command = [os.path.join(BUILD, "bin", program), "--gtest_fail_fast", "--gtest_brief=1", "--gtest_filter=" + choice]
        try:
            done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=TEST_LIMIT_S, cwd=TREE)
        except subprocess.TimeoutExpired:
            return program + " does not end"
        if done.returncode != 0:
            failed = re.search(r"\[  FAILED  \] ([\w./]+)", done.stdout)
            return failed.group(1) if failed else program + " ended with code %d" % done.returncode
    return None


def verdict_on(site, programs):
    path = os.path.join(TREE, site["file"])
    with open(path) as stream:
        original = stream.read()
    lines = original.split("\n")
    line = lines[site["line"] - 1]
    at = site["column"]
    assert line[at:at + len(site["old"])] == site["old"], key(site)
    lines[site["line"] - 1] = line[:at] + site["new"] + line[at + len(site["old"]):]
    try:
        with open(path, "w") as stream:
            stream.write("\n".join(lines))
        if error := build_error(programs):
            is_warning = "[-Werror" in error  # CI would not build it
            return {"verdict": "killed", "by": "a warning of the compiler"} if is_warning else {"verdict": "invalid"}
        killed_by = killer(programs)
        return {"verdict": "killed", "by": killed_by} if killed_by else {"verdict": "survived"}
    finally:
        with open(path, "w") as stream:
            stream.write(original)


def known():
    if not os.path.exists(VERDICTS):
        return {}
    with open(VERDICTS) as stream:
        return {entry["key"] + " | " + entry["code"]: entry for entry in map(json.loads, stream)}


def judge(area, site, done):
    equivalent = equivalents().get((site["file"], source_line(site), site["old"], site["new"]))
    if equivalent:
        return {"verdict": "equivalent", "why": equivalent}
    name = key(site) + " | " + source_line(site)
    if name in done:
        return done[name]
    start = time.monotonic()
    entry = {"key": key(site), "code": source_line(site), "area": area, "what": site["name"],
             **verdict_on(site, AREAS[area][1]), "seconds": round(time.monotonic() - start, 1)}
    with open(VERDICTS, "a") as stream:
        stream.write(json.dumps(entry) + "\n")
    print("%-9s %s  %s" % (entry["verdict"], entry["key"], entry.get("by", "")), flush=True)
    done[name] = entry
    return entry


def report(rows):
    commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    text = ["# Mutants", "", "`./dev mutate` at %s. Seed %d, up to %d sites per area; a shorter run judges the first sites" % (commit, SEED, PER_AREA),
            "of the draw. A mutant is killed when a test of its area fails; equivalent mutants are excluded by the argument",
            "in `tests/mutants/equivalent.tsv`.", "",
            "| area | tests | judged | equivalent | killed | survived | killed of the rest |", "|---|---|---:|---:|---:|---:|---:|"]
    for area, (_, programs) in AREAS.items():
        own = [verdict["verdict"] for at, _, verdict in rows if at == area]
        killed, survived = own.count("killed"), own.count("survived")
        share = "%.0f %%" % (100 * killed / (killed + survived)) if killed + survived else "-"
        text.append("| %s | %s | %d | %d | %d | %d | %s |" % (area, ", ".join(programs), len(own), own.count("equivalent"), killed, survived, share))
    for title, verdict in (("Survivors", "survived"), ("Equivalent", "equivalent")):
        chosen = [(site, entry) for _, site, entry in rows if entry["verdict"] == verdict]
        text += ["", "## " + title, ""] + (["- `%s` in `%s`%s" % (key(site), source_line(site), ": " + entry["why"] if "why" in entry else "")
                                            for site, entry in chosen] or ["None."])
    with open(os.path.join(ROOT, "benchmarks/results", "mutants.md"), "w") as stream:
        stream.write("\n".join(text) + "\n")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--area", choices=AREAS, action="append")
    arguments.add_argument("--sites", type=int, default=PER_AREA)
    arguments.add_argument("--minutes", type=float, default=float("inf"))
    arguments.add_argument("--site", help="every mutant of FILE:LINE, outside of the draw")
    arguments.add_argument("--list", action="store_true")
    asked = arguments.parse_args()
    areas = asked.area or list(AREAS)
    queues = {area: drawn(area) for area in areas}
    if asked.site:
        queues = {area: [site for site in queue if "%s:%d" % (site["file"], site["line"]) == asked.site] for area, queue in queues.items()}
    if asked.list:
        for area, queue in queues.items():
            print("\n".join(area + " " + key(site) for site in queue[:asked.sites]), "\n%s: %d sites in all" % (area, len(queue)))
        return 0
    os.makedirs(os.path.dirname(VERDICTS), exist_ok=True)
    prepare()
    if error := build_error(sorted({program for area in areas for program in AREAS[area][1]})):
        print(error[-2000:] + "\nmutate: the tree does not build", file=sys.stderr)
        return 1
    done, rows, end = known(), [], time.monotonic() + 60 * asked.minutes
    valid = dict.fromkeys(areas, 0)
    for area, site in (pair for wave in itertools.zip_longest(*([(area, site) for site in queues[area]] for area in areas)) for pair in wave if pair):
        if valid[area] >= asked.sites or (time.monotonic() > end and key(site) + " | " + source_line(site) not in done):
            continue
        verdict = judge(area, site, done)
        if verdict["verdict"] != "invalid":
            valid[area] += 1
            rows.append((area, site, verdict))
    if not asked.site:
        report(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
