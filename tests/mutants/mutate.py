#!/usr/bin/env python3
"""Mutants: changes one operator or constant at a time and looks whether a test notices.

usage: ./dev mutate [--area model|nlp|profile|diagnosis] [--sites N] [--minutes M] [--longest S] [-j N] [--survivors] [--report] [--list]

Draws sites by a fixed seed, 75 in each of four areas. The tests of the areas that are asked for are compiled once, in
build/mutants/tree, with every mutant in them (tests/mutants/mutation.hpp); an environment variable chooses one. A
first run notes which suite of tests reaches which mutant and how long it takes; a mutant is then judged by the suites
that reach it, quick ones first, -j mutants at a time. What cannot be compiled in this way, or stands in a constant
expression, is compiled alone. Verdicts are kept in benchmarks/results/mutants.jsonl, so that a later call, on any machine, goes on;
--survivors judges survivors again. --longest leaves out suites that take more than S seconds of CPU; a later call asks
them about the survivors. The table is benchmarks/results/mutants.md.
"""
import argparse
import concurrent.futures
import hashlib
import itertools
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import time

from sites import AREAS, PER_AREA, ROOT, drawn, identity, key, mutated, with_mutants
from verdicts import VERDICTS, commit, drop_gone, equivalent, equivalents, first, known, read, report

OUT = os.path.join(ROOT, "build/mutants")
TREE = os.path.join(OUT, "tree")
BUILD = os.path.join(TREE, "build/release")
FORMS, SURVEY = os.path.join(OUT, "forms.json"), os.path.join(OUT, "survey.json")
SPARE, MEMORY_BYTES, NO_LIMIT, QUICK_S = 1.3, 4 << 30, float("inf"), 0.5


def write(path, text):
    """Unchanged files keep their time."""
    if not os.path.exists(path) or read(path) != text:
        with open(path, "w") as stream:
            stream.write(text)


