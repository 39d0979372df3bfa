"""Plans of the program on maps: written by `joulepath plan`, driven leg by leg in MuJoCo, measured against the walls."""

import csv
import json
import math
import subprocess

import numpy as np

import mujoco_peer
from common import ROOT, package, problem_set

SCENARIOS = ROOT / "scenarios"
PERIOD_S, SETTLE_S = mujoco_peer.PERIOD_S, mujoco_peer.SETTLE_S
COLUMNS = ("position_x_m", "position_y_m", "heading_rad", "linear_speed_m_s", "angular_speed_rad_s")


def program(*arguments, check=True):
    command = [ROOT / "build/release/bin/joulepath", *map(str, arguments), "--quiet", "--force"]
    return subprocess.run(command, check=check, capture_output=True).returncode


def robot_file(name):
    return package("yaml").safe_load((SCENARIOS / f"robots/{name}.yaml").read_text())


def robot_values(name):
    return next(p["robot_values"] for p in problem_set() if p["robot"] == name)


def legs_of(folder):
    """Per leg of a plan: instants, the columns above, payload."""
    with open(folder / "trajectory.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for leg in range(1 + int(rows[-1]["leg"])):
        own = [row for row in rows if int(row["leg"]) == leg]
        columns = np.array([[float(row[key]) for key in COLUMNS] for row in own])
        yield np.array([float(row["time_s"]) for row in own]), columns, float(own[0]["payload_kg"])


def voltage_use(folder, file):
    """Greatest planned voltage of a motor over its limit."""
    with open(folder / "trajectory.csv", newline="") as rows:
        volts = [abs(float(row[f"motor_voltage_{side}_V"])) for row in csv.DictReader(rows) for side in ("left", "right")]
    return max(volts) / file["motor"]["max_voltage_V"]


def drive(folder, robot, file, guided=mujoco_peer.pose_controller, **world):
    """Joules and lateness of a plan as driven, and the poses of each leg; the robot knows its place at each stop."""
    plan = json.loads((folder / "plan.json").read_text())
    late_s, motors_J, poses = [], 0.0, []
    for times, columns, payload_kg in legs_of(folder):
        moves = np.nonzero(abs(columns[:, 3:]).sum(1) > 1e-9)[0]
        moving_s = times[min(len(times) - 1, moves[-1] + 1)] - times[0]
        at = (np.arange(math.ceil((moving_s + SETTLE_S) / PERIOD_S)) + 1) * PERIOD_S
        wanted = np.stack([np.interp(at, times - times[0], column) for column in columns.T], 1)
        wanted[at > moving_s, 3:] = 0
        guide = guided(wanted[:, :3], wanted[:, 3:])
        watts, driven = mujoco_peer.execute(robot, payload_kg, file["motor"]["max_voltage_V"], wanted[0, :3], len(at), guide, **world)
        late_s.append(mujoco_peer.last_motion(driven[:, :2], at) - mujoco_peer.last_motion(wanted[:, :2], at))
        motors_J += drawn_J(file, watts, moving_s + max(0.0, late_s[-1]))
        poses.append((wanted[:, :3], driven))
    energy_J = motors_J + file["power"]["standby_W"] * (plan["duration_s"] + sum(max(0.0, late) for late in late_s))
    return {"energy_J": energy_J, "planned_J": plan["energy_J"], "late_s": max(late_s), "poses": poses}


def drawn_J(file, watts, until_s):
    """What the motors take from the supply until a time."""
    power = file["power"]
    drawn = mujoco_peer.drawn_W(watts, power["regeneration_efficiency"], power.get("sharing", "wheel"))
    return float(drawn[(np.arange(len(drawn)) + 1) * PERIOD_S <= until_s].sum() * PERIOD_S)


def walls(name):
    """Points on the outlines of the occupied cells that have a neighbor which is not, eight per cell (m)."""
    about = package("yaml").safe_load((SCENARIOS / f"maps/{name}.yaml").read_text())
    head, _, cells = (SCENARIOS / "maps" / about["image"]).read_bytes().partition(b"\n255\n")
    width, height = map(int, [line for line in head.splitlines() if not line.startswith(b"#")][-1].split()[-2:])
    shades = np.frombuffer(cells, np.uint8)[: width * height].reshape(height, width)[::-1]
    occupied = (255 - shades.astype(float)) / 255 > about["occupied_thresh"]
    around = np.pad(occupied, 1, constant_values=True)
    inside = around[2:, 1:-1] & around[:-2, 1:-1] & around[1:-1, 2:] & around[1:-1, :-2]
    rows, columns = np.nonzero(occupied & ~inside)
    ring = np.array([(i, j) for i in (0, 0.5, 1) for j in (0, 0.5, 1) if (i, j) != (0.5, 0.5)])
    corners = np.stack([columns, rows], 1)[:, None] + ring
    return np.array(about["origin"][:2]) + about["resolution"] * corners.reshape(-1, 2)


def gap_m(poses, footprint, points, reach_m=2.0, chunk=20):
    """Least distance of the footprint (a disc, or a box along the robot's axes) to the points; below 0 it covers one."""
    if "polygon_m" in footprint:
        corners = np.array(footprint["polygon_m"])
        low, high, radius = corners.min(0), corners.max(0), 0.0
    else:
        low = high = np.zeros(2)
        radius = footprint["radius_m"]
    middle, half, least = (low + high) / 2, (high - low) / 2, reach_m
    for i in range(0, len(poses), chunk):
        own = poses[i : i + chunk]
        near = points[((points > own[:, :2].min(0) - reach_m) & (points < own[:, :2].max(0) + reach_m)).all(1)]
        for x, y, heading in own:
            c, s = math.cos(heading), math.sin(heading)
            away = abs((near - (x, y)) @ np.array([[c, -s], [s, c]]) - middle) - half
            outside = np.hypot(*np.maximum(away, 0).T) + np.minimum(away.max(1), 0) - radius
            least = min(least, outside.min(initial=reach_m))
    return float(least)
