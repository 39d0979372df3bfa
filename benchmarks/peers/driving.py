"""Section on independent execution: optimum, best tuned trapezoid and jerk-limited optimum as MuJoCo drives them."""

import copy
import statistics

import mujoco_peer
from common import bench_peers, judge, mid, package, problem_set, spread, table

JERK_M_S3 = 0.5
CLEARANCE_M = 0.05  # that the planner keeps from walls unless a mission says otherwise
LATE_S = 0.25
NAMES = {
    "optimum": "optimum",
    "trapezoid_best_tuned": "best tuned trapezoid",
    "trapezoid_max_acceleration": "trapezoid at maximum acceleration",
    "jerk": "optimum with jerk limit",
}


def missions(size):
    """For each robot some problems without tight corners, in a time that leaves room for a jerk limit."""
    chosen = {}
    for problem in problem_set():
        own = chosen.setdefault(problem["robot"], [])
        if problem["kind"] != "tight_corners" and problem["time"]["mode"] in ("free", "at_most") and len(own) < size(20, 2):
            own.append(problem)
    found = [copy.deepcopy(p) for own in chosen.values() for p in own]
    for p in found:
        fastest = {**p, "time": {"mode": "least"}}
        p["fastest"] = fastest
    times = bench_peers("plan", [p.pop("fastest") for p in found])
    for p in found:
        least_s = judge(p, times[p["id"]]["solution"])["duration_s"]
        p["time"] = {"mode": "exactly", "duration_s": 1.5 * least_s}
    return found


def run(size):
    package("mujoco")
    problems = missions(size)
    smooth = [copy.deepcopy(p) for p in problems]
    for p in smooth:
        p["limits"]["jerk_m_s3"] = JERK_M_S3
    plans, jerky = bench_peers("baselines", problems), bench_peers("plan", smooth)
    driven = {}  # (robot, world, profile) -> {problem: drive}
    for problem in problems:
        profiles = {name: s for name, s in plans[problem["id"]].items() if name in NAMES}
        if "solution" in jerky[problem["id"]]:
            profiles["jerk"] = jerky[problem["id"]]["solution"]
        for name, solution in profiles.items():
            planned = judge(problem, solution)
            for world, changes in mujoco_peer.WORLDS.items():
                drive = mujoco_peer.drive(problem, solution, **changes)
                drive["error_percent"] = 100 * (planned["energy_J"] / drive["energy_J"] - 1)
                drive["planned_J"] = planned["energy_J"]
                driven.setdefault((problem["robot"], world, name), {})[problem["id"]] = drive
    return report(problems, driven)


def saved(driven, robot, world, other, key):
    """Percent that the optimum saves against another profile, mission by mission."""
    best, rest = driven.get((robot, world, "optimum"), {}), driven.get((robot, world, other), {})
    return [100 * (1 - best[i][key] / rest[i][key]) for i in best if i in rest]


def report(problems, driven):
    robots = list(dict.fromkeys(p["robot"] for p in problems))
    rows, jerk_rows = [], []
    for robot in robots:
        for world in mujoco_peer.WORLDS:
            drives = list(driven[robot, world, "optimum"].values())
            everything = [d for (r, w, _), found in driven.items() if (r, w) == (robot, world) for d in found.values()]
            rows.append(
                [
                    robot,
                    world,
                    len(drives),
                    spread([d["error_percent"] for d in drives], 2),
                    *(
                        f"{spread(saved(driven, robot, world, other, 'planned_J'), 2)} → "
                        f"{spread(saved(driven, robot, world, other, 'energy_J'), 2)}"
                        for other in ("trapezoid_max_acceleration", "trapezoid_best_tuned")
                    ),
                    spread([d["late_s"] for d in drives], 2),
                    sum(d["late_s"] > LATE_S for d in everything),
                    f"{1000 * max(d['off_path_m'] for d in everything):.0f}",
                    sum(d["off_path_m"] > CLEARANCE_M for d in everything),
                ]
            )
            planned, real = (saved(driven, robot, world, "jerk", key) for key in ("planned_J", "energy_J"))
            jerk_rows.append([robot, world, len(real), spread(planned, 2), spread(real, 2), sum(x > 0 for x in real)])
    text = (
        "Missions of equal time, 1.5 times the least time, on straight lines, bends and corners of the problem set. "
        "Predicted joules are the judge's; driven joules are the integral of voltage times current at the motors, "
        "braking counted as the robot file says, plus standby until arrival. The controller knows the reference speeds of "
        "the wheels only: the distance from the path is drift without a pose controller.\n\n"
    )
    text += table(
        [
            "robot",
            "floor",
            "missions",
            "predicted over driven, %",
            "saved against trapezoid at maximum acceleration, %: planned → driven",
            "against best tuned: planned → driven",
            "late, s",
            f"later than {LATE_S} s",
            "farthest from the path, mm",
            f"beyond {1000 * CLEARANCE_M:.0f} mm",
        ],
        rows,
    )
    text += (
        f"\nWithout a jerk limit against one of {JERK_M_S3} m/s³, as driven (the first is cheaper where the figure is "
        "positive):\n\n"
    )
    text += table(
        ["robot", "floor", "missions", "saved as planned, %", "saved as driven, %", "cheaper without, of all"], jerk_rows
    )
    calm = [x for robot in robots for x in saved(driven, robot, "calm", "jerk", "energy_J")]
    cheaper = "without a jerk limit" if calm and statistics.median(calm) > 0 else "with a jerk limit"
    text += (
        f"\nCheaper as driven, in the median on a calm floor: {cheaper} ({spread(calm, 2)} %). The simulated robot has "
        "rigid wheels, no mast and no cargo that sways: what a jerk limit protects is not in these joules.\n"
    )
    survive = {
        NAMES[other]: [x for robot in robots for x in saved(driven, robot, "calm", other, "energy_J")]
        for other in ("trapezoid_max_acceleration", "trapezoid_best_tuned")
    }
    errors = [abs(d["error_percent"]) for (_, w, name), found in driven.items() if (w, name) == ("calm", "optimum") for d in found.values()]
    kept = "; ".join(f"{mid(values)} % against the {name}" for name, values in survive.items())
    short = (
        f"**Driven in MuJoCo** on a level floor the savings survive: {kept}, standby included. Predictions are within {max(errors):.2g} % "
        f"of the driven energy. Cheaper as driven: {cheaper} ({mid(calm)} % in the median)."
    )
    return {"text": text, "summary": {}, "survive": survive, "short": short}
