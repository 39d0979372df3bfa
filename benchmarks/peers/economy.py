"""Sections on joules: estimators of fleets, costs that other planners minimize."""

import numpy as np

import casadi_peer
from common import Path, Reference, bench_peers, judge, mid, problem_set, spread, table

EULER_STEP_S = 0.5


def fleet_estimate_J(problem, solution, whole=True):
    """The simple motion model of fleet managers: E = sum (m |a| v + I |alpha| |omega| + mu m g v) dt, dt = 0.5 s.

    Published with rmf_battery; restated from its formulas. mu is the Coulomb friction of the robot file over its weight.
    Without `whole`, the first term alone. Standby is added to both.
    """
    robot, path, drive = problem["robot_values"], Path(problem), Reference(problem, solution)
    mass = robot["chassis_mass_kg"] + 2 * robot["wheel_mass_kg"] + problem["payload_kg"]
    inertia = robot["chassis_yaw_inertia_kg_m2"] + robot["payload_yaw_inertia_m2"] * problem["payload_kg"]
    friction_N = sum(robot["motor"]["friction_torque_Nm"]) / robot["wheel_radius_m"]
    t = np.arange(0, drive.duration, EULER_STEP_S)
    s, v = drive.at(t)
    omega = v * path.curvature(s)
    a, alpha = (np.gradient(x, EULER_STEP_S) if len(t) > 1 else np.zeros(len(t)) for x in (v, omega))
    watts = mass * abs(a) * v + (inertia * abs(alpha * omega) + friction_N * v if whole else 0)
    return float(watts.sum() * EULER_STEP_S + problem["standby_W"] * drive.duration)


def estimators(size):
    problems = [p for p in problem_set() if p["time"]["mode"] != "least"][: size(90, 12)]
    problems.sort(key=lambda p: p["robot"])  # a mission is driven by one robot
    answers = bench_peers("plan", problems)
    legs = [(p, answers[p["id"]]["solution"]) for p in problems]
    truth = np.array([judge(p, s)["energy_J"] for p, s in legs])
    length = np.array([p["path"]["s_m"][-1] for p, _ in legs])
    robots = [p["robot"] for p, _ in legs]
    per_metre = np.zeros(len(legs))
    for robot in set(robots):  # fitted to these very legs: the best that one constant per robot can do
        own = np.array([r == robot for r in robots])
        per_metre[own] = length[own] * (truth[own] @ length[own]) / (length[own] @ length[own])
    rows, short = [], []
    for name, guess in (
        ("mass × magnitude of acceleration × speed, half-second Euler", np.array([fleet_estimate_J(p, s, False) for p, s in legs])),
        ("rmf_battery's simple model: the same, yaw and friction added", np.array([fleet_estimate_J(p, s) for p, s in legs])),
        ("joules per metre, fitted per robot to these legs", per_metre),
    ):
        leg = 100 * (guess / truth - 1)
        own = [np.array([i for i, r in enumerate(robots) if r == robot]) for robot in dict.fromkeys(robots)]
        groups = [g[i : i + 5] for g in own for i in range(0, len(g) - 4, 5)]
        mission = np.array([100 * (guess[g].sum() / truth[g].sum() - 1) for g in groups])
        short.append(f"{name.split(',')[0].split(':')[0]} {mid(abs(leg))} % on a leg and {mid(abs(mission))} % on a mission")
        rows.append([name, *(cell for x in (leg, mission) for cell in (f"{np.median(x):+.1f}", spread(abs(x), 2)))])
    return {
        "text": f"{len(legs)} legs of least energy, {len(groups)} missions of five legs of one robot; the full model is the "
        "reference, standby is in all.\n\n"
        + table(["estimator", *(f"{of}: {what}" for of in ("leg", "mission") for what in ("median error, %", "absolute error, %"))], rows),
        "summary": {},
        "short": f"**Fleet estimators** err in the median by: {'; '.join(short)}.",
    }


COSTS = {
    "polynomial": "polynomial in speed and acceleration (Mei; Parasuraman): the path's curvature is left out",
    "no load torque": "motor without load torque (Kim and Kim)",
    "squared acceleration": "integral of squared acceleration",
}


def costs(size):
    problems = [
        p
        for k in ("straight", "bend", "corners", "tight_corners")
        for p in problem_set()
        if p["kind"] == k and p["time"]["mode"] == "at_most"
    ][:]
    problems = [p for i, p in enumerate(problems) if sum(q["kind"] == p["kind"] for q in problems[:i]) < size(6, 1)]
    lost = {name: {} for name in (*COSTS, "least time, then wait")}
    for problem in problems:
        problem = {**problem, "time": {**problem["time"], "mode": "exactly"}}
        T = problem["time"]["duration_s"]
        program = casadi_peer.Program(problem, 200)
        answer, stats = program.solve(T)
        if not stats["success"]:
            continue
        least = judge(problem, program.solution(answer))["energy_J"]
        for name in COSTS:
            other = casadi_peer.Program(problem, 200, cost=name)
            answer, stats = other.solve(T)
            if stats["success"]:
                lost[name].setdefault(problem["kind"], []).append(
                    100 * (judge(problem, other.solution(answer))["energy_J"] / least - 1)
                )
        fastest = bench_peers("plan", [{**problem, "time": {"mode": "least"}}])[problem["id"]]["solution"]
        fastest["wait_s"] = max(0.0, T - judge(problem, fastest)["duration_s"])
        lost["least time, then wait"].setdefault(problem["kind"], []).append(
            100 * (judge(problem, fastest)["energy_J"] / least - 1)
        )
    kinds = ("straight", "bend", "corners", "tight_corners")
    rows = [[COSTS.get(name, name), *(spread(found.get(k, []), 2) for k in kinds)] for name, found in lost.items()]
    text = (
        f"{len(problems)} problems with a deadline, all profiles of one duration: planned with the other cost, paid "
        "with the full model; joules lost in percent of the least energy. "
        "All are solved by CasADi on one grid, so that only the cost differs.\n\n"
        + table(["planned for", *(k.replace("_", " ") for k in kinds)], rows)
    )
    return {
        "text": text,
        "summary": {},
        "energy": (pooled := {f"planned for: {name}": [x for v in found.values() for x in v] for name, found in lost.items()}),
        "short": "**Other planners' costs**, paid with the full model, lose in the median: "
        + "; ".join(f"{name.removeprefix('planned for: ')} {mid(values)} %" for name, values in pooled.items())
        + ".",
    }
