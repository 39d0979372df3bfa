"""Claimed lower bounds against profiles that keep every limit, found by other means -> results/bounds.md

usage: bounds.py --note TEXT [--problems N] [--nodes N] [--casadi EVERY] [--dp EVERY] [--report-only]

Each problem is planned (bench_bounds). Its bound is then held against: a profile on a fine grid, CasADi + Ipopt, dynamic
programming, a closed form. Such a profile counts where the judge of the public problem set, which shares no code
with the program, finds no limit exceeded by more than 1e-9. What is done is kept in build/bounds_*.jsonl: a run can be stopped at
any time and goes on where it was.
"""

import argparse
import collections
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "peers")]
import dynamic_programming  # noqa: E402
from casadi_peer import Program  # noqa: E402
from common import ROOT, Absent, Path, evaluate, table  # noqa: E402

STRICT, ROUNDING, CHUNK = 1e-9, 1e-12, 8
CASADI_SEGMENTS, ROOMS = 400, (1e-6, 1e-5, 1e-4, 1e-3, 1e-2)


def finished():
    """All lines of all processes."""
    return [json.loads(line) for file in sorted(ROOT.glob("build/bounds_*.jsonl")) for line in file.read_text().splitlines()]


def reversals(problem, path):
    """Where a wheel stands still."""
    places = []
    for k in (1 / problem["robot_values"]["half_track_m"], -1 / problem["robot_values"]["half_track_m"]):
        for i in range(len(path.knots) - 1):
            if (path.bend[i] - k) * (path.bend[i + 1] - k) < 0:
                places.append(path.knots[i] + (k - path.bend[i]) / path.slopes[i])
    return np.array(places)


def judged(problem, solution):
    """Energy, duration and the greatest excess over a limit, by the independent judge."""
    result = evaluate(problem, problem["robot_values"], solution)
    return {"energy_J": float(result["energy_J"]), "duration_s": float(result["duration_s"]), "excess": float(max(result["uses"].values()) - 1)}


def with_room(problem, room):
    return {**problem, "limits": {key: limit * (1 - room) for key, limit in problem["limits"].items()}}


def by_casadi(problem):
    """A CasADi solution within the limits: they are taken a little smaller until nothing exceeds those asked."""
    path = Path(problem)
    nodes = np.concatenate([path.knots, reversals(problem, path), path.length * (0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 60)))])
    asked = problem["time"].get("duration_s")
    for room in ROOMS:
        program = Program(with_room(problem, room), CASADI_SEGMENTS, extra_nodes=nodes)
        answer, stats = program.solve(asked * (1 - 1e-7) if asked and problem["time"]["mode"] == "at_most" else asked)
        if not stats["success"]:
            continue
        solution = program.solution(answer)
        if problem["time"]["mode"] == "exactly":  # to the last digit
            taken = judged(problem, solution)["duration_s"]
            solution["speed_m_s"] = [v * taken / asked for v in solution["speed_m_s"]]
        result = judged(problem, solution)
        if result["excess"] <= STRICT:
            return {**result, "room": room}
    return None


def by_dynamic_programming(problem):
    path = Path(problem)
    for room in ROOMS[1:4]:
        solution = dynamic_programming.solve(problem, path, reversals(problem, path), problem["time"].get("price_W", 0.0), room)
        result = judged(problem, solution) if solution else None
        if result and result["excess"] <= STRICT:
            return {**result, "room": room}
    return None


def closed_form_J(problem):
    """Straight line, all braking recovered, fixed time T: v = V (1 - cosh(k (t - T/2))/cosh(k T/2)).

    Per wheel P = R i^2 + Kv n w i with i = (A a + nu w + Tc)/(Kt n); k^2 is the weight of v^2 over that of a^2.
    """
    robot, T, D = problem["robot_values"], problem["time"]["duration_s"], problem["path"]["s_m"][-1]
    r, pay = robot["wheel_radius_m"], problem["payload_kg"]
    mass, g = robot["chassis_mass_kg"] + 2 * robot["wheel_mass_kg"] + pay, 1 / r
    of_a2 = of_v2 = rest = 0.0
    for side in (0, 1):
        m = {key: value[side] for key, value in robot["motor"].items()}
        copper = m["resistance_ohm"] / (m["torque_constant_Nm_A"] * m["gear_ratio"]) ** 2
        emf, nu, Tc = m["voltage_constant_V_s_rad"] / m["torque_constant_Nm_A"] * g, m["viscous_friction_Nm_s_rad"] * g, m["friction_torque_Nm"]
        inertia = r * mass / 2 + robot["wheel_axle_inertia_kg_m2"] * g
        of_a2 += copper * inertia**2
        of_v2 += copper * nu**2 + emf * nu
        rest += copper * (Tc**2 * T + 2 * nu * Tc * D) + emf * Tc * D
    k = np.sqrt(of_v2 / of_a2)
    x = k * T / 2
    V = D / (T - 2 / k * np.tanh(x))
    square_v = V**2 * (T - 4 / k * np.tanh(x) + (T / 2 + np.sinh(2 * x) / (2 * k)) / np.cosh(x) ** 2)
    square_a = V**2 * k**2 * (np.sinh(2 * x) / (2 * k) - T / 2) / np.cosh(x) ** 2
    return of_a2 * square_a + of_v2 * square_v + rest + problem["standby_W"] * T


