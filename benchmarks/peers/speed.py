"""Sections on the optimizers: CasADi with Ipopt, toppra, Ruckig. Ratios come from interleaved repeats."""

import copy
import statistics

import casadi_peer
import ruckig_peer
import toppra_peer
from common import TOLERANCE, bench_peers, faster, judge, mid, problem_set, spread, table


def pick(modes, kinds=("straight", "bend", "corners", "tight_corners", "turn"), count=2):
    """The first problems of each kind of path with one of the modes."""
    chosen, free = [], [p for p in problem_set() if "jerk_m_s3" not in p["limits"]]
    for kind in kinds:
        chosen += [p for p in free if p["kind"] == kind and p["time"]["mode"] in modes][:count]
    return chosen


def gap_percent(problem, result):
    return 100 * (result["energy_J"] / problem["best"]["value"] - 1)


def casadi_round(problems, nodes):
    """One repeat, ours and theirs in turn: sums of CPU times over the problems, and the answers."""
    ours = bench_peers("programs", problems, nodes)
    theirs = {p["id"]: casadi_peer.run(p, nodes) for p in problems}
    warm = [t for t in theirs.values() if "warm_ms" in t]
    total = sum(t["solve_ms"] for t in theirs.values())
    fast = sum(o["fast"]["solve_ms"] for o in ours.values())
    figures = {
        "solve_ms": total / len(problems),
        "build": sum(t["build_ms"] for t in theirs.values()) / total,
        "warm_gain": sum(t["solve_ms"] for t in warm) / sum(t["warm_ms"] for t in warm) if warm else None,
        "ipopt": total / sum(o["ipopt"]["solve_ms"] for o in ours.values()),
        "fast": total / fast,
        "prepared": total / (fast + sum(o["prepare_ms"] for o in ours.values())),
    }
    return figures, ours, theirs


def casadi(size):
    problems = pick(("free", "at_most"), count=size(2, 1))
    times, qualities, ratios, at_200 = [], [], {}, None
    for nodes in (100, 200, 400):
        rounds = [casadi_round(problems, nodes) for _ in range(size(5, 2))]
        figures = {key: [figures[key] for figures, _, _ in rounds] for key in rounds[0][0]}
        _, ours, theirs = rounds[-1]
        failed = sum(not t["success"] for t in theirs.values())
        times.append([nodes, *(spread(values) for values in figures.values()), failed])
        qualities.append([nodes, *quality(problems, theirs, ours)])
        ratios[nodes] = figures
        at_200 = theirs if nodes == 200 else at_200
    text = (
        f"{len(problems)} problems of five kinds (turns in place are one), time free or at most given. The unknowns of CasADi lie on "
        "equally spaced nodes, ours on our grid; limits hold at the nodes only, on both sides (no refinement). Ratios are "
        "sums of CPU times over the problems: above 1 CasADi takes longer.\n\n"
    )
    text += table(["N", *CASADI_COLUMNS], times)
    text += (
        f"\nAgainst our Ipopt at N = 200: {faster('CasADi', ratios[200]['ipopt'])} Against the fast solver with "
        f"preparation: {faster('CasADi', ratios[200]['prepared'])}\n\nAfter dense evaluation by the judge:\n\n"
    )
    text += table(["N", *(f"{who}: {cell}" for who in ("CasADi", "ours") for cell in QUALITY_COLUMNS)], qualities)
    one_each = problems[:: size(2, 1)][: size(5, 1)]
    compiled, compiled_ratios = generated_code(one_each, at_200, size(5, 2))
    text += "\n" + compiled + whole_solve(problems)
    named = {"our Ipopt": "ipopt", "fast solver with preparation": "prepared"}
    return {
        "text": text,
        "summary": {f"CasADi + Ipopt / {name}": ratios[200][key] for name, key in named.items()}
        | {f"CasADi compiled / {name}": compiled_ratios[key] for name, key in named.items()},
        "short": f"**CasADi + Ipopt** takes {mid(ratios[200]['ipopt'])} times the CPU time of our Ipopt on the same program and "
        f"{mid(ratios[200]['prepared'])} times that of the fast solver with its preparation; compiled to C, which itself takes "
        f"seconds, {mid(compiled_ratios['ipopt'])} and {mid(compiled_ratios['prepared'])} times.",
    }


CASADI_COLUMNS = [
    "CasADi solve, ms per problem",
    "its build / solve",
    "its first / warm solve",
    "CasADi / our Ipopt",
    "/ our fast solver",
    "/ fast solver with preparation",
    "not converged",
]


QUALITY_COLUMNS = ["above the best, %", "excess of a limit between nodes, %", "valid, of these below the bound"]


