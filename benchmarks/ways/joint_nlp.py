#!/usr/bin/env python3
"""Plans of one leg and of two against curves of another family, found by CasADi [Andersson2019], as Markdown.

usage: joint_nlp.py search ROBOT KIND FIRST LAST          -> rows of joint_nlp_reference.csv (with CasADi)
       joint_nlp.py compare FOLDER PROGRAM NOTE           -> the Markdown (with numpy)

The reference's curve and speed are one nonlinear program (joint_program.py) from at least eight first drives
(joint_guesses.py). The program under test plans the same legs on an empty floor, and drives the reference's
curve as a given path: both energies are then its own.
"""

import csv
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

import numpy as np
import yaml

from joint_program import drive_energy, read_robot
from joint_search import ARC_PARTS, FINE_PARTS, Search

HERE = pathlib.Path(__file__).resolve().parent
ROBOTS = HERE.parents[1] / "scenarios/robots"
REFERENCE, CURVES = HERE / "joint_nlp_reference.csv", HERE / "joint_nlp_curves.csv"
KINDS = ("open", "corner", "two_legs")
SEED = 20261130
ROBOT_NAMES = ("nomad_super_scout", "amr_150kg")
LEFT_OUT = ("jerk_m_s3", "reverse_speed_m_s")  # of the robot files' limits: the program has no such rows
PLANNERS_SHARPEST = math.tan(1.45)  # half track * curvature: the bound of the planner's search
SHARPEST = 20.0  # of the reference: an arc of 8 mm for the Nomad
FREE = 1e3  # as good as a turn in place
DEARER_PERCENT = 0.5  # such legs are listed
POSE_STEPS_M = (0.005, 0.02)  # of poses that the program follows; wheels that turn on the spot count
NUMBERS = (
    "start_x_m",
    "start_y_m",
    "start_heading_rad",
    "stop_x_m",
    "stop_y_m",
    "goal_x_m",
    "goal_y_m",
    "goal_heading_rad",
    "arc_J",
    "planners_bound_J",
    "reference_J",
    "free_J",
    "starts",
    "basins",
)


def heading(draw):
    return round(draw.uniform(-math.pi, math.pi), 4)


def away(draw, place, least_m, most_m):
    """A place so far away; the distances are spread evenly over their logarithm."""
    reach_m, bearing = math.exp(draw.uniform(math.log(least_m), math.log(most_m))), draw.uniform(
        -math.pi, math.pi
    )
    return round(place[0] + reach_m * math.cos(bearing), 4), round(place[1] + reach_m * math.sin(bearing), 4)


def wrapped(angle_rad):
    return (angle_rad + math.pi) % (2 * math.pi) - math.pi


def drawn(kind, index):
    """Poses of a leg, in m and rad: start, goal, and of two legs the stop between."""
    draw = random.Random(f"{SEED} {kind} {index}")
    start = (round(draw.uniform(-5, 5), 4), round(draw.uniform(-5, 5), 4), heading(draw))
    if kind == "two_legs":
        stop = away(draw, start, 1, 6)
        return start, (*away(draw, stop, 1, 6), heading(draw)), stop
    goal = away(draw, start, *((0.3, 2) if kind == "corner" else (1, 10)))
    turned = heading(draw)
    while kind == "corner" and abs(wrapped(turned - start[2])) < math.radians(135):
        turned = heading(draw)
    return start, (*goal, turned), None


def robot_file(folder, name):
    """The shipped robot without the limits that the reference does not have."""
    data = yaml.safe_load((ROBOTS / f"{name}.yaml").read_text())
    for key in LEFT_OUT:
        data["limits"].pop(key, None)
    file = folder / f"{name}.yaml"
    file.write_text(yaml.safe_dump(data, sort_keys=False))
    return file


def search(name, kind, first, last):
    """Adds the reference's drives of some legs to the data."""
    robot = read_robot(robot_file(pathlib.Path(tempfile.mkdtemp()), name))
    seeker = Search(robot, SHARPEST, 2 if kind == "two_legs" else 1)
    for index in range(first, last + 1):
        start, goal, stop = drawn(kind, index)
        arc_J = math.nan
        if stop:
            best, starts, basins = seeker.two_legs(start, stop, goal)
        else:
            best, arc_J, starts, basins = seeker.leg(start, goal)
        other_J = [seeker.again(best, bound) for bound in (PLANNERS_SHARPEST, FREE)]
        place = [*start, *(stop or (math.nan, math.nan)), *goal]
        keep(name, kind, index, [*place, arc_J, other_J[0], best[0], other_J[1], starts, basins], best[1])
        print(
            name,
            kind,
            index,
            f"{best[0]:.4f} J, over arc length {arc_J:.3f}, bounds {other_J}",
            starts,
            basins,
            file=sys.stderr,
            flush=True,
        )
    print(
        f"{seeker.solves} solves, {seeker.failed} without an answer; over arc length {seeker.arc_solves}, "
        f"{seeker.arc_failed}",
        file=sys.stderr,
    )


