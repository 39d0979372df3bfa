#!/usr/bin/env python3
"""Plans of two programs for machines whose motors, battery, tyres or jerk limit them, as Markdown.

usage: machines.py FOLDER OLD_PROGRAM NEW_PROGRAM NOTE LEGS SEED
The Scout with one limit that binds, and the two heavier robots of scenarios/. Each drives the missions of every floor of
programs.py once for the least energy and once for the least time.
"""
import json
import pathlib
import random
import sys

import programs

ROBOTS = programs.SCENARIOS / "robots"
SCOUT = (ROBOTS / "nomad_super_scout.yaml").read_text()
MISSIONS = 2  # per floor
ROOM_M = 0.9  # about the stops of the heavier robots


def rated(key, value):
    """The Scout with another value of a key that its file has."""
    lines = [f"{line.split(key)[0]}{key}: {value}" if line.strip().startswith(key + ":") else line
             for line in SCOUT.splitlines()]
    return "\n".join(lines) + "\n"


def limited(key, value):
    """The Scout with one limit more."""
    lines = SCOUT.splitlines()
    at = next(k for k, line in enumerate(lines) if line.startswith("limits:"))
    return "\n".join([*lines[: at + 1], f"  {key}: {value}", *lines[at + 1:]]) + "\n"


MACHINES = {
    "current of 0.5 A": rated("max_current_A", 0.5),
    "voltage of 15 V": rated("max_voltage_V", 15.0),
    "traction coefficient of 0.04": rated("traction_coefficient", 0.04),
    "motor power of 6 W": limited("motor_power_W", 6),
    "battery power of 20 W": limited("battery_power_W", 20),
    "wheel acceleration of 3 rad/s^2": limited("wheel_acceleration_rad_s2", 3),
    "jerk of 0.6 m/s^3": limited("jerk_m_s3", 0.6),
    "AMR of 150 kg": (ROBOTS / "amr_150kg.yaml").read_text(),
    "tug of 600 kg": (ROBOTS / "tug_600kg.yaml").read_text(),
}


def plan(program, folder, name, mission):
    """Energy (J), duration (s) and CPU time (s); none where the program finds no plan."""
    try:
        energy_J, spent_s = programs.plan(program, folder, name, mission)
    except (KeyError, FileNotFoundError):
        return None
    return energy_J, json.loads((folder / f"{name}.json").read_text())["duration_s"], spent_s


def compare(folder, old, new, legs, seed):
    """Per machine and goal the pairs (before, after), and the number of missions without a pair."""
    for machine, text in MACHINES.items():
        draw = random.Random(seed)
        programs.ROOM_M = ROOM_M if "kg" in machine else 0.45
        robot = folder / "robot.yaml"
        robot.write_text(text)
        for goal in ("energy", "time"):
            pairs, missing = [], 0
            for floor in (programs.hall(folder, draw), programs.warehouse(), programs.depot()):
                for k in range(MISSIONS):
                    mission = programs.mission_on(floor, draw, 10, k % 2 == 1, legs)
                    mission |= {"robot": str(robot), "objective": {"minimize": goal}}
                    before, after = (plan(program, folder, f"{name}_{goal}_{k}", mission)
                                     for name, program in (("old", old), ("new", new)))
                    if before and after and before[0] and after[0]:
                        pairs.append((before, after))
                    else:
                        missing += 1
                    print(machine, goal, floor.name, before, after, file=sys.stderr)
            yield machine, goal, pairs, missing


def main():
    folder, old, new, note = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:5]
    legs, seed = map(int, sys.argv[5:])
    folder.mkdir(parents=True, exist_ok=True)
    print(f"# Plans for machines that other limits bind\n\n{note}\n")
    print(f"Missions of {legs} legs of 2 to 14 m with 10 kg on the three floors of ways_programs.md; every second one names the "
          "headings at its stops. The change is that of the energy, or of the time where the plan minimizes it.\n")
    print("| machine | minimized | missions | without a plan of both | change, mean | best | worst | CPU before | CPU after |")
    print("|---|---|---|---|---|---|---|---|---|")
    for machine, goal, pairs, missing in compare(folder, old, new, legs, seed):
        of = 0 if goal == "energy" else 1
        changes = [100 * (after[of] / before[of] - 1) for before, after in pairs] or [float("nan")]
        seconds = [sum(pair[k][2] for pair in pairs) for k in (0, 1)]
        print(f"| {machine} | {goal} | {len(pairs)} | {missing} | {sum(changes) / len(changes):+.2f} % | {min(changes):+.2f} % | "
              f"{max(changes):+.2f} % | {seconds[0]:.1f} s | {seconds[1]:.1f} s |", flush=True)


if __name__ == "__main__":
    main()
