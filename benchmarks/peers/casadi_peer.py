"""CasADi [Andersson2019] + Ipopt: the least-energy profile as a user of CasADi would write it.

Unknowns are the squared speeds b at N + 1 equally spaced nodes and the braking energy that is lost per wheel and
segment; acceleration is constant in a segment, so the energy of a segment is taken by Simpson's rule in time.
Limits hold at the ends of the segments. Derivatives are exact, the functions interpreted or generated as C.
"""

import contextlib
import tempfile

import numpy as np

from common import Path, cpu_ms, package, rigid_body

IPOPT = {"ipopt.print_level": 0, "print_time": False, "ipopt.sb": "yes", "ipopt.tol": 1e-8, "ipopt.max_iter": 500}
JIT = {"jit": True, "compiler": "shell", "jit_options": {"flags": ["-O2"], "compiler": "gcc", "verbose": False}}
WARM = {
    "ipopt.warm_start_init_point": "yes",
    "ipopt.mu_init": 1e-6,
    "ipopt.warm_start_bound_push": 1e-9,
    "ipopt.warm_start_mult_bound_push": 1e-9,
    "ipopt.warm_start_slack_bound_push": 1e-9,
    "ipopt.warm_start_bound_frac": 1e-9,
    "ipopt.warm_start_slack_bound_frac": 1e-9,
}

REST = 1e-10  # squared speed at the ends: the square root has no derivative at 0


def segment_function(ca, problem, cost="full"):
    """Duration, cost per wheel and limited quantities of a segment.

    (b0, b1, ds, curvature at begin, middle, end, its slope) -> ... The cost "full" is the
    energy; the others are what other planners minimize (see economy.py).
    """
    robot, along = problem["robot_values"], int(problem["kind"] != "turn")
    r, l = robot["wheel_radius_m"], robot["half_track_m"]
    mass, mu, yaw = rigid_body(problem)
    b0, b1, ds, k0, k1, k2, slope = (ca.SX.sym(n) for n in ("b0", "b1", "ds", "k0", "k1", "k2", "slope"))
    a, v0, v1 = (b1 - b0) / (2 * ds), ca.sqrt(b0), ca.sqrt(b1)
    dt = 2 * ds / (v0 + v1)
    energy, rows = [0, 0], []
    for v, k, weight in ((v0, k0, 1), ((v0 + v1) / 2, k1, 4), (v1, k2, 1)):
        force = along * mass * a - mu * k * k * v * v
        moment = yaw * (k * a + slope * v * v) + along * mu * k * v * v
        rows += [along * k * v * v, k * a + slope * v * v] if weight == 1 else []
        for side, sign in enumerate((-1, 1)):
            motor = {key: value[side] for key, value in robot["motor"].items()}
            g, contact = (along + sign * l * k) / r, force / 2 + sign * moment / (2 * l)
            torque = (
                r * contact
                + robot["wheel_axle_inertia_kg_m2"] * (g * a + sign * l * slope * v * v / r)
                + motor["viscous_friction_Nm_s_rad"] * g * v
                + motor["friction_torque_Nm"] * ca.sign(g)
            )
            current = torque / (motor["torque_constant_Nm_A"] * motor["gear_ratio"])
            voltage = motor["resistance_ohm"] * current + motor["voltage_constant_V_s_rad"] * motor["gear_ratio"] * g * v
            if cost == "no load torque":
                idle = current - motor["friction_torque_Nm"] * ca.sign(g) / (motor["torque_constant_Nm_A"] * motor["gear_ratio"])
                energy[side] += dt * weight / 6 * idle * (voltage - motor["resistance_ohm"] * (current - idle))
            elif cost == "polynomial":  # of speed and acceleration: the power of the same motion on a straight line
                straight = (
                    (mass * r / 2 + robot["wheel_axle_inertia_kg_m2"] / r) * a
                    + motor["viscous_friction_Nm_s_rad"] * v / r
                    + motor["friction_torque_Nm"]
                ) / (motor["torque_constant_Nm_A"] * motor["gear_ratio"])
                energy[side] += (
                    dt
                    * weight
                    / 6
                    * straight
                    * (motor["resistance_ohm"] * straight + motor["voltage_constant_V_s_rad"] * motor["gear_ratio"] * v / r)
                )
            elif cost == "squared acceleration":
                energy[side] += dt * weight / 12 * (a * a + (l * (k * a + slope * v * v)) ** 2)
            else:
                energy[side] += dt * weight / 6 * voltage * current
            rows += [2 * contact / (mass * 9.80665), current, voltage] if weight == 1 else []
    return ca.Function("segment", [b0, b1, ds, k0, k1, k2, slope], [dt, ca.vertcat(*energy), ca.vertcat(along * a, *rows)])