def refuted(problem, result):
    """Whether an answer within all limits lies below the lower bound of the set."""
    value = result["duration_s" if problem["time"]["mode"] == "least" else "energy_J"]
    return result["excess"] <= TOLERANCE and value < problem["best"]["lower_bound"] * (1 - TOLERANCE)


def quality(problems, theirs, ours):
    """Energy above the best, excess of a limit, answers within all limits and those below the bound: theirs, then ours."""
    cells = []
    for answers in ({i: t["solution"] for i, t in theirs.items()}, {i: o["fast"]["solution"] for i, o in ours.items()}):
        results = [judge(p, answers[p["id"]]) for p in problems]
        valid = sum(r["excess"] <= TOLERANCE for r in results)
        cells += [
            spread([gap_percent(p, r) for p, r in zip(problems, results)], 2),
            spread([100 * r["excess"] for r in results], 2),
            f"{valid}, {sum(map(refuted, problems, results))}",
        ]
    return cells


def whole_solve(problems):
    whole = bench_peers("plan", problems, 200)
    results = [judge(p, whole[p["id"]]["solution"]) for p in problems]
    return (
        "\nThe product's whole solve (refined grid, limits between nodes, bound): "
        f"{spread([w['solve_ms'] for w in whole.values()])} ms, "
        f"{spread([gap_percent(p, r) for p, r in zip(problems, results)], 2)} % above the best, greatest excess of a "
        f"limit {max(r['excess'] for r in results):.1e}.\n"
    )


def generated_code(problems, interpreted, repeats):
    """Table and ratios of CPU time, compiled CasADi over ours, repeat by repeat."""
    rows, theirs = [], []
    for problem in problems:
        build_ms, solves_ms = casadi_peer.compiled(problem, 200, repeats)
        theirs.append(solves_ms)
        plain = interpreted[problem["id"]]
        rows.append([problem["id"], problem["kind"], f"{plain['build_ms']:.0f}", f"{plain['solve_ms']:.0f}", f"{build_ms:.0f}",
                     spread(solves_ms), f"{plain['solve_ms'] / statistics.median(solves_ms):.2f}"])  # fmt: skip
    ratios = {"ipopt": [], "prepared": []}
    for i in range(repeats):
        ours, total = bench_peers("programs", problems, 200).values(), sum(solves_ms[i] for solves_ms in theirs)
        ratios["ipopt"].append(total / sum(o["ipopt"]["solve_ms"] for o in ours))
        ratios["prepared"].append(total / sum(o["fast"]["solve_ms"] + o["prepare_ms"] for o in ours))
    header = ["problem", "kind", "interpreted: build, ms", "solve, ms", "compiled: build, ms", "solve, ms", "interpreted / compiled"]
    text = "CasADi with generated and compiled C (N = 200); the build counts the compiler:\n\n" + table(header, rows)
    text += (
        f"\nCompiled CasADi over our Ipopt: {spread(ratios['ipopt'])}. {faster('CasADi', ratios['ipopt'])} Over the fast solver "
        f"with preparation: {spread(ratios['prepared'])}. {faster('CasADi', ratios['prepared'])} CasADi's program under a jerk "
        "limit is not compared: it has other unknowns.\n"
    )
    return text, ratios


def toppra(size):
    problems = [p for p in problem_set() if p["time"]["mode"] == "least" and "jerk_m_s3" not in p["limits"]]
    problems = [p for p in problems if p["kind"] != "turn"][: size(20, 6)] + [p for p in problems if p["kind"] == "turn"]
    longer, ratios, excesses, ours_excess = [], [], [], []
    for _ in range(size(5, 2)):
        ours = bench_peers("plan", problems, 200)
        theirs = {p["id"]: toppra_peer.run(p, 1000) for p in problems}
        ratios.append(sum(t["solve_ms"] for t in theirs.values()) / sum(o["solve_ms"] for o in ours.values()))
    quicker = below = 0
    for p in problems:
        mine, other = judge(p, ours[p["id"]]["solution"]), theirs[p["id"]]["solution"]
        ours_excess.append(mine["excess"])
        if other is None:
            continue
        other = judge(p, other)
        longer.append(other["duration_s"] / mine["duration_s"] - 1)
        excesses.append(other["excess"])
        quicker += other["excess"] <= TOLERANCE and other["duration_s"] < mine["duration_s"] * (1 - TOLERANCE)
        below += refuted(p, other)
    none = sum(t["solution"] is None for t in theirs.values())
    turns = sum(p["kind"] == "turn" for p in problems)
    least = (
        f"Least time, {len(problems)} problems ({turns} turns in place), toppra on 1,000 points and two beside each knot of the "
        f"path: CPU time toppra / whole solve with bound {spread(ratios)}: {faster('toppra', ratios)} "
        f"No answer {none}; duration above ours {spread([100 * x for x in longer], 2)} %; its excess of a limit "
        f"{spread([100 * x for x in excesses], 2)} %, ours {max(ours_excess):.1e}. "
        f"Shorter than ours by more than 1e-6 within all limits: {quicker}; below the bound: {below}.\n\n"
    )
    text, more = fixed_duration(pick(("at_most", "exactly"), count=size(5, 2)))
    return {
        "text": least + text,
        "summary": {"toppra / least time with bound": ratios},
        "energy": {"toppra, fixed duration": more},
        "short": f"**toppra**, least time: CPU time over ours {mid(ratios)}, {faster('toppra', ratios).strip('*.').lower()}; shorter "
        f"within all limits in {quicker} of {len(problems)} problems. In a given time its profiles take {mid(more)} % more energy.",
    }


