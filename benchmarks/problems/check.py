#!/usr/bin/env python3
"""Judges speed profiles against problems.json: energy, duration, use of each limit. Needs numpy only.

usage: check.py [SOLUTIONS.json]     README.md states the model, the formats and the rules.
"""
import json, pathlib, sys
import numpy as np

HERE, TOLERANCE, STRICT, INSTANT, PIECES = pathlib.Path(__file__).parent, 1e-6, 1e-9, 1e-12, 1024


def profile(problem, solution):
    """Times, places, speeds at the nodes, acceleration and jerk from each node on; refuses what is no way from end to end."""
    jerky, end_m_s = "jerk_m_s3" in solution, problem["end_speeds_m_s"][1]
    x, y = (np.array(solution[key], float) for key in (("time_s", "jerk_m_s3") if jerky else ("s_m", "speed_m_s")))
    sums, steps, begin_m_s = lambda parts: np.concatenate([[0], np.cumsum(parts)]), np.diff(x), problem["end_speeds_m_s"][0]
    if jerky:  # speed and acceleration have no jumps: they follow from the jerk
        a = sums(y * steps)
        v = begin_m_s + sums(steps * (a[:-1] + steps * y / 2))
        t, s, j = x, sums(steps * (v[:-1] + steps * (a[:-1] / 2 + steps * y / 6))), y
    else:
        t, s, v, j = sums(2 * steps / (y[1:] + y[:-1])), x, y, np.zeros(len(steps))
        a = np.append((y[1:] ** 2 - y[:-1] ** 2) / (2 * steps), 0)
    misfit = [x[0], s[-1] - problem["path"]["s_m"][-1], v[0] - begin_m_s, v[-1] - end_m_s, a[-1]]
    held = x.ndim == y.ndim == 1 and (steps > 0).all() and np.isfinite(t).all() and (jerky or (v[1:-1] > 0).all())
    held &= np.diff(t).min() > INSTANT * t[-1]  # a piece that takes no time would be judged by nobody
    held &= 0 <= solution.get("wait_s", 0) < np.inf and not (end_m_s and solution.get("wait_s"))
    if not (held and np.abs(misfit).max() <= (TOLERANCE if jerky else STRICT)):
        raise ValueError("form")
    return t, s, v, a, j


def states(nodes, times, piece=None):
    """Place, speed and acceleration at times, of the piece that begins there or of one that is given."""
    t, s, v, a, j = nodes
    k = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(j) - 1) if piece is None else piece
    h = times - t[k]
    return s[k] + h * (v[k] + h * (a[k] / 2 + h * j[k] / 6)), v[k] + h * (a[k] + h * j[k] / 2), a[k] + h * j[k]


def instants(nodes, places):
    """Times of the nodes and of the places, these by bisection."""
    low, high = np.zeros(len(places)), np.full(len(places), nodes[0][-1])
    for _ in range(60):
        middle = (low + high) / 2
        early = states(nodes, middle)[0] < places
        low, high = np.where(early, middle, low), np.where(early, high, middle)
    t = nodes[0]
    after = np.clip(np.searchsorted(t, high), 1, len(t) - 1)  # a place that only rounding parts from a node is that node's
    return np.unique(np.concatenate([t, high[np.minimum(abs(t[after] - high), abs(high - t[after - 1])) > INSTANT * t[-1]]]))


