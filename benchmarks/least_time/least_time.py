"""Least times and deadlines of plans against closed forms and toppra -> results/least_time.md

usage: least_time.py --note TEXT [--problems N]

Paths and limits vary those of the public problem set; limits that toppra cannot state (current, voltage) are left out. The
reference is the closed form on straight lines and turns in place, else toppra's time on 2,000 grid points. toppra looks at its grid points
alone: its profile is slowed down until the judge finds every limit kept everywhere.
"""

import argparse
import collections
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "peers"))
import toppra_peer  # noqa: E402
from common import ROOT, bench_peers, judge, problem_set, spread, table  # noqa: E402

SEED, POINTS, SLACK = 20261122, 2000, 1e-6
OF_SPEED = ("speed_m_s", "yaw_rate_rad_s")
OF_ITS_SQUARE = ("acceleration_m_s2", "deceleration_m_s2", "lateral_acceleration_m_s2", "yaw_acceleration_rad_s2", "traction_coefficient")


def random_problems(count):
    random, base = np.random.default_rng(SEED), problem_set()
    for index in range(count):
        problem = dict(base[random.integers(len(base))], id=f"t{index:03}", time={"mode": "least"})
        size = random.uniform(0.75, 1.3) if problem["kind"] != "straight" else random.uniform(0.1, 1)
        path = problem["path"]
        bend = 1 if problem["kind"] == "turn" else size  # a turn's path is its angle, with the sense +-1 for the curvature
        problem["path"] = {"s_m": [s * size for s in path["s_m"]], "curvature_per_m": [k / bend for k in path["curvature_per_m"]]}
        problem["limits"] = {
            key: limit * random.uniform(0.6, 1.1) for key, limit in problem["limits"].items() if key in OF_SPEED + OF_ITS_SQUARE
        }
        yield problem


def closed_form_s(problem):
    """Trapezoid or triangle, of a straight line or of a turn in place; a traction limit that holds has no part in it."""
    limits, length = problem["limits"], problem["path"]["s_m"][-1]
    keys = ("yaw_rate_rad_s", *["yaw_acceleration_rad_s2"] * 2) if problem["kind"] == "turn" else ("speed_m_s", "acceleration_m_s2", "deceleration_m_s2")
    fastest, up, down = (limits[key] for key in keys)
    slope = 1 / up + 1 / down
    v = min(fastest, (2 * length / slope) ** 0.5)
    return length / v + v * slope / 2


def reference(problem):
    """The time to be met, and how much toppra's own time is below it."""
    if problem["kind"] in ("straight", "turn"):
        return closed_form_s(problem), 0.0
    answer = toppra_peer.run(problem, POINTS)["solution"]
    if answer is None:
        return None, None
    result = judge(problem, answer)
    slower = max([1.0] + [result["uses"][key] for key in OF_SPEED if key in result["uses"]])
    slower = max([slower] + [result["uses"][key] ** 0.5 for key in OF_ITS_SQUARE if key in result["uses"]])
    return result["duration_s"] * slower, slower - 1


def in_time(problem, suffix, mode, duration_s):
    return {**problem, "id": problem["id"] + suffix, "time": {"mode": mode, "duration_s": duration_s}}


def campaign(count):
    problems = list(random_problems(count))
    least = bench_peers("plan", problems)
    asked, rows = [], []
    for k, problem in enumerate(problems):
        target_s, short = reference(problem)
        plan = least[problem["id"]]
        if target_s is None or "solution" not in plan:
            rows.append({"problem": problem, "none": "toppra finds none" if target_s is None else plan["message"]})
            continue
        own = judge(problem, plan["solution"])
        row = {"problem": problem, "target_s": target_s, "short": short, "own_s": own["duration_s"], "excess": own["excess"], "bound_s": plan["lower_bound_s"]}
        rows.append(row)
        for suffix, mode in (("a", "at_most"), ("e", "exactly")):
            asked.append(in_time(problem, suffix, mode, target_s * (1 + SLACK)))
        asked.append(in_time(problem, "u", "at_most", row["bound_s"] * (1 - SLACK)))
        asked.append(in_time(problem, "b", "at_most", 0.5 * (row["bound_s"] + row["own_s"])))
        print(k, file=sys.stderr)
    return rows, bench_peers("plan", asked)


