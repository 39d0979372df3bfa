"""CPU time of a profile call in Python beside that inside of the C++ function, which the result tells.

usage: overhead.py RESULT.md HEADER
"""
import os
import statistics
import sys
import time

import numpy as np

import joulepath as jp

CALLS = 100
PATHS = {"2 waypoints": [[0.0, 0.0], [2.0, 0.0]], "200 waypoints": [[0.05 * k, 0.2 * np.sin(0.1 * k)] for k in range(200)]}


def overheads_us(robot, xy):
    """CPU time of this thread for a call less that inside of the planner."""
    path, found = jp.Path(xy), []
    for _ in range(CALLS):
        start = time.thread_time()
        p = jp.profile(robot, path, solver="fast", nodes=40)
        end = time.thread_time()
        found.append(1e6 * (end - start - p._value.cpu_s))
        del p  # its end costs the same in C++
    return found


def main():
    result, header = sys.argv[1:]
    robot = jp.Robot.example()
    lines = ["# Python: overhead of a call", "", header,
             f"Load average before the measurement: {os.getloadavg()[0]:.2f}. {CALLS} calls of `jp.profile` for each path, which is made before.", "",
             "| path | least, µs | median, µs | 90 % below, µs | target, µs |", "|---|---:|---:|---:|---:|"]
    for name, xy in PATHS.items():
        found = overheads_us(robot, xy)
        lines.append(f"| {name} | {min(found):.1f} | {statistics.median(found):.1f} | {np.percentile(found, 90):.1f} | 50 |")
    lines += ["", "The figures are CPU time of the calling thread less that inside of C++ (mission, plan, trajectory, JSON). The overhead is "
              "the check of the arguments and the making of the result, with caches that the solver has filled with its own data."]
    with open(result, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