def examine(entry, options):
    """One line of the results: the claim, and what other means found."""
    index = entry["index"]
    if "problem" not in entry:
        return {"index": index}
    problem, plan = entry["problem"], entry["plan"]
    jerk, effect = "jerk_m_s3" in problem["limits"], bool(entry["effect"])
    line = {key: plan[key] for key in ("status", "message", "lower_bound_J", "lower_bound_s", "gap", "local", "handed_over", "nodes")}
    line.update(index=index, robot=problem["robot"], kind=problem["kind"], jerk=jerk, effect=entry["effect"], moving=entry["moving_ends"])
    line.update(mode=problem["time"]["mode"], price_W=problem["time"].get("price_W", 0.0), standby_W=problem["standby_W"])
    line.update(eta=problem["regeneration_efficiency"], sharing=problem["sharing"], found={})
    if "profile" not in plan:
        return line
    own = plan["profile"]
    line.update(energy_J=own["energy_J"], duration_s=own["duration_s"], violation=own["violation"])
    if problem["time"]["mode"] == "least":
        return line
    free = {**problem, "limits": {k: v for k, v in problem["limits"].items() if k != "jerk_m_s3"}}
    for name in ("finer", "finer_without_jerk"):
        if "energy_J" not in entry.get(name, {}):
            continue
        finer = entry[name]
        line["found"][name] = {key: finer[key] for key in ("energy_J", "duration_s")} | {"excess": finer["violation"]}
        if not effect and "solution" in finer:
            line["found"][name] = judged(free, finer["solution"])
    if problem["kind"] == "closed form":
        line["found"]["closed form"] = {"energy_J": closed_form_J(problem), "duration_s": problem["time"]["duration_s"], "excess": 0.0}
    if effect or entry["moving_ends"] or problem["kind"] == "closed form":
        return line
    others = {}
    if options.casadi and index % options.casadi in (1, 2, 3, 4):
        others["CasADi"] = by_casadi
    if options.dp and problem["time"]["mode"] in ("free", "price") and index % options.dp < 4:
        others["dynamic programming"] = by_dynamic_programming
    for name, solve in others.items():
        try:
            line["found"][name] = solve(free)
        except (Absent, RuntimeError) as error:
            line["found"][name] = None
            print(index, name, error, file=sys.stderr)
    return line


def run(options):
    done = {line["index"] for line in finished()}
    lane, lanes = map(int, options.lane.split("/"))
    with (ROOT / f"build/bounds_{lane}.jsonl").open("a") as out, tempfile.TemporaryDirectory() as scratch:
        answers = pathlib.Path(scratch) / "answers.json"
        for first in range(0, options.problems, CHUNK):
            if first // CHUNK % lanes != lane or all(first + k in done for k in range(CHUNK)):
                continue
            subprocess.run([ROOT / "build/release/bin/bench_bounds", str(first), str(CHUNK), str(options.nodes), answers], check=True)
            for entry in json.loads(answers.read_text()):
                if entry["index"] not in done:
                    out.write(json.dumps(examine(entry, options)) + "\n")
            out.flush()


def value_J(line, other):
    """The other profile's cost, comparable with the bound: with a price of time, in the plan's time."""
    return other["energy_J"] + line["price_W"] * (other["duration_s"] - line["duration_s"])


def group_of(line):
    if line["kind"] == "closed form":
        return "closed form"
    if line["jerk"]:
        return "jerk limit, " + line["kind"]
    if line["effect"]:
        return "with an effect"
    return ("with" if line["standby_W"] > 0 else "without") + " standby, " + line["kind"]


def spread(values):
    if not values:
        return "–"
    return ", ".join(f"{np.quantile(values, q):.1e}" for q in (0.5, 0.95, 1))


