"""./dev bench replan_casadi [PROBLEMS_OF_EACH_KIND]: the replanner beside the same program as a warm-started CasADi + Ipopt script.

Both plan the rest of a problem of the public set from the same situations, on 200 segments. CasADi's program is made once per
problem, with the place, the speed, the geometry of the rest and the time left as parameters; each solve starts at the unknowns
and multipliers of the last one. Both answers are judged by one fine integration of the energy.
"""

import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "benchmarks/peers"))
from casadi_peer import IPOPT, REST, WARM, segment_function  # noqa: E402
from common import Path, answered, cpu_ms, package, problem_set, spread, table  # noqa: E402

SEGMENTS, FINE, SEED = 200, 4000, 20261122
KINDS, SITUATIONS = ("straight", "bend", "corners", "tight_corners"), 20
SLACK = 1.3  # times the time in which the plan of the whole problem drives


class Program:
    """The least-energy rest of a problem, parametric in where it begins."""

    def __init__(self, problem):
        ca = package("casadi")
        self.ca, self.problem, self.path = ca, problem, Path(problem)
        self.segment = segment_function(ca, problem)
        n = SEGMENTS
        inner, lost = ca.MX.sym("b", n - 1), ca.MX.sym("z", 2, n)
        start, geometry = ca.MX.sym("start"), ca.MX.sym("geometry", 5, n)
        b = ca.vertcat(start, inner, REST)
        dt, energy, rows = self.segment.map(n)(b[:-1].T, b[1:].T, *(geometry[i, :] for i in range(5)))
        bus, eta = problem["sharing"] == "bus", problem["regeneration_efficiency"]
        taken, losses = (ca.sum1(energy), lost[:1, :]) if bus else (energy, lost)
        total = ca.sum1(ca.sum2(energy)) + (1 - eta) * ca.sum1(ca.sum2(losses)) + problem["standby_W"] * ca.sum2(dt)
        low, high = self.rows()
        kept = np.isfinite(high)
        count = losses.numel()
        self.lbg = np.concatenate([[0], np.zeros(count), np.tile(low[kept], n)])
        self.ubg = np.concatenate([[np.inf], np.full(count, np.inf), np.tile(high[kept], n)])
        self.lbx = np.concatenate([np.full(n - 1, 1e-8), np.zeros(2 * n)])
        g = ca.vertcat(ca.sum2(dt), ca.vec(losses + taken), ca.vec(rows[np.nonzero(kept)[0].tolist(), :]))
        nlp = {"x": ca.vertcat(inner, ca.vec(lost)), "f": total, "g": g, "p": ca.vertcat(start, ca.vec(geometry))}
        options = {**IPOPT, "ipopt.max_iter": 150}
        self.cold = ca.nlpsol("cold", "ipopt", nlp, options)
        self.warm = ca.nlpsol("warm", "ipopt", nlp, {**options, **WARM, "ipopt.mu_init": 1e-4})
        self.last = None

    def rows(self):
        """Bounds of the rows of segment_function()."""
        at = lambda key: self.problem["limits"].get(key, np.inf)
        keys = ["lateral_acceleration_m_s2", "yaw_acceleration_rad_s2"] + 2 * ["traction_coefficient", "max_current_A", "max_voltage_V"]
        high = np.array([at("acceleration_m_s2")] + 2 * [at(key) for key in keys])
        return np.concatenate([[-at("deceleration_m_s2")], -high[1:]]), high

    def geometry(self, s):
        middle = (s[1:] + s[:-1]) / 2
        bend = self.path.curvature
        return np.array([np.diff(s), bend(s[:-1]), bend(middle), bend(s[1:]), self.path.slope(middle)])

    def caps(self, s):
        at = lambda key: self.problem["limits"].get(key, np.inf)
        bend = np.maximum(abs(self.path.curvature(s)), 1e-12)
        return np.minimum(at("speed_m_s"), np.minimum(at("yaw_rate_rad_s") / bend, np.sqrt(at("lateral_acceleration_m_s2") / bend))) ** 2

    def solve(self, place, rate, left_s):
        """Nodes and squares of the rate, CPU time and success; the clock runs from the situation to the answer."""
        return cpu_ms(lambda: self.answer(place, rate, left_s))

    def answer(self, place, rate, left_s):
        s = np.linspace(place, self.path.length, SEGMENTS + 1)
        cap = self.caps(s)[1:-1]
        given = {
            "p": np.concatenate([[rate**2], self.geometry(s).ravel(order="F")]),
            "lbx": self.lbx,
            "ubx": np.concatenate([cap, np.full(2 * SEGMENTS, np.inf)]),
            "lbg": self.lbg,
            "ubg": np.concatenate([[left_s], self.ubg[1:]]),
        }
        x = np.linspace(0, 1, SEGMENTS + 1)[1:-1]
        guess = np.concatenate([np.minimum(0.5 * cap, np.maximum(1e-3, rate**2) * (1 - x) + 4 * cap.min() * x * (1 - x)), np.ones(2 * SEGMENTS)])
        found, solver = None, self.warm
        if self.last is not None:
            found = self.warm(x0=self.last["x"], lam_x0=self.last["lam_x"], lam_g0=self.last["lam_g"], **given)
        if found is None or not solver.stats()["success"]:
            solver = self.cold
            found = solver(x0=guess, **given)
        success = bool(solver.stats()["success"])
        self.last = found if success else self.last
        b = np.concatenate([[rate**2], np.array(found["x"]).ravel()[: SEGMENTS - 1], [0.0]])
        return s, b, success, solver is self.warm

    def energy_J(self, s, b):
        """By Simpson's rule on a fine grid, on which the squares are linear between the nodes of the answer."""
        fine = np.unique(np.concatenate([np.linspace(s[0], s[-1], FINE + 1), s]))
        squares = np.maximum(np.interp(fine, s, b), REST)
        _, energy, _ = self.segment.map(len(fine) - 1)(squares[None, :-1], squares[None, 1:], *(row[None, :] for row in self.geometry(fine)))
        dt = 2 * np.diff(fine) / (np.sqrt(squares[1:]) + np.sqrt(squares[:-1]))
        taken = np.array(energy).sum(0) if self.problem["sharing"] == "bus" else np.array(energy)
        eta = self.problem["regeneration_efficiency"]
        return float(np.where(taken < 0, eta * taken, taken).sum() + self.problem["standby_W"] * dt.sum()), float(dt.sum())


