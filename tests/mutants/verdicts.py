"""The verdicts on mutants, and their table."""
import collections
import functools
import json
import os
import subprocess

from sites import AREAS, PER_AREA, ROOT, SEED, identity, key

VERDICTS = os.path.join(ROOT, "benchmarks/results/mutants.jsonl")


def read(path):
    with open(path) as stream:
        return stream.read()


@functools.cache
def commit():
    return subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()


def known():
    if not os.path.exists(VERDICTS):
        return {}
    return {entry["identity"]: entry for entry in map(json.loads, read(VERDICTS).splitlines())}


@functools.cache
def lines_of(file):
    path = os.path.join(ROOT, file)
    return {line.strip() for line in read(path).splitlines()} if os.path.exists(path) else set()


def is_there(file, source):
    return source in lines_of(file)


def drop_gone():
    """Leaves the last verdict on each mutant whose line is still in its file."""
    before = known()
    left = [entry for name, entry in before.items() if is_there(*name.rsplit(" | ", 3)[0].split(" | ", 1))]
    with open(VERDICTS, "w") as stream:
        stream.writelines(json.dumps(entry) + "\n" for entry in left)
    print("dropped %d of %d verdicts: their lines are gone" % (len(before) - len(left), len(before)))


def equivalents():
    """Mutants that no test can notice: file, source line, old, new, argument; separated by tabs."""
    rows = [line.split("\t") for line in read(os.path.join(ROOT, "tests/mutants/equivalent.tsv")).split("\n") if line and line[0] != "#"]
    return {tuple(row[:4]): row[4] for row in rows}


def equivalent(site, table):
    why = table.get((site["file"], site["source"], site["old"], site["new"] or "nothing"))
    return {"verdict": "equivalent", "why": why} if why else None


def remark(entry):
    if "why" in entry:
        return entry["why"]
    slow = ", %d slow ones not asked" % entry["left_out"] if entry.get("left_out") else ""
    return "reached by no test" if not entry["suites"] and not slow else "passed by %d suites%s" % (entry["suites"], slow)


def report(queues):
    done, table, rows = known(), equivalents(), []
    for area, sites in queues.items():
        judged = [(area, site, equivalent(site, table) or done.get(identity(site))) for site in first(sites, PER_AREA, done)]
        rows += [row for row in judged if row[2]]
    at = collections.Counter(entry.get("commit", "an earlier one") for _, _, entry in rows if entry["verdict"] != "equivalent")
    text = ["# Mutants", "", "`./dev mutate`. Commits at which the mutants were judged: %s. Seed" % ", ".join("%s (%d)" % row for row in at.most_common()),
            "%d, up to %d sites per area; a shorter run judges the first sites of the draw. A mutant" % (SEED, PER_AREA), "is killed when a test of its area fails; equivalent mutants are excluded by the argument in", "`tests/mutants/equivalent.tsv`.", "",
            "Open: passed by the suites that were asked, slow ones were left out (`--longest`).", "",
            "| area | tests | judged | equivalent | killed | survived | open | killed of those decided |", "|---|---|---:|---:|---:|---:|---:|---:|"]
    for area, (_, programs) in AREAS.items():
        own = ["open" if entry.get("left_out") else entry["verdict"] for at, _, entry in rows if at == area]
        killed, survived = own.count("killed"), own.count("survived")
        share = "%.0f %%" % (100 * killed / (killed + survived)) if killed + survived else "-"
        text.append("| %s | %s | %d | %d | %d | %d | %d | %s |" % (
            area, ", ".join(programs), len(own), own.count("equivalent"), killed, survived, own.count("open"), share))
    for title, verdict in (("Survived or open", "survived"), ("Equivalent", "equivalent")):
        chosen = [(site, entry) for _, site, entry in rows if entry["verdict"] == verdict]
        text += ["", "## " + title, ""] + (["- `%s` in `%s`: %s" % (key(site), site["source"], remark(entry)) for site, entry in chosen] or ["None."])
    with open(os.path.join(ROOT, "benchmarks/results/mutants.md"), "w") as stream:
        stream.write("\n".join(text) + "\n")


def first(queue, count, done):
    """The first sites of the draw that are not invalid."""
    return [site for site in queue if done.get(identity(site), {}).get("verdict") != "invalid"][:count]
