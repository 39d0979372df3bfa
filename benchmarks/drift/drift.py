#!/usr/bin/env python3
"""`joulepath drift` on simulated days: false alarms on days without drift, delay for slowly growing friction.

  drift.py PROGRAM SERIES [FIRST_SEED]

A day is twelve short drives in the program's own simulator with the noise of typical sensors. The first day of
a series is the calibrated one. Prints a table in Markdown.
"""
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROBOT = ROOT / "scenarios/robots/nomad_super_scout.yaml"
DAYS = 30
FRICTION_NM = 0.5 * (0.3728 + 0.346)  # of the robot file, mean of the wheels
NULL_NIGHTS = (1, 2, 5, 10, 20, 30)
RATE = 0.01


def motions():
    for speed in (0.3, 0.6, 0.9):
        for payload in (0, 8):
            yield {"profile": "trapezoid", "speed_m_s": speed, "acceleration_m_s2": 0.4, "distance_m": 8}, payload
    for rate in (0.8, 1.5):
        for sign in (1, -1):
            yield {"profile": "spin", "yaw_rate_rad_s": rate, "angle_rad": sign * 12}, 0
    for sign in (1, -1):
        yield {"profile": "arc", "radius_m": 1.5, "angle_rad": sign * 5, "speed_m_s": 0.5}, 4


def write_missions(folder):
    files = []
    for k, (motion, payload) in enumerate(motions()):
        file = folder / f"mission_{k:02}.yaml"
        leg = {"motion": motion, "payload_kg": payload}
        file.write_text(json.dumps({"schema": "joulepath/mission/1", "robot": str(ROBOT), "legs": [leg]}))
        files.append(str(file))
    return files


def drive_day(program, missions, folder, seed, added_nm):
    effect = [] if added_nm == 0 else ["--effect", f"coulomb_friction:torque_Nm={added_nm:.9f}"]
    subprocess.run([program, "simulate", *missions, "--out", folder, "--seed", str(seed), "--quiet", *effect],
                   check=True, stdout=subprocess.DEVNULL)
    return str(pathlib.Path(folder) / "dataset.yaml")


def drift(program, days):
    result = subprocess.run([program, "drift", *days, "--json", "--false-alarm-rate", str(RATE)],
                            capture_output=True, text=True)
    if result.returncode not in (0, 1):
        raise RuntimeError(result.stderr)
    answer = json.loads(result.stdout)
    if bool(answer["drifted"]) != (result.returncode == 1):
        raise RuntimeError("the exit code contradicts the answer")
    return answer


def series(program, missions, folder, seed, growth):
    """The days of one series: friction grows by `growth` until the last day."""
    return [drive_day(program, missions, f"{folder}/day_{seed}_{day}_{growth}", 1000 * seed + day,
                      growth * FRICTION_NM * day / DAYS) for day in range(DAYS + 1)]


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def main():
    program, count = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    nights = alarms = 0
    delays, wrong, missed = [], 0, 0
    detectable = []
    with tempfile.TemporaryDirectory() as folder:
        missions = write_missions(pathlib.Path(folder))
        for seed in range(first, first + count):
            days = series(program, missions, folder, seed, 0.0)
            for night in NULL_NIGHTS:
                nights += 1
                alarms += bool(drift(program, days[: night + 1])["drifted"])
            days = series(program, missions, folder, 500 + seed, 0.1)
            for night in range(1, DAYS + 1):
                answer = drift(program, days[: night + 1])
                if answer["drifted"]:
                    delays.append(night)
                    wrong += not any(name.startswith("friction_torque") for name in answer["drifted"])
                    detectable.append(next(p["detectable_percent"] for p in answer["parameters"]
                                           if p["name"] == "friction_torque_left_Nm"))
                    break
            else:
                missed += 1
            print(f"{seed - first + 1} of {count}", file=sys.stderr)
    cpu = resource.getrusage(resource.RUSAGE_CHILDREN)
    print("| days | measured |\n|---|---|")
    print(f"| without drift: nights that end with 1 (rate asked for: {100 * RATE:g} %) | {alarms} of {nights} |")
    print(f"| dry friction +10 % in {DAYS} days: found in | {len(delays)} of {len(delays) + missed} series |")
    if delays:
        print(f"| night on which it is found: median, 90 %, worst | {quantile(delays, 0.5)}, "
              f"{quantile(delays, 0.9)}, {max(delays)} |")
        print(f"| friction by then, median | +{10 * quantile(delays, 0.5) / DAYS:.1f} % |")
        print(f"| named without the friction | {wrong} of {len(delays)} |")
        print(f"| smallest step that the command promises to find then, median | {quantile(detectable, 0.5):.2f} % |")
    print(f"\nCPU time of all simulations and calls: {cpu.ru_utime + cpu.ru_stime:.0f} s.")


if __name__ == "__main__":
    main()