def rows_of(file):
    return list(csv.DictReader(file.open())) if file.exists() else []


def keep(name, kind, index, numbers, drives):
    """Replaces a leg's row and its curves: speeds (m/s) and yaw rates (rad/s) at equal times."""
    key = {"robot": name, "kind": kind, "index": str(index)}
    merge(REFERENCE, key, [{**key, **dict(zip(NUMBERS, (f"{number:.9g}" for number in numbers)))}])
    join = lambda values: " ".join(f"{value:.6f}".rstrip("0").rstrip(".") for value in values)
    merge(
        CURVES,
        key,
        [
            {
                **key,
                "leg": str(leg),
                "seconds": f"{drive.t[-1]:.9g}",
                "start_heading_rad": f"{drive.heading[0]:.9g}",
                "speeds_m_s": join(drive.speed),
                "yaw_rates_rad_s": join(drive.yaw_rate),
            }
            for leg, drive in enumerate(drives)
        ],
    )


def merge(file, key, rows):
    same = lambda row: all(row[name] == value for name, value in key.items())
    rows = [row for row in rows_of(file) if not same(row)] + rows
    rows.sort(
        key=lambda row: (
            ROBOT_NAMES.index(row["robot"]),
            KINDS.index(row["kind"]),
            int(row["index"]),
            row.get("leg", ""),
        )
    )
    with file.open("w", newline="") as out:
        writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def poses_of(start, curve, half_track_m, step_m):
    """x, y (m), heading (rad) along a curve of the data; the wheels roll `step_m` (m) between them."""
    speed, yaw = (np.array(curve[key].split(), float) for key in ("speeds_m_s", "yaw_rates_rad_s"))
    ends, seconds, fine = np.linspace(0, 1, len(speed)), float(curve["seconds"]), 8
    t = np.linspace(0, 1, fine * (len(speed) - 1) + 1)
    dt, v, w = seconds / (len(t) - 1), np.interp(t, ends, speed), np.interp(t, ends, yaw)
    total = lambda parts: np.concatenate([[0], np.cumsum(parts)])
    turn = float(curve["start_heading_rad"]) + total(dt * (w[1:] + w[:-1]) / 2)
    node, weight = np.polynomial.legendre.leggauss(5)
    share = (1 + node) / 2
    at = turn[:-1, None] + dt * (w[:-1, None] * share + np.diff(w)[:, None] * share**2 / 2)
    rate = (v[:-1, None] + np.diff(v)[:, None] * share) * weight / 2 * dt
    x, y = start[0] + total((rate * np.cos(at)).sum(1)), start[1] + total((rate * np.sin(at)).sum(1))
    rolled = total(dt * np.hypot((v[1:] + v[:-1]) / 2, half_track_m * (w[1:] + w[:-1]) / 2))
    kept = np.unique(np.searchsorted(rolled, np.arange(0, rolled[-1], step_m)).tolist() + [len(t) - 1])
    return np.stack([x, y, turn])[:, kept].T


def planned(program, folder, arguments):
    """plan.json, or an empty plan with the program's words."""
    run = subprocess.run(
        [
            program,
            "plan",
            *arguments,
            "--out",
            folder / "out",
            "--force",
            "--json",
            "--without",
            "baselines,path_bound",
        ],
        check=False,
        capture_output=True,
        text=True,
    )
    try:
        return json.loads(run.stdout)
    except json.JSONDecodeError:
        return {"words": run.stderr.strip()}


def last_pose(folder):
    with open(folder / "out/trajectory.csv") as file:
        row = list(csv.DictReader(line for line in file if not line.startswith("#")))[-1]
    return [float(row[key]) for key in ("position_x_m", "position_y_m", "heading_rad")]


def floor(folder):
    """An empty floor of 60 x 60 m about the origin."""
    (folder / "floor.pgm").write_bytes(b"P5\n600 600\n255\n" + b"\xfe" * 360000)
    (folder / "floor.yaml").write_text(
        "image: floor.pgm\nmode: trinary\nresolution: 0.1\norigin: [-30, -30, 0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
    )