def copy_tree():
    """A copy of the tree, so that no mutant is ever in the tree itself."""
    files = subprocess.run(["git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard"], capture_output=True, text=True, check=True).stdout.split("\n")
    for file in filter(None, files):
        source, target = os.path.join(ROOT, file), os.path.join(TREE, file)
        if os.path.exists(source) and (not os.path.exists(target) or open(source, "rb").read() != open(target, "rb").read()):
            os.makedirs(os.path.dirname(target), exist_ok=True)
            shutil.copy(source, target)
    if not os.path.exists(os.path.join(BUILD, "build.ninja")):
        subprocess.run(["cmake", "--preset", "release", "-Wno-dev", "-DJOULEPATH_UNITY=ON", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"], cwd=TREE, check=True, stdout=subprocess.DEVNULL)


def programs_of(areas):
    return sorted({program for area in areas for program in AREAS[area][1]})


def build_error(programs):
    """Empty after a build; else what the compiler says."""
    done = subprocess.run(["ninja", "-j2", "-k", "0", "-C", BUILD, "blind_plant", *programs], capture_output=True, text=True, errors="replace")
    return done.stdout + done.stderr if done.returncode else ""


def number(sites):
    """Each site's number, and the form that compiled in an earlier run."""
    forms = json.loads(read(FORMS)) if os.path.exists(FORMS) else {}
    for id, site in enumerate(sites, 1):
        live, alone = forms.get(identity(site), [site["kind"] == "constant", False])
        site.update(id=id, live=live, alone=alone)


def build_all(sites, programs):
    """Compiles all mutants at once. A site that does not compile loses its live constant, then its place."""
    while True:
        for file in {site["file"] for site in sites}:
            own = [site for site in sites if site["file"] == file and not site["alone"]]
            text = read(os.path.join(ROOT, file))
            write(os.path.join(TREE, file), with_mutants(text, own) if own else text)
        error = build_error(programs)
        if not error:
            return
        places = {(os.path.normpath(os.path.join(BUILD, path)), int(line)) for path, line in re.findall(r"([\w./-]+\.[ch]pp):(\d+):", error)}
        guilty = [site for site in sites if not site["alone"] and (os.path.join(TREE, site["file"]), site["line"]) in places]
        if not guilty:
            sys.exit(error[-4000:] + "\nmutate: the tree does not build")
        for site in guilty:
            print("not with the others: " + key(site), flush=True)
            site["alone"] = not site["live"]
            site["live"] = False
        write(FORMS, json.dumps({identity(site): [site["live"], site["alone"]] for site in sites}))


def run_tests(program, choice, mutant=0, cpu_s=600, notes=os.devnull):
    environment = {**os.environ, "MUTANT": str(mutant), "MUTANT_REACHED": notes}
    limits = ["prlimit", "--cpu=%d:%d" % (cpu_s, cpu_s + 5), "--as=%d" % MEMORY_BYTES, "--core=0"]
    return subprocess.run([*limits, os.path.join(BUILD, "bin", program), "--gtest_fail_fast", "--gtest_brief=1", "--gtest_filter=" + choice],
                          capture_output=True, text=True, errors="replace", cwd=TREE, env=environment)


def children_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def suites(program):
    """Filters, one for each suite of tests; each slow test is on its own."""
    listed = subprocess.run([os.path.join(BUILD, "bin", program), "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    names = [line.split()[0] for line in listed.split("\n") if re.match(r"^\S+\.( |$)", line)]
    slow = [line for line in read(os.path.join(ROOT, "tests/slow_tests.txt")).split("\n") if line and not line.startswith("#")]
    own = [test for test in slow if test.rsplit(".", 1)[0] + "." in names]
    return [name + "*-" + ":".join(own) for name in names] + own


def suite_of(program, choice):
    """What a suite reaches and its CPU time, with no mutant active."""
    notes, start_s = os.path.join(OUT, "reached.%d.txt" % os.getpid()), children_s()
    write(notes, "")
    done = run_tests(program, choice, notes=notes)
    if done.returncode != 0:
        sys.exit(done.stdout[-4000:] + "\nmutate: %s fails without a mutant" % choice)
    return {"program": program, "choice": choice, "cpu_s": children_s() - start_s, "reaches": list(map(int, read(notes).split()))}


def suites_of(program, pool):
    """All suites of a program; slow ones stand last and begin first."""
    choices = suites(program)[::-1]
    found = list(pool.map(suite_of, [program] * len(choices), choices))
    print("%s: %d suites take %.0f s of CPU" % (program, len(found), sum(suite["cpu_s"] for suite in found)), flush=True)
    return found


def survey(programs, jobs):
    """The suites of all programs, quick ones first. Kept for each program as long as its bytes stay."""
    kept = json.loads(read(SURVEY)) if os.path.exists(SURVEY) else {}
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:  # processes: each knows the CPU time of its own tests
        for program in programs:
            with open(os.path.join(BUILD, "bin", program), "rb") as stream:
                state = hashlib.sha256(stream.read()).hexdigest()
            if kept.get(program, {}).get("state") != state:
                kept[program] = {"state": state, "suites": suites_of(program, pool)}
                write(SURVEY, json.dumps(kept))
    return sorted((suite for program in programs for suite in kept[program]["suites"]), key=lambda suite: suite["cpu_s"])


def joined(suites):
    """The quickest suites of a program run together."""
    groups = []
    for program in sorted({suite["program"] for suite in suites}):
        own = [suite for suite in suites if suite["program"] == program and suite["cpu_s"] < QUICK_S]
        parts = [(suite["choice"] + "-").split("-") for suite in own]
        choice = ":".join(part[0] for part in parts) + "-" + ":".join({part[1] for part in parts} - {""})
        if own:
            groups.append({"program": program, "choice": choice, "cpu_s": sum(suite["cpu_s"] for suite in own)})
    return groups + [suite for suite in suites if suite["cpu_s"] >= QUICK_S]


def killer(site, chosen):
    """The first test that fails, or None."""
    for suite in joined(chosen):
        done = run_tests(suite["program"], suite["choice"], site["id"], int(10 + 5 * suite["cpu_s"]))
        if done.returncode != 0:
            failed = re.search(r"\[  FAILED  \] ([\w./]+)", done.stdout)
            ended = "does not end" if done.returncode == -24 else "ends with code %d" % done.returncode
            return failed.group(1) if failed else suite["choice"].split("-")[0] + " " + ended
    return None


def alone(site, suites, longest_s):
    """Compiled with this mutant only; every suite of its area is asked."""
    path = os.path.join(TREE, site["file"])
    before = read(path)
    try:
        write(path, mutated(read(os.path.join(ROOT, site["file"])), site))
        if build_error(AREAS[site["area"]][1]):
            return {"verdict": "invalid"}
        return asked_about({**site, "id": 0}, suites, longest_s)
    finally:
        write(path, before)


def needs_own_build(site, surveyed):
    """Not compiled with the others, or evaluated by the compiler."""
    reached = any(site["id"] in suite["reaches"] for suite in surveyed)
    return site["alone"] or (site["in_constant"] and not reached)


def asked_about(site, reaching, longest_s):
    quick = [suite for suite in reaching if suite["cpu_s"] <= longest_s]
    by = killer(site, quick)
    return {"verdict": "killed", "by": by} if by else {"verdict": "survived", "suites": len(quick), "left_out": len(reaching) - len(quick), "longest": longest_s}


def verdict_on(site, surveyed, longest_s):
    own = [suite for suite in surveyed if suite["program"] in AREAS[site["area"]][1]]
    if needs_own_build(site, surveyed):
        return alone(site, own, longest_s)
    return asked_about(site, [suite for suite in own if site["id"] in suite["reaches"]], longest_s)


def keep(site, verdict, done):
    """One line in the file of verdicts for each: a call that is ended goes on."""
    done[identity(site)] = {"identity": identity(site), "area": site["area"], "commit": commit(), **verdict}
    with open(VERDICTS, "a") as stream:
        stream.write(json.dumps(done[identity(site)]) + "\n")
    print("%-9s %s  %s" % (verdict["verdict"], key(site), verdict.get("by", "")), flush=True)


def open_sites(queues, areas, asked, done):
    """The sites that have no verdict yet, or are asked about again; the areas take turns."""
    table = equivalents()
    again = {name for name, entry in done.items() if entry["verdict"] == "survived" and (
        asked.survivors or (entry.get("left_out") and asked.longest > entry.get("longest", 0)))}
    turns = itertools.chain(*itertools.zip_longest(*[first(queues[area], asked.sites, done) for area in areas]))
    return [site for site in filter(None, turns) if not equivalent(site, table) and (identity(site) not in done or identity(site) in again)]


def judge_all(queues, asked):
    done, areas, end_s = known(), asked.area or list(AREAS), time.monotonic() + 60 * asked.minutes
    programs = programs_of(areas)
    copy_tree()
    sites = [site for queue in queues.values() for site in queue]
    number(sites)
    build_all(sites, programs)
    surveyed = survey(programs, asked.jobs)
    chosen = open_sites(queues, areas, asked, done)

    def judged(site):
        return None if time.monotonic() > end_s else verdict_on(site, surveyed, asked.longest)

    for own_build in (False, True):  # those last and one by one: afterwards the programs have one mutant only
        now = [site for site in chosen if needs_own_build(site, surveyed) == own_build]
        with concurrent.futures.ThreadPoolExecutor(1 if own_build else asked.jobs) as pool:
            for site, verdict in zip(now, pool.map(judged, now)):
                if verdict:
                    keep(site, verdict, done)


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--area", choices=AREAS, action="append")
    arguments.add_argument("--sites", type=int, default=PER_AREA)
    arguments.add_argument("--minutes", type=float, default=NO_LIMIT)
    arguments.add_argument("--longest", type=float, default=NO_LIMIT)
    arguments.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    for flag in ("--survivors", "--report", "--list"):
        arguments.add_argument(flag, action="store_true")
    asked = arguments.parse_args()
    queues = {area: drawn(area)[:int(SPARE * PER_AREA)] for area in AREAS}
    if asked.list:
        print("\n".join(area + " " + key(site) + "  " + site["source"] for area in asked.area or AREAS for site in queues[area][:asked.sites]))
        return 0
    os.makedirs(TREE, exist_ok=True)
    if asked.report:
        drop_gone()
    else:
        judge_all(queues, asked)
    report(queues)
    return 0


if __name__ == "__main__":
    sys.exit(main())