def fixed_duration(problems):
    """toppra's profiles of a given duration: what they take above the least energy."""
    more, miss, below = [], [], 0
    for p in problems:
        answer = toppra_peer.run(p, 400, p["time"]["duration_s"])["solution"]
        result = judge(p, answer) if answer else None
        if result and abs(result["duration_s"] / p["time"]["duration_s"] - 1) < 0.01:
            more.append(gap_percent(p, result))
            miss.append(result["excess"])
            below += refuted(p, result)
    text = (
        f"Fixed duration (TOPPRAsd), {len(problems)} problems: {len(more)} answers within 1 % of the duration; energy "
        f"above the least {spread(more)} %, excess of a limit {spread([100 * x for x in miss], 2)} %; below the bound "
        f"within all limits: {below}.\n"
    )
    return text, more


def ruckig(size, jerk_m_s3=0.5):
    problems = []
    for p in [q for q in problem_set() if q["kind"] == "straight"][: size(12, 3)]:
        p = copy.deepcopy(p)
        p["limits"]["jerk_m_s3"] = jerk_m_s3
        fastest = ruckig_peer.run(p["path"]["s_m"][-1], p["limits"], jerk_m_s3)
        problems.append((p, fastest))
    least, timed = [], []
    for p, fastest in problems:
        q = copy.deepcopy(p)
        q["time"] = {"mode": "least"}
        p["time"] = {"mode": "at_most", "duration_s": 1.3 * fastest["duration_s"]}
        least.append(q)
        timed.append(p)
    quickest, slower = bench_peers("plan", least, 200), bench_peers("plan", timed, 200)
    difference, more, ratio, excess = [], [], [], {"Ruckig": 0.0, "ours": 0.0}
    for (p, fastest), q in zip(problems, least):
        if "solution" in quickest[q["id"]]:
            difference.append(
                judge(q, quickest[q["id"]]["solution"])["duration_s"] / judge(q, fastest["solution"])["duration_s"] - 1
            )
        answer = ruckig_peer.run(p["path"]["s_m"][-1], p["limits"], jerk_m_s3, p["time"]["duration_s"])
        if answer["solution"] and "solution" in slower[p["id"]]:
            other, mine = judge(p, answer["solution"]), judge(p, slower[p["id"]]["solution"])
            more.append(100 * (other["energy_J"] / mine["energy_J"] - 1))
            excess = {"Ruckig": max(excess["Ruckig"], other["excess"]), "ours": max(excess["ours"], mine["excess"])}
        ratio.append(slower[p["id"]]["solve_ms"] / answer["solve_ms"])
    micro = [1e3 * ruckig_peer.run(p["path"]["s_m"][-1], p["limits"], jerk_m_s3)["solve_ms"] for p in timed]
    text = (
        f"Straight lines with a jerk limit of {jerk_m_s3} m/s³, {len(problems)} problems. Ruckig answers in "
        f"{spread(micro, 2)} µs. {faster('Ruckig', [1 / r for r in ratio])} Our time over its: {spread(ratio, 2)}. "
        f"Least time: ours is longer by {spread([100 * x for x in difference], 2)} % ({len(difference)} solved). In 1.3 "
        "times the least time Ruckig's profile takes "
        f"{spread(more)} % more energy ({len(more)} compared; greatest excess of a limit: Ruckig "
        f"{excess['Ruckig']:.1e}, ours {excess['ours']:.1e}). Ruckig knows no curvature, hence no lateral or yaw "
        "limit, no motor, no energy; its online trajectories from any state are not used here.\n"
    )
    return {
        "text": text,
        "summary": {"Ruckig / our solve with jerk limit": [1 / r for r in ratio]},
        "energy": {"Ruckig, 1.3 × least time": more},
        "short": f"**Ruckig** is {float(f'{statistics.median(ratio):.2g}'):,.0f} times faster, on straight lines only; in 1.3 times the "
        f"least time its profiles take {mid(more)} % more energy.",
    }
