#!/usr/bin/env python3
"""Runs the shard commands of the Slurm, Kubernetes and Snakemake examples as their engines would, and merges the shards.

usage: cluster_examples.py MANY_PLANS.md FOLDER_OF_THE_PROGRAM

The merged results of each example must have the bytes of one run. Two missions cannot be planned: an example must not
stop because of them.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SHARDS, MISSIONS = 3, 7


def example(text, engine, language):
    return re.search(rf"^\*\*{engine}\*\*.*?^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[1]


def slurm(text):
    """Each task of the array has its own number in the environment."""
    script = re.search(r"^#!/bin/sh\n#SBATCH.*?(?=^```)", text, re.MULTILINE | re.DOTALL)[0]
    for task in range(1, SHARDS + 1):
        yield script, {"SLURM_ARRAY_TASK_ID": str(task), "SLURM_ARRAY_TASK_COUNT": str(SHARDS)}
    yield re.search(r'--wrap "(.*?)"', text)[1], {}


def kubernetes(text):
    """Pods count from 0; /data is the shared volume."""
    command = json.loads(re.search(r"args: (\[.*\])$", example(text, "Kubernetes", "yaml"), re.MULTILINE)[1])[0]
    for pod in range(SHARDS):
        yield command.replace("/64 ", f"/{SHARDS} ").replace("/data/", ""), {"JOB_COMPLETION_INDEX": str(pod)}
    yield "joulepath merge shards/* --out plans", {}


def snakemake(text):
    """The shells of the two rules, with the values of their wildcards."""
    rules = example(text, "Snakemake", "python").replace('" + str(N) + "', str(SHARDS))
    merge, shard = re.findall(r'shell: "(.*)"$', rules, re.MULTILINE)
    for k in range(1, SHARDS + 1):
        yield shard.format(input="missions.jsonl", wildcards=type("Wildcards", (), {"k": k})), {}
    yield merge, {}


def write_inputs(folder):
    subprocess.run(["joulepath", "init", "example", "--quiet"], cwd=folder, check=True)
    (folder / "robot.yaml").write_text((folder / "example/robot.yaml").read_text())
    lines = [{"robot": "robot.yaml", "legs": [{"path": {"bezier_m": [[[0, 0], [1, 0], [2, 0.1 * k], [3, 0.5]]]}}]}
             for k in range(MISSIONS)]
    lines[1]["robot"], lines[2]["objective"] = "missing.yaml", {"minimize": "energy", "deadline_s": 0.5}
    (folder / "missions.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))


def run(commands, folder):
    for command, variables in commands:
        subprocess.run(["sh", "-c", command], cwd=folder, env={**os.environ, **variables}, check=True)


def main():
    text = pathlib.Path(sys.argv[1]).read_text()
    os.environ["PATH"] = f"{pathlib.Path(sys.argv[2]).resolve()}:{os.environ['PATH']}"
    for engine in (slurm, kubernetes, snakemake):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            write_inputs(folder)
            run(engine(text), folder)
            whole = subprocess.run(["joulepath", "batch", "missions.jsonl", "--out", "one", "--quiet"], cwd=folder)
            if whole.returncode != 1:  # a line names a robot that is missing
                sys.exit(f"{engine.__name__}: the batch ends with {whole.returncode}, not 1")
            one = (folder / "one/results.jsonl").read_text()
            statuses = [json.loads(line)["status"] for line in one.splitlines()]
            if statuses.count("optimal") != MISSIONS - 2:
                sys.exit(f"{engine.__name__}: the missions have the statuses {statuses}")
            if (folder / "plans/results.jsonl").read_text() != one:
                sys.exit(f"{engine.__name__}: the merged results differ from those of one run")
            print(f"{engine.__name__}: {SHARDS} shards, the bytes of one run")


if __name__ == "__main__":
    main()
