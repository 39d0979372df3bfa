#!/usr/bin/env python3
"""The planner as WebAssembly against the program: random problems, the same answers.

usage: wasm_test.py JOULEPATH FOLDER_OF_STUDIO_CORE [COUNT]

Exit code 77 (skipped in CTest) where the build has no WebAssembly or node is absent, unless JOULEPATH_STUDIO_WASM=ON.
Design: docs/decisions/0702-studio-and-reports.md
"""
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

from studio_page import Served, write_mission

COUNT = 40
TOLERANCE = 1e-6


def problem(numbers, robot):
    """A leg along one or two random curves, with payload, limits and a time."""
    robot = json.loads(json.dumps(robot))
    limits = robot["limits"]
    for key in ("speed_m_s", "acceleration_m_s2", "deceleration_m_s2", "lateral_acceleration_m_s2", "yaw_rate_rad_s", "yaw_acceleration_rad_s2"):
        limits[key] *= numbers.uniform(0.5, 1.5)
    limits.pop("by_payload", None)
    if numbers.random() < 0.15:
        limits["jerk_m_s3"] = numbers.uniform(0.5, 3)
    robot["power"]["standby_W"] = numbers.choice([0.5, 10, 40])
    robot["power"]["regeneration_efficiency"] = numbers.choice([0, 0.6, 1])
    reach = numbers.uniform(1, 8)
    turn = numbers.uniform(-2.2, 2.2)
    end = [reach * math.cos(turn / 2), reach * math.sin(turn / 2)]
    back = numbers.uniform(0.3, 0.7) * reach
    curve = [[0, 0], [numbers.uniform(0.3, 0.7) * reach, 0], [end[0] - back * math.cos(turn), end[1] - back * math.sin(turn)], end]
    leg = {"path": {"bezier_m": [curve]}, "payload_kg": numbers.uniform(0, 10)}
    if numbers.random() < 0.6:
        leg["duration_s"] = reach / limits["speed_m_s"] * numbers.uniform(2, 4) + 6
    return {"mode": numbers.choice(["paths", "paths", "draft"]), "samples": 20, "mission": {"robot": "robot.yaml", "legs": [leg]}, "robot": robot}


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    count = int(sys.argv[3]) if len(sys.argv) > 3 else COUNT
    node = shutil.which("node")
    if not node or not (folder / "studio_core.wasm").exists():
        print("no node, or a build without -DJOULEPATH_STUDIO_WASM=ON")
        return 1 if os.environ.get("JOULEPATH_STUDIO_WASM") == "ON" else 77
    with tempfile.TemporaryDirectory() as name:
        served = Served(program, write_mission(name))
        try:
            with_robot = served.files()["robot"]
            numbers = random.Random(19)
            questions = [problem(numbers, with_robot) for _ in range(count)]
            native = [served.post("answer", question) for question in questions]
        finally:
            served.close()
    script = pathlib.Path(__file__).with_name("answer.js")
    run = subprocess.run([node, script, folder], input="".join(json.dumps(q) + "\n" for q in questions), capture_output=True, text=True)
    answers = [json.loads(line) for line in run.stdout.splitlines()]
    assert len(answers) == count, f"{len(answers)} answers; {run.stderr[-500:]}"
    worst, solved = 0.0, 0
    for k, (one, other) in enumerate(zip(native, answers)):
        assert ("error" in one) == ("error" in other), f"problem {k}: {one.get('error')} {other.get('error')}"
        if "error" in one:
            continue
        plans = one["plan"], other["plan"]
        assert plans[0]["status"] == plans[1]["status"], f"problem {k}: {[plan['status'] for plan in plans]}"
        if "energy_J" not in plans[0]:
            continue
        solved += 1
        worst = max(worst, *(abs(plans[0][key] - plans[1][key]) / abs(plans[0][key]) for key in ("energy_J", "duration_s")))
        causes = [plan["energy_by_cause_J"] for plan in plans]
        for key in causes[0]:
            if key != "effects":
                worst = max(worst, abs(causes[0][key] - causes[1][key]) / plans[0]["energy_J"])
        if one["mode"] == "paths" and plans[0]["lower_bound_J"] is not None:
            worst = max(worst, abs(plans[0]["lower_bound_J"] - plans[1]["lower_bound_J"]) / plans[0]["energy_J"])
    print(f"{solved} of {count} problems have a plan; largest difference of energy, time, causes and bound: {worst:.2g} (relative)")
    assert solved > 0.8 * count and worst <= TOLERANCE
    return 0


if __name__ == "__main__":
    sys.exit(main())