def report(options):
    lines = finished()
    groups, means, broken = collections.defaultdict(lambda: collections.defaultdict(list)), collections.defaultdict(collections.Counter), []
    least, unsolved, no_problem, handed_over = 0, [], 0, []
    for line in sorted(lines, key=lambda line: line["index"]):
        if "kind" not in line:
            no_problem += 1
            continue
        if line["handed_over"]:
            handed_over.append(line)
        if "energy_J" not in line:
            unsolved.append(line)
            continue
        if line["mode"] == "least":
            least += 1
            continue
        for group in (groups[group_of(line)], groups["all without a jerk limit" if not line["jerk"] else "all with a jerk limit"]):
            group["gap"].append(line["gap"])
            group["status"].append("local" if line["local"] else line["status"])
        best = np.inf
        for name, other in line["found"].items():
            means[name]["tried"] += 1
            if other is None or not other["excess"] <= STRICT:
                means[name]["not strict"] += 1
                continue
            means[name]["strict"] += 1
            value, bound = value_J(line, other), line["lower_bound_J"]
            if name != "finer_without_jerk":
                best = min(best, value)
            if bound is not None and value < bound - ROUNDING * abs(bound):
                means[name]["below"] += 1
                broken.append((line, name, value))
        if np.isfinite(best):
            for group in (groups[group_of(line)], groups["all without a jerk limit" if not line["jerk"] else "all with a jerk limit"]):
                group["true"].append((line["energy_J"] - best) / abs(line["energy_J"]))
    names = {"finer": f"finer grid ({options.nodes} nodes; 400 with a jerk limit)", "finer_without_jerk": "finer grid, jerk limit left out"}
    text = ["# Lower bounds of plans\n", options.note + "\n", TEXT.format(count=len(lines) - no_problem, least=least, segments=CASADI_SEGMENTS)]
    text.append(table(["found by", "problems", "within the limits", "**below the claimed bound**"],
                      [[names.get(n, n), c["tried"], c["strict"], f"**{c['below']}**"] for n, c in means.items()]))
    rows = []
    for name, group in sorted(groups.items()):
        count = collections.Counter(group["status"])
        rows.append([name, len(group["gap"]), f"{count['optimal']}, {count['feasible']}, {count['local']}", spread(group["gap"]), spread(group["true"])])
    text.append(table(["problems", "number", "optimal, feasible, local", "claimed gap: median, p95, max", "above the best found: median, p95, max"], rows))
    text.append(f"No plan: {len(unsolved)}; handed over by the fast solver: {len(handed_over)}; no fastest drive, so no problem: {no_problem}.\n")
    text += [f"- {name_of(line)}: {line['status']}, {line['message']}" for line in unsolved]
    text += [f"- {name_of(line)}: bound {line['lower_bound_J']:.9g} J above {value:.9g} J ({name})" for line, name, value in broken]
    out = "\n".join(text).rstrip() + "\n"
    (ROOT / "benchmarks/results/bounds.md").write_text(out)
    print(out)
    return len(broken)


def name_of(line):
    jerk, effect = ", jerk limit" if line["jerk"] else "", f", {line['effect']}" if line["effect"] else ""
    return f"problem {line['index']} ({line['robot']}, {line['kind']}, {line['mode']}{jerk}{effect})"


TEXT = """\
{count} seeded random problems of four robots (6 to 600 kg): straight lines, bends, corners, corners in which the inner wheel
reverses; time free, at most, exactly given, at a price, least ({least}: see least_time.md); regeneration 0, 0.6 or 1 by wheel or by bus; standby 0 to 2 times
the robot's; one in eight with a jerk limit, one in eight begins and ends at speed, one in ten has an effect (gear loss, driver drop, Stribeck
friction, warm windings), one in five is planned from 60 nodes instead of 200. One in forty is a straight line whose optimum has a closed form.

Each bound is held against profiles that were found by other means and keep every limit: `benchmarks/problems/check.py` finds nothing
above 1e-9 at 34 places of each segment (profiles with a jerk limit or an effect: the program's own replay). CasADi has {segments} nodes and
more, within limits that are smaller by 1e-6 to 1e-2, as its grid needs. Dynamic programming takes problems without a deadline. With a jerk limit the bound is that of the problem without it; it is held against
profiles of both. Gaps are relative to the plan's energy.
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--note", default="")
    parser.add_argument("--problems", type=int, default=2000)
    parser.add_argument("--nodes", type=int, default=6400)
    parser.add_argument("--casadi", type=int, default=32, help="four problems in this many; 0: none")
    parser.add_argument("--dp", type=int, default=32)
    parser.add_argument("--lane", default="0/1", help="I/N: the I-th of N processes that share the work; no report unless 0/1")
    parser.add_argument("--report-only", action="store_true")
    options = parser.parse_args()
    if not options.report_only:
        run(options)
    if options.lane == "0/1":
        sys.exit(report(options) > 0)


if __name__ == "__main__":
    main()
