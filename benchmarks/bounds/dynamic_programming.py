"""Least-energy profiles by dynamic programming [Bellman1957] over squared speeds at nodes, with the model of check.py.

A grid of levels at every node, then grids in ever smaller bands about the profile found. Limits hold at five
places of each segment with a little room. Time is free or has a price: a deadline couples all segments.
"""

import numpy as np

LEVELS, SEGMENTS = 48, 90
BANDS = [1.0, 0.4, 0.16, 0.06, 0.025, 0.01, 0.004]  # half widths, of the cap of the speed
GAUSS, WEIGHT = np.polynomial.legendre.leggauss(4)


class Model:
    def __init__(self, problem, path):
        robot, self.pay = problem["robot_values"], problem["payload_kg"]
        self.problem, self.path, self.robot = problem, path, robot
        self.r, self.l = robot["wheel_radius_m"], robot["half_track_m"]
        d, loaded = robot["center_of_mass_offset_m"], robot["chassis_mass_kg"] + self.pay
        self.mass, self.mu = loaded + 2 * robot["wheel_mass_kg"], loaded * d
        self.yaw = (
            robot["chassis_yaw_inertia_kg_m2"]
            + robot["payload_yaw_inertia_m2"] * self.pay
            + self.mu * d
            + 2 * robot["wheel_mass_kg"] * self.l**2
            + 2 * robot["wheel_diameter_inertia_kg_m2"]
        )

    def cost(self, k, s, b0, b1, price_W, room):
        """Energy and price of time of segment k for all pairs of levels; infinite beyond a limit."""
        ds = s[k + 1] - s[k]
        b0, b1 = b0[:, None], b1[None, :]
        a, sum_v = (b1 - b0) / (2 * ds), np.sqrt(b0) + np.sqrt(b1)
        with np.errstate(divide="ignore"):
            dt = np.where(sum_v > 0, 2 * ds / sum_v, np.inf)
        slope = float(self.path.slope((s[k] + s[k + 1]) / 2))
        bend = float(self.path.curvature(s[k]))
        use, energy = np.zeros_like(dt), np.zeros_like(dt)
        for share, weight in [(x, 0) for x in (0, 0.25, 0.5, 0.75, 1)] + list(zip((GAUSS + 1) / 2, WEIGHT / 2)):
            v = (1 - share) * np.sqrt(b0) + share * np.sqrt(b1)
            at = np.where(np.isfinite(dt), np.sqrt(b0) * share * dt + a * (share * dt) ** 2 / 2, 0)
            power, worst = self.place(bend + slope * at, slope, v, a)
            if weight:
                energy += weight * power * dt
            else:
                use = np.maximum(use, worst)
        total = energy + (self.problem["standby_W"] + price_W) * dt
        return np.where((use <= 1 - room) & np.isfinite(dt), total, np.inf)

    def place(self, k, slope, v, a):
        limits, b = self.problem["limits"], v * v
        force, moment = self.mass * a - self.mu * k**2 * b, self.yaw * (k * a + slope * b) + self.mu * k * b
        found = {
            "speed_m_s": v,
            "acceleration_m_s2": a,
            "deceleration_m_s2": -a,
            "lateral_acceleration_m_s2": abs(k * b),
            "yaw_rate_rad_s": abs(k * v),
            "yaw_acceleration_rad_s2": abs(k * a + slope * b),
        }
        powers, worst = [], 0.0
        for side, sign in enumerate((-1, 1)):
            motor = {key: value[side] for key, value in self.robot["motor"].items()}
            g, contact = (1 + sign * self.l * k) / self.r, force / 2 + sign * moment / (2 * self.l)
            torque = (
                self.r * contact
                + self.robot["wheel_axle_inertia_kg_m2"] * (g * a + sign * self.l * slope * b / self.r)
                + motor["viscous_friction_Nm_s_rad"] * g * v
                + motor["friction_torque_Nm"] * np.sign(g)
            )
            current = torque / (motor["torque_constant_Nm_A"] * motor["gear_ratio"])
            voltage = motor["resistance_ohm"] * current + motor["voltage_constant_V_s_rad"] * motor["gear_ratio"] * g * v
            powers.append(voltage * current)
            grip = 2 * contact / (self.mass * 9.80665)
            for key, value in (("traction_coefficient", grip), ("max_current_A", current), ("max_voltage_V", voltage)):
                found[key] = np.maximum(found.get(key, 0), abs(value))
        for key, limit in limits.items():
            if key in found:
                worst = np.maximum(worst, found[key] / limit)
        kept = lambda p: np.where(p < 0, self.problem["regeneration_efficiency"] * p, p)
        return kept(powers[0] + powers[1]) if self.problem["sharing"] == "bus" else kept(powers[0]) + kept(powers[1]), worst


def solve(problem, path, reversals, price_W, room):
    """A profile as check.py reads it; None where the grid has none."""
    model, limits = Model(problem, path), problem["limits"]
    even = 0.5 * (1 - np.cos(np.pi * np.linspace(0, 1, SEGMENTS + 1))) * path.length
    s = np.unique(np.concatenate([even, path.knots, reversals]))
    s = s[np.concatenate([[True], np.diff(s) > 1e-6 * path.length])]
    s[-1] = path.length
    bend = np.maximum(abs(path.curvature(s)), 1e-12)
    cap = np.minimum(limits["speed_m_s"], np.sqrt(limits.get("lateral_acceleration_m_s2", np.inf) / bend))
    cap = np.minimum(cap, limits.get("yaw_rate_rad_s", np.inf) / bend)
    speeds = None
    for width in BANDS:
        center = cap / 2 if speeds is None else speeds
        levels = np.clip(center[:, None] + cap[:, None] * width * np.linspace(-1, 1, LEVELS + 1), 1e-4 * cap[:, None], cap[:, None])
        levels[0], levels[-1] = problem["end_speeds_m_s"]
        found = best(model, s, levels**2, price_W, room)
        if found is not None:
            speeds = found
    return None if speeds is None else {"s_m": s.tolist(), "speed_m_s": speeds.tolist()}


def best(model, s, b, price_W, room):
    value, choice = np.zeros(b.shape[1]), []
    for k in range(len(s) - 2, -1, -1):
        total = model.cost(k, s, b[k], b[k + 1], price_W, room) + value[None, :]
        choice.append(total.argmin(1))
        value = total.min(1)
    if not np.isfinite(value[0]):
        return None
    j, chosen = 0, [0]
    for row in reversed(choice):
        j = row[j]
        chosen.append(j)
    return np.sqrt(b[np.arange(len(s)), chosen])
