#!/usr/bin/env python3
"""Results that are older than what they follow from, their renewal, and the figures that documents quote.

usage: results.py                     each result with the commits to its inputs since, and how long its renewal took
       results.py renew NAME...       renew by name
       results.py renew --minutes M   renew the stale ones that fit, the quoted and the oldest first
       results.py check figures       exit 1 where a quoted figure is not the result file's
       results.py check ages          exit 1 where a quoted result is too old; 77 where there is no history

benchmarks/results.toml says what each result follows from. A renewal's time goes to results/renewals.tsv.
"""
import functools
import pathlib
import re
import subprocess
import sys
import time
import tomllib

SOURCE = pathlib.Path(__file__).resolve().parent.parent
RESULTS = SOURCE / "benchmarks/results"
RENEWALS = RESULTS / "renewals.tsv"
COMMIT = re.compile(r"\b[0-9a-f]{7,40}\b")


class Figure(str):
    """A figure as its result file prints it: plain in `{0}`, a number in `{0:.1f}`, a percentage in `{0:.0%}`."""

    def __format__(self, spec):
        return format(float(self), spec.replace(",", ",.0f")).replace("%", " %") if spec else str(self)


def git(*arguments):
    answer = subprocess.run(["git", "-C", SOURCE, *arguments], capture_output=True, text=True)
    return answer.stdout.strip() if answer.returncode == 0 else None


def read_index():
    """The results by name, the figures, and the number of commits that a quoted result may be behind."""
    entries = tomllib.loads((SOURCE / "benchmarks/results.toml").read_text())
    figures, most_changes = entries.pop("figure"), entries.pop("most_changes")
    return entries, figures, most_changes


@functools.cache
def commits_of(file):
    """Commits of this branch that a result file names, for the whole of it or for a section."""
    words = {word for line in (RESULTS / file).read_text().splitlines()
             if any(mark in line for mark in ("ommand", "./dev ", "ommits"))
             for word in COMMIT.findall(line)}
    return sorted(word for word in words if git("merge-base", "--is-ancestor", word, "HEAD") is not None)


def has_history(index):
    """Whether this is a whole clone, rather than an unpacked archive, a shallow clone or a repository of its own."""
    return git("rev-parse", "--is-shallow-repository") == "false" and any(commits_of(result["file"]) for result in index.values())


def age(result):
    """Commits to the result's inputs since the oldest commit that its file names; None where it names none."""
    return max((int(git("rev-list", "--count", f"{commit}..HEAD", "--", *result["inputs"]))
                for commit in commits_of(result["file"])), default=None)


def renewal_minutes():
    """Minutes that the last renewal of each result took, by name."""
    if not RENEWALS.exists():
        return {}
    rows = [line.split("\t") for line in RENEWALS.read_text().splitlines()[1:]]
    return {row[0]: float(row[1]) for row in rows}


QUOTING = ("README.md", "docs/limits.md")


def quoted_names(index, figures):
    """Results that README and the page of limits quote, by figure or by link."""
    text = "".join((SOURCE / document).read_text() for document in QUOTING)
    linked = {name for name, result in index.items() if f"results/{result['file']}" in text}
    return linked | {figure["result"] for figure in figures if figure["document"] in QUOTING}


def show(index, figures, most_changes):
    minutes, quoted = renewal_minutes(), quoted_names(index, figures)
    print(f"{'result':20} {'commits since':>13} {'renewal':>10}  command   (*: README or docs/limits.md quotes it; at most {most_changes})")
    for name, result in sorted(index.items(), key=lambda item: -(age(item[1]) or 0)):
        known = age(result)
        took = f"{minutes[name]:.1f} min" if name in minutes else "unknown"
        since = "unknown" if known is None else known
        print(f"{name + ('*' if name in quoted else ''):20} {since:>13} {took:>10}  {result['run']}")


def renew(name, result):
    """Runs the result's command; its time, commit and machine go to the list of renewals."""
    print(f"renewing {name}: {result['run']}", flush=True)
    begin = time.monotonic()
    if subprocess.run(["bash", "-c", result["run"]], cwd=SOURCE).returncode != 0:
        sys.exit(f"results: {result['run']} failed; {result['file']} may be the old one")
    spent = (time.monotonic() - begin) / 60
    rows = RENEWALS.read_text().splitlines()[1:] if RENEWALS.exists() else []
    rows = [row for row in rows if row.split("\t")[0] != name]
    rows.append(f"{name}\t{spent:.1f}\t{git('rev-parse', '--short', 'HEAD')}")
    RENEWALS.write_text("\n".join(["result\tminutes\tcommit", *sorted(rows)]) + "\n")
    return spent


def renew_within(minutes, index, figures):
    """Renews stale results of known duration while they fit: what README quotes first, then by age."""
    known, quoted = renewal_minutes(), quoted_names(index, figures)
    order = sorted((name for name in known if name in index and (age(index[name]) or 0) > 0),
                   key=lambda name: (name not in quoted, -age(index[name])))
    for name in order:
        if known[name] <= minutes:
            minutes -= renew(name, index[name])


def wrong_figures(index, figures):
    """Quoted figures that the document does not have in the words that the result gives."""
    for figure in figures:
        result = index[figure["result"]]["file"]
        found = re.search(figure["pattern"], (RESULTS / result).read_text(), re.MULTILINE)
        if not found:
            yield f"results/{result} has nothing that matches {figure['pattern']}"
            continue
        expected = figure["text"].format(*map(Figure, found.groups()))
        if expected not in " ".join((SOURCE / figure["document"]).read_text().split()):
            yield f"{figure['document']} should say \"{expected}\" (results/{result})"


def old_results(index, figures, most_changes):
    """Quoted results that are too old. Of a campaign that README quotes, README must name the commit instead."""
    readme = (SOURCE / "README.md").read_text()
    for name in sorted(quoted_names(index, figures)):
        result, changes = index[name], age(index[name])
        if result.get("campaign"):
            if f"results/{result['file']}" in readme and not any(commit[:7] in readme for commit in commits_of(result["file"])):
                yield f"README.md quotes the campaign results/{result['file']} without its commit"
        elif changes is None:
            yield f"results/{result['file']} names no commit of this branch: {result['run']}"
        elif changes > most_changes:
            yield f"results/{result['file']} is {changes} commits behind its inputs (at most {most_changes}): {result['run']}"


def main(arguments):
    index, figures, most_changes = read_index()
    match arguments:
        case []:
            show(index, figures, most_changes)
        case ["renew", "--minutes", minutes]:
            renew_within(float(minutes), index, figures)
        case ["renew", *names] if names and set(names) <= set(index):
            for name in names:
                renew(name, index[name])
        case ["check", "figures"]:
            return report([*wrong_figures(index, figures)])
        case ["check", "ages"]:
            if not has_history(index):
                return 77
            return report([*old_results(index, figures, most_changes)])
        case _:
            sys.exit(f"{__doc__}\nnames: {' '.join(index)}")
    return 0


def report(findings):
    print("\n".join(findings))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
