"""Throughput, memory and files of many plans; a projection to a cluster from the measured parts.

usage: scale.py PROGRAM FOLDER MOST RESULT.md HEADER      MOST: missions of the largest batch
"""
import dataclasses
import json
import os
import pathlib
import re
import subprocess
import sys
import time

import distributed

from joulepath import Robot, cluster

OPTIONS = ("--nodes", "20", "--no-cache")  # no run begins with the answers of another
CORES, GOAL, SHARDS = 64, 1_000_000, 1024


@dataclasses.dataclass
class Cost:
    cpu_s: float
    wall_s: float
    peak_MiB: float


# Peak memory counts from the fork on: a small process begins the measured one, and tells what it used.
LAUNCH = """import json, os, sys
_, status, used = os.wait4(os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ), 0)
print(json.dumps([status, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024]))"""


def start(words):
    return subprocess.Popen([sys.executable, "-S", "-E", "-c", LAUNCH, *map(str, words)], stdout=subprocess.PIPE, text=True)


def wait(processes):
    """The costs of processes that run at the same time."""
    begin, costs = time.monotonic(), []
    for process in processes:
        status, cpu_s, peak_MiB = json.loads(process.communicate()[0].splitlines()[-1])
        if status != 0:
            raise SystemExit(f"{process.args} ended with {status}")
        costs.append(Cost(cpu_s, time.monotonic() - begin, peak_MiB))
    return costs


def write_missions(count, curves=None, name="missions"):
    """One curve each, no two alike unless `curves` says how many there are."""
    file = pathlib.Path(f"{name}_{count}.jsonl")
    with open(file, "w", encoding="utf-8") as out:
        for k in range(count):
            curve = [[[0, 0], [1, 0], [2, k % (curves or count) / (curves or count)], [3, 0.5]]]
            out.write(json.dumps({"robot": "robot.yaml", "legs": [{"path": {"bezier_m": curve}}]}) + "\n")
    return file


def growth(program, most):
    """One process, from 100 missions on."""
    rows, count = [], 100
    while count <= most:
        file, out = write_missions(count), pathlib.Path(f"one_{count}")
        cost, = wait([start([program, "batch", file, "--out", out, "-j", "1", "--quiet", "--force", *OPTIONS])])
        rows.append((count, cost, sum(f.stat().st_size for f in out.iterdir()) / 2**20, (out / "results.jsonl").stat().st_size / 2**20))
        print(rows[-1], file=sys.stderr, flush=True)
        count *= 10
    return rows


def sharded(program, count, processes):
    """As many processes as shards, and the merge."""
    shards = [pathlib.Path(f"shard_{k}") for k in range(1, processes + 1)]
    costs = wait([start([program, "batch", f"missions_{count}.jsonl", "--out", shard, "-j", "1", "--quiet", "--force", *OPTIONS,
                         "--shard", f"{k}/{processes}"]) for k, shard in enumerate(shards, 1)])
    merge, = wait([start([program, "merge", *shards, "--out", "merged", "--quiet", "--force"])])
    same = pathlib.Path("merged/results.jsonl").read_bytes() == pathlib.Path(f"one_{count}/results.jsonl").read_bytes()
    return costs, merge, same


def beside_planning(program, count, shards=4):
    """What `count` missions cost beside their planning: a batch that plans none of them, and the merge of shards whose missions share
    100 curves, so that most of their plans are remembered."""
    file = write_missions(count)
    pathlib.Path("held.jsonl").write_text("".join(json.dumps({"index": k, "reason": "not planned"}) + "\n" for k in range(count)))
    words = [program, "batch", file, "-j", "1", "--quiet", "--force", *OPTIONS, "--quarantine", "held.jsonl", "--out"]
    books, = wait([start([*words, "books"])])
    pathlib.Path("few.jsonl").write_text("".join(json.dumps({"index": k, "reason": "not planned"}) + "\n" for k in range(0, count, SHARDS)))
    listing, = wait([start([program, "batch", file, "-j", "1", "--quiet", "--force", *OPTIONS, "--quarantine", "few.jsonl", "--shard", f"1/{SHARDS}",
                            "--out", "listing"])])
    alike, folders = write_missions(count, 100, "alike"), [pathlib.Path(f"again_{k}") for k in range(1, shards + 1)]
    for k, folder in enumerate(folders, 1):
        wait([start([program, "batch", alike, "-j", "1", "--quiet", "--force", *OPTIONS, "--shard", f"{k}/{shards}", "--out", folder])])
    merge, = wait([start([program, "merge", *folders, "--out", "merged_again", "--quiet", "--force"])])
    return books, listing, merge, sum(f.stat().st_size for f in pathlib.Path("merged_again").iterdir()) / 2**20


def on_dask(count, workers, shards):
    """Wall time with Dask workers, and the memory of a worker beside the processes of its shards."""
    out = pathlib.Path(f"dask_{workers}_{shards}_{time.monotonic_ns()}")
    with distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None) as made:
        with distributed.Client(made) as client:
            begin = time.monotonic()
            cluster.run(f"missions_{count}.jsonl", client, out, shards=shards, options=OPTIONS)
            wall_s = time.monotonic() - begin
            peaks = client.run(lambda: int(re.search(r"VmHWM:\s*(\d+)", pathlib.Path("/proc/self/status").read_text())[1]) / 1024)
    same = (out / "results.jsonl").read_bytes() == pathlib.Path(f"one_{count}/results.jsonl").read_bytes()
    return wall_s, max(peaks.values()), same