def outcome(problem, plan, duration_s):
    """planned (and in time, within all limits), infeasible, failed, or what is wrong."""
    if "solution" not in plan:
        return plan["status"]
    own = judge(in_time(problem, "", "at_most", duration_s), plan["solution"])
    return "planned" if own["excess"] <= 1e-6 else f"breaks {own['limit']} by {own['excess']:.1e}"


def report(rows, plans, note):
    groups, wrong = collections.defaultdict(lambda: collections.defaultdict(list)), []
    for row in rows:
        problem = row["problem"]
        group, name = groups[problem["kind"]], f"{problem['id']} ({problem['robot']}, {problem['kind']})"
        group["number"].append(1)
        if "none" in row:
            group["none"].append(1)
            wrong.append(f"{name}: {row['none']}")
            continue
        group["own"].append(row["own_s"] / row["target_s"] - 1)
        group["bound"].append(1 - row["bound_s"] / row["own_s"])
        group["short"].append(row["short"])
        if row["target_s"] < row["bound_s"] * (1 - 1e-12):
            wrong.append(f"{name}: a drive of {row['target_s']:.9g} s keeps every limit; the bound is {row['bound_s']:.9g} s")
        for suffix, duration_s, accepted in (
            ("a", row["target_s"] * (1 + SLACK), ["planned"]),
            ("e", row["target_s"] * (1 + SLACK), ["planned"]),
            ("u", row["bound_s"] * (1 - SLACK), ["infeasible"]),
            ("b", 0.5 * (row["bound_s"] + row["own_s"]), ["planned", "failed"]),
        ):
            plan = plans[problem["id"] + suffix]
            result = outcome(problem, plan, duration_s)
            group[suffix].append(result)
            if result not in accepted:
                wrong.append(f"{name}, asked {duration_s:.9g} s, bound {row['bound_s']:.9g} s, reference {row['target_s']:.9g} s: {result}, {plan['message']}")
    cells = []
    for kind, g in groups.items():
        count = lambda suffix, what: f"{g[suffix].count(what)} of {len(g[suffix])}"
        cells.append([kind, len(g["number"]), spread(g["own"], 2), spread(g["bound"], 2), spread(g["short"], 2), count("a", "planned"), count("e", "planned"), count("u", "infeasible"), f"{g['b'].count('planned')}, {g['b'].count('failed')} of {len(g['b'])}"])
    header = ["path", "problems", "least time planned, over the reference", "bound below it", "toppra's own time below the reference", "deadline of the reference: planned", "exactly the reference: planned", "deadline below the bound: refused", "deadline between bound and least time: planned, failed"]
    text = [
        "# Least times and deadlines\n",
        note + "\n",
        f"Seeded random problems: paths and limits vary those of the public problem set (speed, acceleration, lateral, yaw and traction limits; three robots). "
        f"The reference is the closed form on straight lines and turns in place, else toppra's profile on {POINTS:,} grid points, slowed down until `benchmarks/problems/check.py` finds no limit exceeded. "
        f"Deadlines are the reference times (1 + {SLACK:g}), and the proven bound times (1 - {SLACK:g}). Relative figures: median (least to greatest).\n",
        table(header, cells),
        f"Not as claimed: {len(wrong)}.\n",
    ] + [f"- {line}" for line in wrong]
    out = "\n".join(text).rstrip() + "\n"
    (ROOT / "benchmarks/results/least_time.md").write_text(out)
    print(out)
    return len(wrong)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--note", default="")
    parser.add_argument("--problems", type=int, default=500)
    options = parser.parse_args()
    sys.exit(report(*campaign(options.problems), options.note) > 0)