def own_plan(program, folder, robot, row, stop_heading=None):
    """The program's plan of a leg, or of two through the stop."""
    at = lambda name: {
        key: float(row[f"{name}_{key}"]) for key in ("x_m", "y_m", "heading_rad") if f"{name}_{key}" in row
    }
    stations = {"start": at("start"), "goal": at("goal")}
    legs = [{"to": "goal"}]
    if row["kind"] == "two_legs":
        stations["stop"] = {**at("stop"), **({} if stop_heading is None else {"heading_rad": stop_heading})}
        legs.insert(0, {"to": "stop"})
    mission = {
        "schema": "joulepath/mission/1",
        "robot": str(robot),
        "map": "floor.yaml",
        "stations": stations,
        "start": {"station": "start"},
        "legs": legs,
    }
    (folder / "mission.json").write_text(json.dumps(mission))
    return planned(program, folder, [folder / "mission.json"])


def driven_J(program, folder, robot, row, curve, half_track_m):
    """Least energy (J) with which the program drives the reference's curve, if it arrives; else infinity."""
    best_J = math.inf
    for step_m in POSE_STEPS_M:
        poses = poses_of([float(row["start_x_m"]), float(row["start_y_m"])], curve, half_track_m, step_m)
        file = folder / f"curve_{step_m}.csv"
        file.write_text(
            "x_m,y_m,heading_rad\n" + "".join(",".join(map(repr, map(float, pose))) + "\n" for pose in poses)
        )
        plan = planned(program, folder, [file, "--robot", robot])
        if plan.get("energy_J") and arrives(last_pose(folder), row):
            best_J = min(best_J, plan["energy_J"])
    return best_J


def arrives(pose, row):
    goal = [float(row[f"goal_{key}"]) for key in ("x_m", "y_m", "heading_rad")]
    return math.dist(pose[:2], goal[:2]) < 2e-4 and abs(wrapped(pose[2] - goal[2])) < 2e-3


def quantile(values, share):
    return sorted(values)[min(len(values) - 1, int(share * len(values)))]


def measured(program, folder, row, curves):
    """One leg's energies (J): the plan's, the program's along the reference's curve, the reference's own."""
    robot = robot_file(folder, row["robot"])
    half_track_m = yaml.safe_load(robot.read_text())["geometry"]["half_track_m"]
    plan_J = own_plan(program, folder, robot, row).get("energy_J") or math.inf
    model_J = model_energy_J(folder, robot)
    curve = curves[row["robot"], row["kind"], row["index"]]
    if row["kind"] == "two_legs":
        between = float(curve[1]["start_heading_rad"])
        other_J = own_plan(program, folder, robot, row, wrapped(between)).get("energy_J") or math.inf
    else:
        other_J = driven_J(program, folder, robot, row, curve[0], half_track_m)
    own_J = {name: float(row[f"{name}_J"]) for name in ("arc", "planners_bound", "reference", "free")}
    return {"row": row, "plan_J": plan_J, "model_J": model_J, "driven_J": other_J, "own_J": own_J}