def task_cost():
    """CPU and wall time of a shard's process that has one mission to plan."""
    words = [sys.executable, "-m", "joulepath", "batch", "missions_100.jsonl", "--shard", "1/100", "-j", "1", "--quiet", "--force",
             "--out", "tiny", *OPTIONS]
    return min((wait([start(words)])[0] for _ in range(5)), key=lambda cost: cost.cpu_s)


def yes(same):
    return "the same" if same else "DIFFERENT"


def projection(per_mission_s, task, books, listing, merge, count, files_MiB):
    plan_s, tasks_s = GOAL * per_mission_s / CORES, SHARDS * task.cpu_s / CORES
    list_s = listing.cpu_s * GOAL / count * SHARDS / CORES
    merge_s = merge.cpu_s * GOAL / count
    return [f"## Projection: {GOAL:,} missions on {CORES} cores, {SHARDS} shards", "",
            "| part | from | s |", "|---|---|---:|",
            f"| planning | {1000 * per_mission_s:.1f} ms of CPU per mission, divided by {CORES} | {plan_s:.0f} |",
            f"| processes of shards | {task.cpu_s:.2f} s of CPU each, divided by {CORES} | {tasks_s:.0f} |",
            f"| the list of missions, read by each shard | {listing.cpu_s:.2f} s of CPU for {count:,}, in proportion, times {SHARDS}, divided by {CORES} | {list_s:.0f} |",
            f"| merge, one process | {merge.cpu_s:.1f} s of CPU for {count:,} lines, in proportion | {merge_s:.0f} |",
            f"| sum | efficiency {100 * plan_s / (plan_s + tasks_s + list_s + merge_s):.0f} % | {plan_s + tasks_s + list_s + merge_s:.0f} |", "",
            f"The files of the merged results take {files_MiB * GOAL / count:,.0f} MiB, and about as much again in the shards until the merge.", "",
            f"**What breaks first** is memory in one process: the merge takes {merge.peak_MiB:.0f} MiB for {count:,} lines, "
            f"{merge.peak_MiB * GOAL / count / 1024:.1f} GiB in proportion, and every shard reads the whole list of missions "
            f"({books.peak_MiB:.0f} MiB for {count:,} missions with their fingerprints). The page of the report lists every mission. Shards are strided, so "
            "that hard missions spread over all of them; the slowest one decides the end. The projection leaves out the waiting for "
            "a cluster's scheduler and for a shared disk, which were not measured."]


def main():
    program, folder, most, result, header = sys.argv[1:]
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    result = pathlib.Path(result).resolve()
    os.chdir(folder)
    Robot.example().save("robot.yaml")
    load = os.getloadavg()[0]
    rows = growth(program, int(most))
    count = min(1000, int(most))
    of_one = next(cost for missions, cost, *_ in rows if missions == count)
    lines = ["# Many plans", "", header, f"Load average before the measurement: {load:.2f}; CPU time counts, wall time is what the load left. "
             "Missions along given curves, 20 nodes, `batch -j 1 --no-cache`.", "", "## Growth, one process", "",
             "| missions | CPU, s | missions per CPU-minute | wall, s | peak memory, MiB | results.jsonl, MiB | all files, MiB |",
             "|---:|---:|---:|---:|---:|---:|---:|"]
    lines += [f"| {n:,} | {c.cpu_s:.1f} | {60 * n / c.cpu_s:.0f} | {c.wall_s:.0f} | {c.peak_MiB:.0f} | {lines_MiB:.2f} | {all_MiB:.2f} |"
              for n, c, all_MiB, lines_MiB in rows]
    lines += ["", f"## Processes and workers, {count:,} missions", "",
              "| run | CPU of planning, s | efficiency by CPU | wall, s | memory per process, MiB | results |", "|---|---:|---:|---:|---:|---|",
              f"| 1 process | {of_one.cpu_s:.1f} | 1 | {of_one.wall_s:.0f} | {of_one.peak_MiB:.0f} | |"]
    costs, merge, same = sharded(program, count, 2)
    cpu_s = sum(cost.cpu_s for cost in costs)
    lines.append(f"| 2 processes with `--shard`, then `merge` | {cpu_s:.1f} + {merge.cpu_s:.2f} | {of_one.cpu_s / (cpu_s + merge.cpu_s):.2f} | "
                 f"{max(c.wall_s for c in costs) + merge.wall_s:.0f} | {max(c.peak_MiB for c in costs):.0f} | {yes(same)} |")
    for workers in (1, 2):
        wall_s, peak_MiB, same = on_dask(count, workers, 8)
        lines.append(f"| {workers} Dask worker{'s' * (workers > 1)}, 8 shards | | | {wall_s:.0f} | {peak_MiB:.0f} (the worker itself) | {yes(same)} |")
    many = 100_000
    books, listing, merge, files_MiB = beside_planning(program, many)
    lines += ["", f"## {many:,} missions without their planning", "", "| part | CPU, s | peak memory, MiB |", "|---|---:|---:|",
              f"| `batch` that reads all missions and plans none (`--quarantine`) | {books.cpu_s:.1f} | {books.peak_MiB:.0f} |",
              f"| `merge` of 4 shards whose missions share 100 curves: {files_MiB:.0f} MiB of files | {merge.cpu_s:.1f} | {merge.peak_MiB:.0f} |"]
    largest, cost, *_ = rows[-1]
    lines += ["", *projection(cost.cpu_s / largest, task_cost(), books, listing, merge, many, files_MiB)]
    result.write_text("\n".join(lines) + "\n", encoding="utf-8")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
