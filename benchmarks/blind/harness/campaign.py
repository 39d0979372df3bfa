"""Diagnose the cases of a sealed campaign, in chunks that can be interrupted: each finished case is one line of
diagnosed.jsonl. The data set is generated again from the case's seed, without a label, and removed afterwards;
the diagnosis sees a folder named after the case's number and nothing else."""
import concurrent.futures
import hashlib
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import plan
import seal
import workspace

KEEP = ("gap", "where", "verdict", "causes", "ranking", "leftover", "next_experiment", "ceiling", "control")


def run_quietly(command, folder):
    start = time.monotonic()
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(folder), "TMPDIR": str(folder)}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=600)
    return done, time.monotonic() - start


def hash_of(folder):
    total = hashlib.sha256()
    for path in sorted(folder.iterdir()):
        total.update(path.name.encode() + b"\0" + path.read_bytes())
    return total.hexdigest()


def ask(case, scratch, tag, more=()):
    """Generate the case's data (with more runs appended) and have it diagnosed: (data folder, result)."""
    data = scratch / tag / case["id"]
    subprocess.run(seal.plant_command(case) + ["--out", str(data), "--label", "none", *more], check=True)
    result = {"data_sha256": hash_of(data)}
    out = scratch / tag / "out"
    command = [workspace.program("joulepath"), "diagnose", str(data / "dataset.yaml"), "--out", str(out)]
    if case["bin"] == "removed":
        command += ["--without", case["effects"][0]]
    done, result["seconds"] = run_quietly(command, scratch)
    result["exit_code"] = done.returncode
    answer = out / "diagnosis.json"
    if done.returncode in (0, 1) and answer.exists():
        full = json.loads(answer.read_text())
        result["diagnosis"] = {key: full[key] for key in KEEP if key in full}
    else:
        result["error"] = done.stderr[-500:]
    return data, result


def described(motion, payload_kg=None):
    """A proposed motion, or a list of them, as the plant's --append wants it; None if it cannot be driven."""
    motions = motion if isinstance(motion, list) else [motion]
    parts = []
    for one in motions:
        if not isinstance(one, dict) or "profile" not in one:
            return None
        plain = {key: value for key, value in one.items() if isinstance(value, (int, float, str))}
        if payload_kg is not None:
            plain.setdefault("payload_kg", payload_kg)
        parts.append(",".join(f"{key}:{value}" for key, value in plain.items()))
    return ";".join(parts)


RANDOM_MOTIONS = ({"profile": "trapezoid", "speed_m_s": 0.4, "distance_m": 4}, {"profile": "spin", "angle_rad": 4.0},
                  {"profile": "arc", "radius_m": 1.0, "angle_rad": 3.0, "speed_m_s": 0.3}, {"profile": "stand", "duration_s": 10},
                  {"profile": "trapezoid", "speed_m_s": 0.3, "distance_m": 3, "direction": "reverse"})


def follow_up(case, scratch, answer):
    """Where a group is left: drive the proposed run, and a random one as control, and ask again."""
    causes = answer.get("causes") or []
    if not causes or not causes[0].get("indistinguishable_from"):
        return None
    proposal = answer.get("next_experiment") or {}
    motions = {"proposed": described(proposal.get("motions") or proposal.get("motion"), proposal.get("payload_kg")),
               "random": described(random.Random(case["seed"]).choice(RANDOM_MOTIONS))}
    return {name: ask(case, scratch, name, ["--append", motion])[1] if motion else None for name, motion in motions.items()}


def diagnose(case, with_controls):
    """Generate, diagnose, remove; everything that the scorer needs, in one dictionary."""
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="blind_"))
    try:
        data, result = ask(case, scratch, "data")
        result["id"] = case["id"]
        if case["bin"] != "removed":
            result["follow_up"] = follow_up(case, scratch, result.get("diagnosis") or {})
        if with_controls:
            done, _ = run_quietly([workspace.program("blind_controls"), str(data), str(scratch / "controls.json")], scratch)
            if done.returncode == 0:
                result["controls"] = json.loads((scratch / "controls.json").read_text())
        return result
    finally:
        shutil.rmtree(scratch, ignore_errors=True)


def diagnose_all(frozen, name, counts, limit_s, jobs, with_controls=True):
    """Diagnose what is not done yet, for at most `limit_s` seconds. Returns how many cases are left."""
    manifest = json.loads(workspace.manifest_path(frozen, name).read_text())
    changed = workspace.dirty(frozen)
    if changed:
        sys.exit(f"the tree differs from the frozen commit {frozen[:12]}: {' '.join(changed[:5])}")
    cases = plan.plan(frozen, *workspace.effect_names(), counts)[: manifest["cases"]]
    probe = subprocess.run([workspace.program("joulepath"), "diagnose", "--help"], capture_output=True)
    if probe.returncode != 0:
        sys.exit("this joulepath has no command `diagnose`: build the frozen commit first")
    log = workspace.sealed_folder(frozen, name) / "diagnosed.jsonl"
    done = {json.loads(line)["id"] for line in log.read_text().splitlines()} if log.exists() else set()
    waiting = [case for case in cases if case["id"] not in done]
    deadline = time.monotonic() + limit_s
    with open(log, "a") as file, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        while waiting and time.monotonic() < deadline:
            batch, waiting = waiting[: 4 * jobs], waiting[4 * jobs:]
            for result in pool.map(lambda case: diagnose(case, with_controls), batch):
                file.write(json.dumps(result) + "\n")
            file.flush()
            print(f"\r{len(cases) - len(waiting)}/{len(cases)}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return len(waiting)
