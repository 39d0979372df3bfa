"""Time of a profile call in Python beside the time inside of the C++ function, which the result tells.

usage: overhead.py RESULT.md HEADER
"""
import os
import resource
import statistics
import sys
import time

import numpy as np

import joulepath as jp

CALLS = 300
PATHS = {"2 waypoints": [[0.0, 0.0], [2.0, 0.0]], "200 waypoints": [[0.05 * k, 0.2 * np.sin(0.1 * k)] for k in range(200)]}


def cpu_s():
    use = resource.getrusage(resource.RUSAGE_THREAD)
    return use.ru_utime + use.ru_stime


def overheads_us(robot, xy):
    """Wall time of a call less the time inside of the planner, which is wall time too: scheduling adds to both."""
    array, found = np.asarray(xy), []
    for _ in range(CALLS):
        start = time.perf_counter()
        p = jp.profile(robot, array, solver="fast", nodes=40)
        found.append(1e6 * (time.perf_counter() - start - p._value.seconds))
    return found


def main():
    result, header = sys.argv[1:]
    robot = jp.Robot.example()
    lines = ["# Python: overhead of a call", "", header,
             f"Load average before the measurement: {os.getloadavg()[0]:.2f}. {CALLS} calls of `jp.profile` for each path.", "",
             "| path | median, µs | 90 % below, µs | target, µs |", "|---|---:|---:|---:|"]
    before_s = cpu_s()
    for name, xy in PATHS.items():
        found = overheads_us(robot, xy)
        lines.append(f"| {name} | {statistics.median(found):.1f} | {np.percentile(found, 90):.1f} | 50 |")
    lines += ["", f"CPU time of all calls: {cpu_s() - before_s:.1f} s. The overhead is the conversion of waypoints, the path through them "
              "and the checks of the arguments."]
    with open(result, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
