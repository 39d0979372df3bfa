"""What all peers share: the problem set, its judge, paths as functions of arc length, CPU time, tables."""

import importlib
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROBLEMS = ROOT / "benchmarks/problems"
sys.path.insert(0, str(PROBLEMS))
from check import evaluate, profile, states  # noqa: E402  the common judge shares no code with the program

TOLERANCE = 1e-6


class Absent(Exception):
    """A package that this section needs is not installed."""


def package(name):
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise Absent(f"{name} is not installed: {error}") from error


def problem_set():
    data = json.loads((PROBLEMS / "problems.json").read_text())
    for problem in data["problems"]:
        problem["robot_values"] = data["robots"][problem["robot"]]
    return data["problems"]


def judge(problem, solution):
    """Energy, duration and the greatest excess of a limit (0 where all hold)."""
    limits = dict(problem["limits"])
    if "speed_m_s" in solution:  # speeds at places have steps of acceleration: of them a jerk limit is not asked
        limits.pop("jerk_m_s3", None)
    result = evaluate({**problem, "limits": limits}, problem["robot_values"], solution)
    limit, use = max(result["uses"].items(), key=lambda item: item[1])
    return {
        "energy_J": float(result["energy_J"]),
        "duration_s": float(result["duration_s"]),
        "excess": max(0.0, float(use) - 1),
        "limit": limit,
        "uses": result["uses"],
    }


class Reference:
    """Place and speed of a solution at a time."""

    def __init__(self, problem, solution):
        self.nodes = profile(problem, solution)
        self.moving_s = self.nodes[0][-1]
        self.duration = self.moving_s + solution.get("wait_s", 0.0)

    def at(self, t):
        s, v, _ = states(self.nodes, np.minimum(t, self.moving_s))
        return s, np.where(t < self.moving_s, v, 0.0)


class Path:
    """Curvature, its slope and the heading of a problem's path; of a turn in place s is the angle, and `along` is 0."""

    def __init__(self, problem):
        self.knots = np.array(problem["path"]["s_m"], float)
        self.bend = np.array(problem["path"]["curvature_per_m"], float)
        self.slopes = np.diff(self.bend) / np.diff(self.knots)
        turned = (self.bend[1:] + self.bend[:-1]) / 2 * np.diff(self.knots)
        self.headings = np.concatenate([[0], np.cumsum(turned)])
        self.length, self.along = self.knots[-1], int(problem.get("kind") != "turn")

    def piece(self, s):
        return np.clip(np.searchsorted(self.knots, s, side="right") - 1, 0, len(self.slopes) - 1)

    def curvature(self, s):
        return np.interp(s, self.knots, self.bend)

    def slope(self, s):
        return self.slopes[self.piece(s)]

    def heading(self, s):
        k = self.piece(s)
        h = s - self.knots[k]
        return self.headings[k] + h * (self.bend[k] + self.slopes[k] * h / 2)

    def places(self, heading=0.0, count=8):
        """Poses (x, y, heading) at arc lengths: `count` per metre, with Gauss-Legendre positions."""
        s = np.linspace(0, self.length, max(2, int(self.length * count) + 1))
        x, w = np.polynomial.legendre.leggauss(5)
        ds = np.diff(s)[:, None]
        inner = self.heading((s[:-1, None] + (x + 1) / 2 * ds)) + heading
        steps = np.stack([(np.cos(inner) * w).sum(1), (np.sin(inner) * w).sum(1)], 1) * ds / 2 * self.along
        return s, np.vstack([[0, 0], np.cumsum(steps, 0)]), self.heading(s) + heading


def cpu_ms(action):
    """CPU time of an action, compilers that it starts included, and its result."""

    def used_s():
        return sum(u.ru_utime + u.ru_stime for u in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))

    start = used_s()
    result = action()
    return 1e3 * (used_s() - start), result


def spread(values, digits=3):
    """Median and range."""
    values = [v for v in values if v is not None and np.isfinite(v)]
    if not values:
        return "none"
    low, mid, high = (0.0 if abs(x) < 1e-6 else x for x in (min(values), statistics.median(values), max(values)))
    return f"{mid:.{digits}g} ({low:.{digits}g} to {high:.{digits}g})"


def mid(values, digits=2):
    return f"{statistics.median(values):.{digits}g}" if len(values) else "none"


def faster(peer, ratios):
    """Who wins, by ratios of CPU time peer / ours."""
    low, high = min(ratios), max(ratios)
    if low > 1 or high < 1:
        return f"**{'joulepath' if low > 1 else peer} is faster.**"
    return "**Neither is faster in all repeats.**"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def answered(command, problems, *options):
    """What a program of build/release/bin answers to a file of problems: command, file, answers, options."""
    data = {
        "robots": {p["robot"]: p["robot_values"] for p in problems},
        "problems": [{k: v for k, v in p.items() if k != "robot_values"} for p in problems],
    }
    with tempfile.TemporaryDirectory() as scratch:
        asked, answers = pathlib.Path(scratch) / "asked.json", pathlib.Path(scratch) / "answers.json"
        asked.write_text(json.dumps(data))
        program, *words = command
        subprocess.run([ROOT / "build/release/bin" / program, *words, asked, answers, *map(str, options)], check=True)
        return json.loads(answers.read_text())


def bench_peers(command, problems, nodes=200):
    """The program's own answers, by problem."""
    return answered(["bench_peers", command], problems, nodes)


def rigid_body(problem):
    """Mass in kg, mass times its offset from the axle in kg m, and yaw inertia about the axle midpoint in kg m²."""
    robot, pay = problem["robot_values"], problem["payload_kg"]
    l, d = robot["half_track_m"], robot["center_of_mass_offset_m"]
    mass = robot["chassis_mass_kg"] + 2 * robot["wheel_mass_kg"] + pay
    mu = (robot["chassis_mass_kg"] + pay) * d
    yaw = (
        robot["chassis_yaw_inertia_kg_m2"]
        + robot["payload_yaw_inertia_m2"] * pay
        + mu * d
        + 2 * robot["wheel_mass_kg"] * l * l
        + 2 * robot["wheel_diameter_inertia_kg_m2"]
    )
    return mass, mu, yaw