def problems(count):
    """The first problems of each kind without a jerk limit."""
    free = [p for p in problem_set() if "jerk_m_s3" not in p["limits"]]
    return [p for kind in KINDS for p in [p for p in free if p["kind"] == kind][:count]]


def ours(asked):
    """The replanner's answers by problem: the situations, what it found and its CPU times."""
    return answered(["bench_replan_situations"], asked, SEED, SITUATIONS, SEGMENTS, SLACK)


def compared(problem, replans):
    """Rows of one problem: ms of both, energies, seconds beyond the time left."""
    program, rows = Program(problem), []
    for own in replans:
        ms, (s, b, success, warm) = program.solve(own["s"], own["rate"], own["time_left_s"])
        theirs_J, theirs_s = program.energy_J(s, b)
        own_J, own_s = program.energy_J(np.array(own["s_m"]), np.array(own["rates"]) ** 2)
        rows.append(
            {
                "ms": ms,
                "own_ms": own["ms"],
                "success": success,
                "warm": warm,
                "percent": 100 * (own_J / theirs_J - 1),
                "late_s": theirs_s - own["time_left_s"],
                "own_late_s": own_s - own["time_left_s"],
            }
        )
    return rows[1:]  # the first solve is cold


def quantiles(values):
    return f"{np.median(values):.3g}, {np.quantile(values, 0.99):.3g}, {max(values):.3g}"


def main():
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 4
    asked = problems(count)
    answers = ours(asked)
    rows = [row for p in asked for row in compared(p, answers[p["id"]])]
    good = [row for row in rows if row["success"]]
    lines = [
        ["replans", len(rows), len(rows)],
        ["CPU time of a replan: median, p99, max, ms", quantiles([r["own_ms"] for r in rows]), quantiles([r["ms"] for r in rows])],
        ["answered from the warm start", "", sum(r["warm"] and r["success"] for r in rows)],
        ["no answer", 0, len(rows) - len(good)],
        ["energy, the replanner's over CasADi's, %", spread([r["percent"] for r in good], 2), ""],
        ["longer than the time left, s, at most", *(f"{max(0.0, max(r[key] for r in good)):.2g}" for key in ("own_late_s", "late_s"))],
    ]
    ratio = np.median([r["ms"] / r["own_ms"] for r in rows])
    text = (
        f"# The replanner beside warm CasADi + Ipopt\n\n{sys.argv[1]}\nThe machine ran other work at the same time; times are CPU times.\n\n"
        f"{len(asked)} problems of the public set (straight, bend, corners, tight corners), planned in {SLACK} times the least time; "
        f"{SITUATIONS} random situations each: place, speed 0.85 to 1.0 of the plan's, time left 0.97 to 1.1 of the plan's. "
        f"Both have N = {SEGMENTS}. CasADi's program is built once per problem and starts at the unknowns and multipliers of the last replan; "
        "where Ipopt fails from there within 150 iterations, it starts anew. Its limits hold at the nodes only, its nodes are equally spaced, its functions are interpreted. "
        "Energies are one fine integration of both answers.\n\n"
    )
    text += table(["", "Replanner", "CasADi + Ipopt, warm"], lines)
    text += f"\nMedian of the ratios of CPU times, CasADi over the replanner: {ratio:.3g}.\n"
    (ROOT / "benchmarks/results/replan_casadi.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