def evaluate(problem, robot, solution):
    """Energy (J), duration (s) and use of the limits of a profile."""
    r, l, d, pay = robot["wheel_radius_m"], robot["half_track_m"], robot["center_of_mass_offset_m"], problem["payload_kg"]
    m_c, m_w, limits, path = robot["chassis_mass_kg"], robot["wheel_mass_kg"], problem["limits"], problem["path"]
    mass, mu, along = m_c + 2 * m_w + pay, (m_c + pay) * d, 0 if problem.get("kind") == "turn" else 1
    yaw = (robot["chassis_yaw_inertia_kg_m2"] + robot["payload_yaw_inertia_m2"] * pay + (m_c + pay) * d * d
           + 2 * m_w * l * l + 2 * robot["wheel_diameter_inertia_kg_m2"])
    knots, bend = np.array(path["s_m"], float), np.array(path["curvature_per_m"], float)
    try:
        nodes, wait = profile(problem, solution), solution.get("wait_s", 0)
    except (AttributeError, KeyError, TypeError, ValueError, IndexError):
        return {"energy_J": np.nan, "duration_s": np.nan, "uses": {"form": np.inf}}
    zeros = [knots[i] + (k - bend[i]) / (bend[i + 1] - bend[i]) * (knots[i + 1] - knots[i])  # where a wheel reverses
             for k in (along / l, -along / l) for i in range(len(knots) - 1) if (bend[i] - k) * (bend[i + 1] - k) < 0]
    at = instants(nodes, np.concatenate([knots, zeros, np.linspace(0, knots[-1], PIECES + 1)]))
    x, w = np.polynomial.legendre.leggauss(8)
    tau = np.concatenate([[0, 1], *((i + (x + 1) / 2) / 4 for i in range(4))])  # ends for the limits, Gauss for the energy
    weight = np.concatenate([[0, 0], np.tile(w / 8, 4)])
    dt, middle = np.diff(at), (at[1:] + at[:-1]) / 2
    piece = np.clip(np.searchsorted(nodes[0], middle) - 1, 0, len(nodes[4]) - 1)
    s, u, a = states(nodes, at[:-1, None] + tau * dt[:, None], piece[:, None])
    k, b = np.interp(s, knots, bend), u**2
    slope = (np.diff(bend) / np.diff(knots))[np.clip(np.searchsorted(knots, states(nodes, middle)[0]) - 1, 0, len(knots) - 2)][:, None]
    force, moment = along * mass * a - mu * k**2 * b, yaw * (k * a + slope * b) + along * mu * k * b
    uses, power = {"speed_m_s": along * u, "acceleration_m_s2": along * np.maximum(a, 0), "lateral_acceleration_m_s2": along * k * b,
                   "deceleration_m_s2": along * np.maximum(-a, 0), "yaw_rate_rad_s": k * u,
                   "jerk_m_s3": nodes[4] if "jerk_m_s3" in solution else np.inf,  # steps of the acceleration
                   "yaw_acceleration_rad_s2": k * a + slope * b}, []
    for side, sign in enumerate((-1, 1)):  # left, right
        motor = {key: value[side] for key, value in robot["motor"].items()}
        g, contact = (along + sign * l * k) / r, force / 2 + sign * moment / (2 * l)
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
    uses, duration = {key: np.abs(uses[key]).max() / limit for key, limit in limits.items()}, nodes[0][-1] + wait
    if u.min() < -TOLERANCE:  # backwards between the nodes
        uses["form"] = np.inf
    asked = problem["time"].get("duration_s")
    if asked:
        uses["duration_s"] = duration / asked if problem["time"]["mode"] == "at_most" else 1 + abs(duration / asked - 1)
    return {"energy_J": ((drawn @ weight) * dt).sum() + problem["standby_W"] * duration, "duration_s": duration, "uses": uses}


def verdict(problem, result):
    """Value, and what it is worth."""
    value, best = result["duration_s" if problem["time"]["mode"] == "least" else "energy_J"], problem["best"]
    limit, use = max(result["uses"].items(), key=lambda item: item[1])
    if not (np.isfinite(value) and all(use <= 1 + TOLERANCE for use in result["uses"].values())):
        return value, f"BREAKS {limit} by {use - 1:.2g}"
    if value < best["lower_bound"] * (1 - TOLERANCE):
        return value, "BELOW THE BOUND"
    return value, "better" if value < best["value"] * (1 - TOLERANCE) and use <= 1 + STRICT else "valid"


def main(given):
    """One line per answer; 0 if all are within their limits and none lies below a bound."""
    data = json.loads((HERE / "problems.json").read_text())
    problems, wrong = {p["id"]: p for p in data["problems"]}, not given
    for name, solution in given.items():
        if name not in problems:
            value, words, best = np.nan, "NO SUCH PROBLEM", {"value": np.nan, "lower_bound": np.nan}
        else:
            best, robot = problems[name]["best"], data["robots"][problems[name]["robot"]]
            value, words = verdict(problems[name], evaluate(problems[name], robot, solution))
        print(f"{name} {value:.9g} best {best['value']:.9g} bound {best['lower_bound']:.9g} {words}")
        wrong |= words.isupper() or words.startswith("BREAKS")
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main(json.loads(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE / "solutions.json").read_text())))
