#!/usr/bin/env python3
"""How many tests of a CTest run were skipped, and why: the reason that each printed, equal reasons on one line.

usage: skipped.py JUNIT_FILE (of ctest --output-junit)
"""
import collections
import re
import sys
import xml.etree.ElementTree

GTEST = re.compile(r": Skipped\n(.*?)\n+\[  SKIPPED \]", re.DOTALL)
UNSTATED = "no reason stated"


def reason(output):
    """What GTEST_SKIP() was given; else the last line, without `skipped:`."""
    stated = GTEST.search(output)
    lines = [line for line in (stated[1] if stated else output).splitlines() if line.strip()]
    return re.sub(r"^skipped:\s*", "", lines[-1].strip()) if lines else UNSTATED


def summary(junit):
    """The lines of the summary."""
    cases = xml.etree.ElementTree.fromstring(junit).findall("testcase")
    by_reason = collections.defaultdict(list)
    for case in cases:
        if case.find("skipped") is not None:
            by_reason[reason(case.findtext("system-out") or "")].append(case.get("name"))
    yield f"{sum(map(len, by_reason.values()))} of {len(cases)} tests were skipped" + (":" if by_reason else "")
    for why, names in sorted(by_reason.items(), key=lambda item: -len(item[1])):
        yield f"  {len(names):4} {why}: {names[0]}" + (", ..." if len(names) > 1 else "")


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as report:
        print("\n".join(summary(report.read())))