def model_energy_J(folder, robot):
    """Energy (J) by the reference's model of the curve and speeds of the plan in `folder`."""
    with open(folder / "out/profile.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    column = lambda key: np.array([float(row[key]) for row in rows])
    s = column("arc_length_m")
    apart = np.concatenate([[True], np.diff(s) > 0])
    robot = read_robot(robot)
    u = robot.half_track_m * column("curvature_per_m")
    return drive_energy(robot, s[apart], u[apart], column("linear_speed_m_s")[apart] ** 2)[0]


def percent(a, b):
    return 100 * (a / b - 1)


def table_row(name, cases):
    """Excess of the plans in three ways, and what stands beside it."""
    shown = [name, str(len(cases))]
    for excess in (
        [percent(c["plan_J"], min(c["plan_J"], c["driven_J"])) for c in cases],
        [percent(c["plan_J"], c["own_J"]["planners_bound"]) for c in cases],
        [percent(c["plan_J"], c["own_J"]["reference"]) for c in cases],
        [percent(c["plan_J"], c["own_J"]["free"]) for c in cases],
    ):
        shown.append(
            ", ".join(
                f"{value:.2f}" for value in (statistics.median(excess), quantile(excess, 0.95), max(excess))
            )
        )
    return "| " + " | ".join(shown) + " |"


def compare(folder, program, note):
    folder.mkdir(parents=True, exist_ok=True)
    floor(folder)
    curves = {}
    for curve in rows_of(CURVES):
        curves.setdefault((curve["robot"], curve["kind"], curve["index"]), []).append(curve)
    cases = []
    for row in rows_of(REFERENCE):
        cases.append(measured(program, folder, row, curves))
        case = cases[-1]
        print(
            row["robot"],
            row["kind"],
            row["index"],
            f"plan {case['plan_J']:.4f} driven {case['driven_J']:.4f}",
            case["own_J"],
            file=sys.stderr,
            flush=True,
        )
    print(report(cases, note))


INTRODUCTION = """\
The reference's curve and speed come from CasADi and Ipopt. The first program is over arc length (heading,
curvature, squared speed, length; {arc} parts) and begins at eight or more drives. The second one is over
time (speed and yaw rate linear on {fine} parts) and begins at the answers of the first. Neither shares code
or unknowns with the planner. Legs of kind `open` are 1 to 10 m long with any headings. Legs of kind
`corner` are 0.3 to 2 m long and turn by 135 degrees or more. Kind `two_legs` has a free heading at the
stop; its reference has the program over time alone. The floor is empty, time is free. Limits of jerk and
driving backward are left out, and the reference has no rows for limits of motors and tires.

`driven`: the program under test drives the reference's curve as a given path (of two legs: it plans with
the reference's heading at the stop). Both energies are then the program's own, and the excess is over the
cheaper one. The other columns compare with the reference's own figure, whose curves have a bound of
curvature: that of the planner's search (a direction of 1.45 rad; its polish has 1.52), {sharpest:g} over half
the track, or none (a start may turn in place). Each cell has the median, the 95 % quantile and the maximum, in %."""


def report(cases, note):
    groups = {}
    for case in cases:
        groups.setdefault((case["row"]["robot"], case["row"]["kind"]), []).append(case)
    single = [case for case in cases if case["row"]["kind"] != "two_legs"]
    lines = [
        "# Plans against a nonlinear program of another family",
        "",
        note,
        "",
        INTRODUCTION.format(arc=ARC_PARTS, fine=FINE_PARTS, sharpest=SHARPEST),
        "",
        "| legs | number | over the cheaper of plan and `driven` | over the reference, planner's bound "
        "| over the reference "
        "| over the reference without a bound |",
        "|---|---|---|---|---|---|",
    ]
    lines += [table_row(" ".join(name), group) for name, group in groups.items()]
    lines += [
        "",
        agreement(single),
        "",
        "## Legs where the plan is dearer than `driven` by more than " f"{DEARER_PERCENT} %",
        "",
        *dearer(cases),
    ]
    return "\n".join(lines)


def agreement(cases):
    """How far the program's energies of the reference's curves are from the reference's own."""
    own = [percent(c["driven_J"], c["own_J"]["reference"]) for c in cases if math.isfinite(c["driven_J"])]
    same = [percent(c["model_J"], c["plan_J"]) for c in cases]
    arc = [percent(c["own_J"]["arc"], c["own_J"]["reference"]) for c in cases]
    return (
        f"The reference's model takes {statistics.median(same):.4f} % more than the program says for the "
        "curves "
        f"and speeds of its own plans (median; {min(same):.4f} to {max(same):.4f} %). The program drives the "
        f"reference's curves for {statistics.median(own):.3f} % more than the reference says (median; "
        f"{min(own):.3f} to {max(own):.3f} %): its fit of the poses and its own speeds. "
        f"It does not drive {len(cases) - len(own)} of {len(cases)} curves to the goal. "
        f"The coarse program over arc "
        f"length is {statistics.median(arc):.2f} % above the one over time (median)."
    )


def dearer(cases):
    rows = [
        (percent(c["plan_J"], c["driven_J"]), c)
        for c in cases
        if percent(c["plan_J"], c["driven_J"]) > DEARER_PERCENT
    ]
    rows.sort(key=lambda row: -row[0])
    shown = [
        f"| {c['row']['robot']} | {c['row']['kind']} {c['row']['index']} | {c['plan_J']:.3f} "
        f"| {c['driven_J']:.3f} | {excess:.2f} % "
        f"| {c['own_J']['planners_bound']:.3f} | {c['own_J']['reference']:.3f} |"
        for excess, c in rows
    ]
    head = [
        "| robot | leg | plan, J | `driven`, J | excess | reference with the planner's bound, J "
        "| reference, J |",
        "|---|---|---|---|---|---|---|",
    ]
    return [*head, *shown] if shown else ["None."]


def main():
    if sys.argv[1] == "search":
        search(*sys.argv[2:4], *map(int, sys.argv[4:6]))
    else:
        compare(pathlib.Path(sys.argv[2]).resolve(), sys.argv[3], sys.argv[4])


if __name__ == "__main__":
    main()
