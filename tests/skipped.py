#!/usr/bin/env python3
"""How many tests of a CTest run were skipped, and why: the reason that each printed, equal reasons on one line. Cases
that Python's unittest skipped inside of a test that passed are told, too.

usage: skipped.py JUNIT_FILE (of ctest --output-junit)
"""
import collections
import re
import sys
import xml.etree.ElementTree

GTEST = re.compile(r": Skipped\n(.*?)\n+\[  SKIPPED \]", re.DOTALL)
CASE = re.compile(r" \.\.\. skipped (['\"])(.*)\1$", re.MULTILINE)
UNSTATED = "no reason stated"


def reason(output):
    """What GTEST_SKIP() was given; else the last line, without `skipped:`."""
    stated = GTEST.search(output)
    lines = [line for line in (stated[1] if stated else output).splitlines() if line.strip()]
    return re.sub(r"^skipped:\s*", "", lines[-1].strip()) if lines else UNSTATED


def summary(junit):
    """The lines of the summary."""
    tests = xml.etree.ElementTree.fromstring(junit).findall("testcase")
    skipped, inside = collections.defaultdict(list), collections.defaultdict(list)
    for test in tests:
        output = test.findtext("system-out") or ""
        if test.find("skipped") is not None:
            skipped[reason(output)].append(test.get("name"))
        for _, why in CASE.findall(output):
            inside[why].append("a case of " + test.get("name"))
    count, cases = (sum(map(len, names.values())) for names in (skipped, inside))
    yield f"{count} of {len(tests)} tests were skipped" + (f", and {cases} inside of others" if cases else "")
    for why, names in [*sorted(skipped.items(), key=lambda item: -len(item[1])), *inside.items()]:
        yield f"  {len(names):4} {why}: {names[0]}" + (", ..." if len(names) > 1 else "")


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as report:
        print("\n".join(summary(report.read())))
