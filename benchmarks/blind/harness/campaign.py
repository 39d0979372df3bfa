"""Diagnose the cases of a sealed campaign, in chunks that can be interrupted: each finished case is one line of
diagnosed.jsonl, written as soon as it is there."""
import concurrent.futures
import json
import subprocess
import sys
import time

import plan
import workspace
from examine import examine


def done_cases(log):
    """The finished cases; a line that an interruption cut is taken out of the file and done again."""
    if not log.exists():
        return {}
    found, whole = {}, []
    for line in log.read_text().splitlines():
        try:
            entry = json.loads(line)
        except ValueError:
            continue
        found[entry["id"]] = entry
        whole.append(line)
    text = "".join(line + "\n" for line in whole)
    if text != log.read_text():
        temporary = log.with_suffix(".tmp")
        temporary.write_text(text)
        temporary.replace(log)
    return found


def planned_cases(frozen, name):
    manifest = json.loads(workspace.manifest_path(frozen, name).read_text())
    return plan.campaign(name, frozen)[: manifest["cases"]]


def refuse_what_cannot_count(frozen):
    changed = workspace.dirty(frozen)
    if changed:
        sys.exit(f"the tree differs from the frozen commit {frozen[:12]}: {' '.join(changed[:5])}")
    probe = subprocess.run([workspace.program("joulepath"), "diagnose", "--help"], capture_output=True, text=True)
    if probe.returncode != 0 or "--without" not in probe.stdout:
        sys.exit("this joulepath cannot `diagnose --without NAME`: build the frozen commit first")


def diagnose_all(frozen, name, limit_s, jobs):
    """Diagnose what is not done yet, for about `limit_s` seconds. Returns how many cases are left."""
    refuse_what_cannot_count(frozen)
    cases = planned_cases(frozen, name)
    log = workspace.sealed_folder(frozen, name) / "diagnosed.jsonl"
    done = done_cases(log)
    waiting = [case for case in cases if case["id"] not in done]
    deadline, start, finished = time.monotonic() + limit_s, time.monotonic(), 0
    with open(log, "a") as file, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = set()
        while running or (waiting and time.monotonic() < deadline):
            while waiting and len(running) < jobs and time.monotonic() < deadline:
                running.add(pool.submit(examine, waiting.pop(0)))
            ready, running = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in ready:
                file.write(json.dumps(future.result()) + "\n")
                file.flush()
                finished += 1
            left = len(waiting) + len(running)
            rest_min = left * (time.monotonic() - start) / max(1, finished) / 60
            print(f"\r{len(cases) - left}/{len(cases)}, about {rest_min:.0f} min left ", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return len(waiting)