class Program:
    """The nonlinear program of one problem; build once, solve for any duration."""

    def __init__(self, problem, segments, jit=False, cost="full", extra_nodes=()):
        ca = package("casadi")
        self.ca, self.problem, path = ca, problem, Path(problem)
        self.s = np.linspace(0, path.length, segments + 1)
        if len(extra_nodes):
            self.s = np.unique(np.concatenate([self.s, extra_nodes]))
            self.s = self.s[np.concatenate([[True], np.diff(self.s) > 1e-7 * path.length])]
            self.s[-1], segments = path.length, len(self.s) - 1
        middle = (self.s[1:] + self.s[:-1]) / 2
        geometry = [
            np.diff(self.s),
            path.curvature(self.s[:-1]),
            path.curvature(middle),
            path.curvature(self.s[1:]),
            path.slope(middle),
        ]
        function = segment_function(ca, problem, cost).map(segments)
        inner, lost = ca.MX.sym("b", segments - 1), ca.MX.sym("z", 2, segments)
        b = ca.vertcat(REST, inner, REST)
        dt, energy, rows = function(b[:-1].T, b[1:].T, *(ca.DM(x).T for x in geometry))
        eta = problem["regeneration_efficiency"] if cost != "squared acceleration" else 1
        bus = problem["sharing"] == "bus"
        taken = ca.sum1(energy) if bus else energy
        losses = lost[:1, :] if bus else lost
        duration = ca.sum2(dt)
        total = ca.sum1(ca.sum2(energy)) + (1 - eta) * ca.sum1(ca.sum2(losses)) + problem["standby_W"] * duration
        limits, inf = problem["limits"], np.inf
        at = lambda key: limits.get(key, inf)
        ends = [at("lateral_acceleration_m_s2"), at("yaw_acceleration_rad_s2")] + 2 * [
            at("traction_coefficient"),
            at("max_current_A"),
            at("max_voltage_V"),
        ]
        high = np.array([at("acceleration_m_s2")] + 2 * ends)
        low = -high
        low[0] = -at("deceleration_m_s2")
        kept = [i for i in range(len(high)) if np.isfinite(high[i])]
        g = ca.vertcat(duration, ca.vec(losses + taken), ca.vec(rows[kept, :]))
        count = losses.numel()
        self.lbg = np.concatenate([[0], np.zeros(count), np.tile(low[kept], segments)])
        self.ubg = np.concatenate([[inf], np.full(count, inf), np.tile(high[kept], segments)])
        bend = np.maximum(abs(path.curvature(self.s)), 1e-12)
        cap = at("yaw_rate_rad_s") / bend
        if path.along:
            cap = np.minimum(at("speed_m_s"), np.minimum(cap, np.sqrt(at("lateral_acceleration_m_s2") / bend)))
        self.cap = cap[1:-1] ** 2
        self.inner, self.count = segments - 1, 2 * segments
        self.nlp = {"x": ca.vertcat(inner, ca.vec(lost)), "f": total, "g": g}
        self.jit = JIT if jit else {}
        self.lbx = np.concatenate([np.full(self.inner, 1e-8), np.zeros(self.count)])
        self.ubx = np.concatenate([self.cap, np.full(self.count, 0 if eta == 1 else inf)])
        if eta == 1:  # nothing is lost: the rows that count it say nothing
            self.lbg[1 : 1 + count] = -inf
        self.solver = ca.nlpsol("cold", "ipopt", self.nlp, {**IPOPT, **self.jit})
        self.warm_solver = None

    def guess(self):
        """A slow parabola below the caps."""
        x = self.s[1:-1] / self.s[-1]
        return np.concatenate([np.minimum(0.5 * self.cap, self.cap.min() * 4 * x * (1 - x)), np.ones(self.count)])

    def solve(self, duration_s, before=None):
        problem, ubg, lbg = self.problem, self.ubg.copy(), self.lbg.copy()
        mode = problem["time"]["mode"]
        if mode in ("at_most", "exactly"):
            ubg[0] = duration_s
        if mode == "exactly":
            lbg[0] = duration_s
        bounds = {"lbx": self.lbx, "ubx": self.ubx, "lbg": lbg, "ubg": ubg}
        if before is None:
            answer, solver = self.solver(x0=self.guess(), **bounds), self.solver
        else:
            answer = self.warm_solver(x0=before["x"], lam_x0=before["lam_x"], lam_g0=before["lam_g"], **bounds)
            solver = self.warm_solver
        return answer, solver.stats()

    def prepare_warm(self):
        self.warm_solver = self.ca.nlpsol("warm", "ipopt", self.nlp, {**IPOPT, **WARM, **self.jit})

    def solution(self, answer):
        b = np.concatenate([[0], np.array(answer["x"]).ravel()[: self.inner], [0]])
        return {"s_m": self.s.tolist(), "speed_m_s": np.sqrt(np.maximum(b, 0)).tolist()}


def compiled(problem, segments, repeats):
    """CPU times with generated and compiled C: the build with the compiler, and each solve."""
    with tempfile.TemporaryDirectory() as scratch, contextlib.chdir(scratch):  # where CasADi leaves its C files
        build_ms, program = cpu_ms(lambda: Program(problem, segments, jit=True))
        asked = problem["time"].get("duration_s")
        solves_ms = [cpu_ms(lambda: program.solve(asked))[0] for _ in range(repeats)]
        program = None  # it removes its files itself
        return build_ms, solves_ms


def run(problem, segments, warm_share=0.01):
    """Build, first solve, and a warm solve for a duration that is longer by a share (where there is one)."""
    build_ms, program = cpu_ms(lambda: Program(problem, segments))
    asked = problem["time"].get("duration_s")
    solve_ms, (answer, stats) = cpu_ms(lambda: program.solve(asked))
    result = {
        "build_ms": build_ms,
        "solve_ms": solve_ms,
        "success": bool(stats["success"]),
        "iterations": stats["iter_count"],
        "solution": program.solution(answer),
    }
    if asked:
        program.prepare_warm()
        result["warm_ms"], (_, stats) = cpu_ms(lambda: program.solve(asked * (1 + warm_share), answer))
        result["warm_iterations"] = stats["iter_count"]
    return result
