"""Section on classic profiles: what the optimum saves on straight lines, in equal time."""

import copy
import statistics

import ruckig_peer
from common import Absent, bench_peers, judge, mid, problem_set, spread, table

LENGTHS_M, SLACKS, ETAS = (4, 10, 25), (1.15, 1.4, 1.8), (0, 0.6, 1)
JERK_M_S3 = 0.5
# |error| (%) of the energy model on the 30 straight runs of doi 10.1177/1729881420909654, Table 5, by acceleration.
MODEL_ERRORS_PERCENT = (
    7.42,
    5.29,
    3.82,
    7.89,
    9.25,
    3.13,
    0.13,
    3.69,
    5.11,
    8.46,
    5.99,
    6.70,
    0.69,
    0.53,
    2.85,
    7.33,
    7.20,
    0.75,
    0.20,
    1.92,
    10.86,
    8.10,
    6.70,
    5.33,
    0.17,
    8.80,
    9.85,
    6.52,
    7.94,
    5.04,
)
OWN_ERROR = {"nomad_super_scout": spread(MODEL_ERRORS_PERCENT, 2)}  # nobody has measured the other robots


def straight_cases(size):
    """Straight lines of three lengths in three times, for each robot, regeneration, with and without jerk limit."""
    first, standby_W = {}, {}
    for problem in problem_set():
        first.setdefault(problem["robot"], problem)
        standby_W[problem["robot"]] = max(
            standby_W.get(problem["robot"], 0), problem["standby_W"] / 2
        )  # the set draws 0 to 2 of it
    cases = []
    for robot, like in first.items():
        v, a = like["limits"]["speed_m_s"], min(like["limits"]["acceleration_m_s2"], like["limits"]["deceleration_m_s2"])
        for jerk in (None, JERK_M_S3):
            for length in size(LENGTHS_M, LENGTHS_M[:1]):
                ramp = a / jerk if jerk else 0
                least_s = length / v + v / a + ramp if length > v * (v / a + ramp) else 2 * (length / a) ** 0.5 + ramp
                for slack in size(SLACKS, SLACKS[:1]):
                    for eta in ETAS:
                        case = copy.deepcopy(like)
                        case.update(
                            id=f"{robot}/{jerk}/{length}/{slack}/{eta}",
                            kind="straight",
                            standby_W=standby_W[robot],
                            regeneration_efficiency=eta,
                            path={"s_m": [0, length], "curvature_per_m": [0, 0]},
                            time={"mode": "exactly", "duration_s": slack * least_s},
                        )
                        if jerk:
                            case["limits"]["jerk_m_s3"] = jerk
                        cases.append(case)
    return cases


def ruckig_answer(case):
    """Ruckig's profile in the same time, under a jerk limit its natural rival."""
    try:
        limits = case["limits"]
        answer = ruckig_peer.run(case["path"]["s_m"][-1], limits, limits["jerk_m_s3"], case["time"]["duration_s"])
    except Absent:
        return {}
    return {"ruckig_in_the_same_time": answer["solution"]} if answer["solution"] else {}


def run(size):
    cases = straight_cases(size)
    answers = bench_peers("baselines", cases)
    for case in cases:
        if "jerk_m_s3" in case["limits"]:
            answers[case["id"]].update(ruckig_answer(case))
    savings = {}  # (robot, baseline) -> rows of (eta, jerk, % of motion energy, % with standby)
    for case in cases:
        answer = answers[case["id"]]
        if "optimum" not in answer:
            continue
        best = judge(case, answer["optimum"])
        standby_J = best["duration_s"] * case["standby_W"]
        for name, solution in answer.items():
            if name == "optimum":
                continue
            more = judge(case, solution)["energy_J"] - best["energy_J"]
            moved = best["energy_J"] - standby_J
            savings.setdefault((case["robot"], name), []).append(
                (
                    case["regeneration_efficiency"],
                    "jerk_m_s3" in case["limits"],
                    100 * more / (moved + more),
                    100 * more / (moved + standby_J + more),
                )
            )
    median = lambda values: f"{statistics.median(values):.2g}" if values else "none"
    rows, bars = [], {}
    for (robot, name), found in savings.items():
        plain = [x[2] for x in found if not x[1]]
        if plain:
            bars.setdefault(robot, {})[name] = plain
        rows.append(
            [
                robot,
                name.replace("_", " "),
                len(found),
                median(plain),
                f"{max(plain):.2g}" if plain else "none",
                *(median([x[2] for x in found if x[0] == eta and not x[1]]) for eta in ETAS),
                median([x[3] for x in found if not x[1]]),
                median([x[2] for x in found if x[1]]),
                OWN_ERROR.get(robot, "not measured"),
            ]
        )
    text = (
        f"Straight lines of {', '.join(map(str, LENGTHS_M))} m in {', '.join(map(str, SLACKS))} times the least time; "
        "same distance and time for all. "
        "Percent of the classic profile's motor energy that the optimum saves; a column counts standby ("
        + ", ".join(sorted({f"{c['robot']} {c['standby_W']:g} W" for c in cases}))
        + "). Payload and limits are those of the robot's first problem of the set.\n\n"
    )
    text += table(
        [
            "robot",
            "instead of",
            "cases",
            "median",
            "max",
            "η = 0",
            "0.6",
            "1",
            "with standby",
            f"with jerk limit {JERK_M_S3} m/s³",
            "model's own error",
        ],
        rows,
    )
    text += "\n![Savings by robot and classic profile](peers_classic_profiles.svg)\n" + headline(savings)
    return {
        "text": text,
        "bars": bars,
        "summary": {},
        "own_error": MODEL_ERRORS_PERCENT,
        "short": "**Classic profiles** on straight lines in equal time: the optimum saves "
        + " and ".join(
            f"{mid([x for found in bars.values() for x in found.get(name, [])])} % of the motor energy against the {title}"
            for name, title in (("trapezoid_max_acceleration", "trapezoid at maximum acceleration"), ("trapezoid_best_tuned", "best tuned"))
        )
        + f" (medians over {len(bars)} robots). The model's own error, where it was measured, is {mid(MODEL_ERRORS_PERCENT)} %.",
    }


def headline(savings):
    """One sentence per robot, made of the table; then what it is worth."""
    medians = {}
    for (robot, name), found in savings.items():
        plain = [x[2] for x in found if not x[1]]
        if plain:
            medians.setdefault(robot, {})[name] = statistics.median(plain)
    parts = []
    for robot, by_name in medians.items():
        nearest = min(by_name, key=by_name.get)
        parts.append(
            f"{robot}: {by_name.get('trapezoid_max_acceleration', 0):.2g} % against the trapezoid at maximum acceleration, "
            f"{by_name.get('trapezoid_best_tuned', 0):.2g} % against the best tuned one, {by_name[nearest]:.2g} % against "
            f"the nearest classic profile ({nearest.replace('_', ' ')})"
        )
    return (
        "\n**What the table supports**: in equal time on a straight line the speed profile alone saves, in the median, on the "
        + "; on the ".join(parts)
        + ". A well chosen classic profile leaves little to save. The model's own error on the Nomad, on the 30 measured runs "
        f"of the source paper, is {spread(MODEL_ERRORS_PERCENT, 2)} % ([paper.md](paper.md)); nobody has measured the other "
        "robots. The saving is a difference of two energies of one model, of which a common error cancels.\n"
    )
