"""Section on missions between walls: plans on two maps, turns in place included, driven with and without a pose controller."""

import csv
import tempfile
from pathlib import Path as File

import plans
from common import PROBLEMS, package, spread, table
from mujoco_peer import WORLDS, pose_controller, wheels_alone

ROBOTS = ("nomad_super_scout", "amr_150kg", "tug_600kg")
CONTROLS = {"wheels alone": wheels_alone, "pose controller": pose_controller}
CHECKED_EVERY = 5  # periods


def mission_text(robot, payload_kg, row):
    heading = "" if row["goal_heading_rad"] == "nan" else f", heading_rad: {row['goal_heading_rad']}"
    return f"""schema: joulepath/mission/1
robot: {plans.SCENARIOS}/robots/{robot}.yaml
map: {plans.SCENARIOS}/maps/{row['floor']}.yaml
clearance_m: 0.05
stations:
  start: {{x_m: {row['start_x_m']}, y_m: {row['start_y_m']}, heading_rad: {row['start_heading_rad']}}}
  goal: {{x_m: {row['goal_x_m']}, y_m: {row['goal_y_m']}{heading}}}
start: {{station: start}}
legs: [{{to: goal, payload_kg: {payload_kg}}}]
"""


def planned(robot, payload_kg, count, scratch):
    """Plans between the poses of the public set, floor by floor in turn, as far as the robot fits: (floor, folder)."""
    rows = list(csv.DictReader((PROBLEMS / "poses.csv").open()))
    by_floor = [[row for row in rows if row["floor"] == floor] for floor in sorted({row["floor"] for row in rows})]
    rows, found = [row for pair in zip(*by_floor) for row in pair], []
    for i, row in enumerate(rows):
        mission, folder = scratch / f"{robot}_{i}.yaml", scratch / f"{robot}_{i}"
        mission.write_text(mission_text(robot, payload_kg, row))
        if not plans.program("plan", mission, "--out", folder, "--without", "baselines", "--solver", "fast", check=False):
            found.append((row["floor"], folder))
        if len(found) == count:
            break
    return found


def run(size):
    package("mujoco")
    rows, points = [], {name: plans.walls(name) for name in ("warehouse", "depot")}
    touched, turning, total = {name: 0 for name in CONTROLS}, 0, 0
    with tempfile.TemporaryDirectory() as scratch:
        for name in ROBOTS:
            file, robot = plans.robot_file(name), plans.robot_values(name)
            missions = planned(name, 0.5 * file["limits"]["max_payload_kg"], size(20, 2), File(scratch))
            turning += sum(turns(folder) for _, folder in missions)
            for world, changes in WORLDS.items():
                drives = {
                    control: [measured(folder, robot, file, points[floor], guided, changes) for floor, folder in missions]
                    for control, guided in CONTROLS.items()
                }
                rows.append([name, world, len(missions), *cells(drives)])
                total += len(missions)
                for control in CONTROLS:
                    touched[control] += sum(d["gap_m"] <= 0 for d in drives[control])
    text = (
        "Missions between poses of the public set on two maps, planned with 5 cm of clearance for half of the greatest payload, "
        f"{turning} of {total // len(WORLDS)} with a turn in place. Gaps are those between the robot's outline and the occupied cells "
        "of the map, at 20 Hz. Wheels alone: the controller knows the reference speeds of the wheels; errors of the heading add "
        "up along the way. Pose controller: Kanayama's tracking law at 100 Hz with the simulator's pose. "
        "Joules include standby until arrival: on short missions the tenth of a second of delay shows.\n\n"
    )
    text += table(HEADER, rows)
    short = f"**Between walls**, {total} drives of each kind in MuJoCo, touched a wall: " + "; ".join(
        f"{control} {count}" for control, count in touched.items()
    )
    return {"text": f"{text}\n{short}.\n", "summary": {}, "short": short + "."}


HEADER = ["robot", "floor", "missions", "planned gap, least, mm"] + [
    f"{control}: {cell}"
    for control in CONTROLS
    for cell in ("touched a wall", "least gap, mm", "predicted over driven, %", "latest, s")
]


def turns(folder):
    """Whether a plan turns in place."""
    return any((abs(c[:, 3]) < 1e-9) [abs(c[:, 4]) > 1e-3].any() for _, c, _ in plans.legs_of(folder))


def measured(folder, robot, file, points, guided, world):
    drive = plans.drive(folder, robot, file, guided, **world)
    wanted, driven = drive.pop("poses")[0]
    for key, poses in (("planned_gap_m", wanted), ("gap_m", driven)):
        drive[key] = plans.gap_m(poses[::CHECKED_EVERY], file["footprint"], points)
    return drive


def cells(drives):
    found = [f"{1000 * min(d['planned_gap_m'] for own in drives.values() for d in own):.0f}"]
    for own in drives.values():
        found += [
            sum(d["gap_m"] <= 0 for d in own),
            f"{1000 * min(d['gap_m'] for d in own):.0f}",
            spread([100 * (d["planned_J"] / d["energy_J"] - 1) for d in own], 2),
            f"{max(d['late_s'] for d in own):.2f}",
        ]
    return found
