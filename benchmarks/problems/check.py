#!/usr/bin/env python3
"""Judges speed profiles against problems.json: energy, duration, use of each limit. Needs numpy only.

usage: check.py [SOLUTIONS.json]     README.md states the model, the formats and the rules.
"""
import json, pathlib, sys
import numpy as np

HERE, TOLERANCE = pathlib.Path(__file__).parent, 1e-6


def evaluate(problem, robot, solution):
    """Energy (J), duration (s) and use of the limits of a profile whose squared speed is linear between its nodes."""
    r, l, d, pay = robot["wheel_radius_m"], robot["half_track_m"], robot["center_of_mass_offset_m"], problem["payload_kg"]
    m_c, m_w, limits = robot["chassis_mass_kg"], robot["wheel_mass_kg"], problem["limits"]
    mass, mu = m_c + 2 * m_w + pay, (m_c + pay) * d
    yaw = (robot["chassis_yaw_inertia_kg_m2"] + robot["payload_yaw_inertia_m2"] * pay + (m_c + pay) * d * d
           + 2 * m_w * l * l + 2 * robot["wheel_diameter_inertia_kg_m2"])
    knots, bend, nodes = (np.array(x, float) for x in (*problem["path"].values(), solution["s_m"]))
    speeds, wait = np.array(solution["speed_m_s"], float), solution.get("wait_s", 0.0)
    if not (abs(nodes[[0, -1]] - knots[[0, -1]]).max() < 1e-9 and (np.diff(nodes) > 0).all()
            and (speeds[1:-1] > 0).all() and abs(speeds[[0, -1]] - problem["end_speeds_m_s"]).max() < 1e-9 and wait >= 0):
        return {"energy_J": np.nan, "duration_s": np.nan, "uses": {"form": np.inf}}
    zeros = [knots[i] + (k - bend[i]) / (bend[i + 1] - bend[i]) * (knots[i + 1] - knots[i])  # where a wheel reverses
             for k in (1 / l, -1 / l) for i in range(len(knots) - 1) if (bend[i] - k) * (bend[i + 1] - k) < 0]
    more = np.array([x for x in (*knots, *zeros) if abs(nodes - x).min() > 1e-9])
    at = np.sort(np.concatenate([nodes, more]))
    v = np.sqrt(np.interp(at, nodes, speeds**2))
    ds, a = np.diff(at), np.diff(v**2) / (2 * np.diff(at))
    dt, k0 = 2 * ds / (v[:-1] + v[1:]), np.interp(at[:-1], knots, bend)
    slope = (np.diff(bend) / np.diff(knots))[np.searchsorted(knots, (at[:-1] + at[1:]) / 2) - 1][:, None]
    x, w = np.polynomial.legendre.leggauss(8)
    tau = np.concatenate([[0, 1], *((i + (x + 1) / 2) / 4 for i in range(4))])  # ends for the limits, Gauss for the energy
    weight = np.concatenate([[0, 0], np.tile(w / 8, 4)])
    t, a = tau * dt[:, None], a[:, None]
    u = v[:-1, None] + a * t
    b, k = u**2, k0[:, None] + slope * (v[:-1, None] * t + a * t**2 / 2)
    force, moment = mass * a - mu * k**2 * b, yaw * (k * a + slope * b) + mu * k * b
    uses, power = {"speed_m_s": u, "acceleration_m_s2": np.maximum(a, 0), "deceleration_m_s2": np.maximum(-a, 0),
                   "lateral_acceleration_m_s2": k * b, "yaw_rate_rad_s": k * u, "yaw_acceleration_rad_s2": k * a + slope * b}, []
    for side, sign in enumerate((-1, 1)):  # left, right
        motor = {key: value[side] for key, value in robot["motor"].items()}
        g, contact = (1 + sign * l * k) / r, force / 2 + sign * moment / (2 * l)
        torque = (r * contact + robot["wheel_axle_inertia_kg_m2"] * (g * a + sign * l * slope * b / r)
                  + motor["viscous_friction_Nm_s_rad"] * g * u
                  + motor["friction_torque_Nm"] * np.sign(g.sum(1))[:, None])
        current = torque / (motor["torque_constant_Nm_A"] * motor["gear_ratio"])
        voltage = motor["resistance_ohm"] * current + motor["voltage_constant_V_s_rad"] * motor["gear_ratio"] * g * u
        power.append(voltage * current)
        grip = 2 * contact / (mass * 9.80665)
        for key, value in (("traction_coefficient", grip), ("max_current_A", current), ("max_voltage_V", voltage)):
            uses[key] = np.maximum(uses.get(key, 0), abs(value))
    kept = lambda p: np.where(p < 0, problem["regeneration_efficiency"] * p, p)
    drawn = kept(power[0] + power[1]) if problem["sharing"] == "bus" else kept(power[0]) + kept(power[1])
    uses, duration = {key: abs(uses[key]).max() / limit for key, limit in limits.items()}, dt.sum() + wait
    asked = problem["time"].get("duration_s")
    if asked:
        uses["duration_s"] = duration / asked if problem["time"]["mode"] == "at_most" else 1 + abs(duration / asked - 1)
    return {"energy_J": ((drawn @ weight) * dt).sum() + problem["standby_W"] * duration, "duration_s": duration, "uses": uses}


def verdict(problem, result):
    """Value, and what it is worth."""
    value, best = result["duration_s" if problem["time"]["mode"] == "least" else "energy_J"], problem["best"]
    limit, use = max(result["uses"].items(), key=lambda item: item[1])
    if not use <= 1 + TOLERANCE:
        return value, f"BREAKS {limit} by {use - 1:.2g}"
    if value < best["lower_bound"] * (1 - TOLERANCE):
        return value, "BELOW THE BOUND"
    return value, "better" if value < best["value"] * (1 - TOLERANCE) else "valid"


if __name__ == "__main__":
    data = json.loads((HERE / "problems.json").read_text())
    given = json.loads(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE / "solutions.json").read_text())
    wrong = 0
    for problem in (p for p in data["problems"] if p["id"] in given):
        value, words = verdict(problem, evaluate(problem, data["robots"][problem["robot"]], given[problem["id"]]))
        print(f"{problem['id']} {value:.9g} best {problem['best']['value']:.9g} bound {problem['best']['lower_bound']:.9g} {words}")
        wrong += words.isupper() or words.startswith("BREAKS")
    sys.exit(wrong > 0)
