"""What a case hides: effects of the catalog (names and parameters of docs/effects.md) and foreign ones.

A cause changes the built machine's constants, or sets constants of laws that are 0 in a null. Sizes are drawn
log-uniform between the smallest and the largest share of the robot's own scale of that effect.
"""
import math

import numpy as np

import days
from machines import GRAVITY_m_s2, mass, scale

SIDED = ("dragging_wheel", "current_sensor_offset")
# name: (first parameter, smallest, largest, share of negative signs); times scale_of(name).
CATALOG = {
    "rolling_resistance": ("coefficient", 0.05, 1.0, 0), "floor_patch": ("coefficient", 0.1, 2.0, 0),
    "stribeck_friction": ("torque_Nm", 0.15, 2.0, 0), "coulomb_friction": ("torque_Nm", 0.04, 0.6, 0.3),
    "dragging_wheel": ("torque_Nm", 0.08, 1.5, 0), "direction_dependent_friction": ("reverse_torque_Nm", 0.1, 1.5, 0),
    "viscous_friction": ("coefficient_Nm_s_rad", 0.05, 1.0, 0), "gear_efficiency": ("loss_fraction", 0.03, 0.3, 0),
    "turning_scrub": ("moment_Nm", 0.1, 1.5, 0), "quadratic_drag": ("coefficient_N_s2_m2", 0.08, 1.5, 0),
    "payload_mass_error": ("fraction", 0.08, 0.8, 0.5), "center_of_mass_offset": ("offset_m", 0.05, 0.6, 0.5),
    "yaw_inertia_error": ("fraction", 0.15, 1.5, 0), "wheel_radius_error": ("fraction", 0.012, 0.06, 0.5),
    "wheel_radius_mismatch": ("fraction", 0.003, 0.03, 0.5), "track_width_error": ("fraction", 0.02, 0.1, 0.5),
    "floor_slope": ("grade", 0.05, 0.6, 0), "winding_resistance_error": ("fraction", 0.05, 0.8, 0.2),
    "winding_heating": ("final_fraction", 0.08, 0.5, 0), "torque_constant_error": ("fraction", 0.02, 0.12, 0.5),
    "driver_voltage_drop": ("voltage_V", 0.08, 1.0, 0), "standby_power_error": ("power_W", 0.05, 0.8, 0.3),
    "regeneration_error": ("efficiency", 0.25, 0.8, 0), "supply_sag": ("resistance_ohm", 2.0, 10.0, 0),
    "current_sensor_offset": ("offset_A", 0.06, 0.6, 0.5), "current_sensor_gain": ("fraction", 0.02, 0.15, 0.5),
    "time_misalignment": ("delay_s", 0.015, 0.2, 0)}
# Foreign causes: (parameter of the label, smallest, largest, 0).
FOREIGN = {"loaded_teeth": ("loss_at_peak", 0.1, 0.45, 0), "tightening_hose": ("force_N", 0.1, 0.6, 0),
           "lagging_angle": ("lag_s", 0.15, 0.5, 0), "deflating_tyre": ("radius_fraction", 0.015, 0.06, 0),
           "late_brake": ("torque_Nm", 0.5, 4.0, 0), "weak_phase": ("fraction", 0.2, 1.5, 0)}
# Constants of the laws that a null has not.
ABSENT = dict(roll=0.0, patch=0.0, box=(0.0, 0.0, 0.0, 0.0), stribeck=0.0, stribeck_w=1.0, reverse=0.0, loss=0.0, scrub=0.0,
              air=0.0, grade=0.0, uphill=0.0, heat=0.0, heat_s=1.0, drop=0.0, teeth=0.0, hose=0.0, lag=0.0, flat=0.0, brake=0.0,
              phase=0.0, offset_A=[0.0, 0.0], gain=0.0, late_s=0.0)


def scale_of(name, m):
    """The robot's own scale of an effect's first parameter, in its unit."""
    torque, wheel_speed = sum(m["T"]) / 2, m["v"] / m["r"][0]
    force = torque / m["r"][0]
    scales = {
        "rolling_resistance": 2 * force / (mass(m) * GRAVITY_m_s2), "floor_patch": 2 * force / (mass(m) * GRAVITY_m_s2),
        "floor_slope": 2 * force / (mass(m) * GRAVITY_m_s2), "stribeck_friction": torque, "coulomb_friction": torque,
        "dragging_wheel": torque, "direction_dependent_friction": torque, "late_brake": torque,
        "viscous_friction": torque / wheel_speed, "turning_scrub": 2 * force * m["l"], "quadratic_drag": 2 * force / m["v"] ** 2,
        "center_of_mass_offset": m["l"], "driver_voltage_drop": 0.15 * m["K"][0] * wheel_speed, "standby_power_error": m["standby"],
        "supply_sag": m["R_b"], "current_sensor_offset": torque / m["K"][0], "tightening_hose": 2 * force, "lagging_angle": 1 / wheel_speed}
    return scales.get(name, 1.0)


def is_foreign(name):
    return name in FOREIGN


def drawn(name, m, runs, rng, size=0.0, share=0.0):
    """A cause with all its parameters; `size` in the first one's unit, or a share of half of the largest, or drawn."""
    key, low, high, negative = {**CATALOG, **FOREIGN}[name]
    side, sign = ("left", "right")[rng.integers(2)], -1 if rng.random() < negative else 1
    amount = math.exp(rng.uniform(math.log(low), math.log(high)))
    first = size or sign * scale_of(name, m) * (share * high / 2 if share else amount)
    if name in ("coulomb_friction", "payload_mass_error", "standby_power_error"):
        first = max(first, -0.4 * scale_of(name, m))
    cause = {"effect": name, "foreign": is_foreign(name), "side": side if name in SIDED else "", "parameters": {key: float(first)}}
    cause["parameters"].update(more_parameters(name, m, runs, rng))
    return cause


def more_parameters(name, m, runs, rng):
    """The parameters beyond the first."""
    if name == "floor_patch":
        return patch_on_the_way(runs, rng)
    if name == "floor_slope":
        return {"uphill_direction_rad": rng.uniform(-math.pi, math.pi)}
    if name == "stribeck_friction":
        return {"speed_rad_s": rng.uniform(0.1, 0.35) * m["v"] / m["r"][0]}
    if name == "winding_heating":
        return {"time_constant_s": rng.uniform(100, 600)}
    return {}


def patch_on_the_way(runs, rng):
    """A strip of the floor that holds about two fifths of the day's way."""
    paths = [days.path_of(run["command"], run["pose"]) for run in runs]
    x, y = (np.concatenate([path[k][np.abs(run["command"][0]) > 0.01] for path, run in zip(paths, runs)] or [[0.0]]) for k in (0, 1))
    start = rng.uniform(0.05, 0.5)
    edges = {"x_min_m": min(x, default=0) - 1, "x_max_m": max(x, default=0) + 1, "y_min_m": min(y, default=0) - 1, "y_max_m": max(y, default=0) + 1}
    axis, values = ("x", x) if np.ptp(x) >= np.ptp(y) else ("y", y)
    edges[f"{axis}_min_m"], edges[f"{axis}_max_m"] = np.quantile(values, [start, start + 0.4])
    return {key: round(float(value), 2) for key, value in edges.items()}


def applied(cause, m):
    """Change the machine's constants by a cause."""
    name, p = cause["effect"], cause["parameters"]
    size, k = next(iter(p.values())), ("left", "right").index(cause["side"] or "left")
    plain = {"rolling_resistance": "roll", "floor_patch": "patch", "stribeck_friction": "stribeck", "turning_scrub": "scrub",
             "direction_dependent_friction": "reverse", "gear_efficiency": "loss", "quadratic_drag": "air", "floor_slope": "grade",
             "winding_heating": "heat", "driver_voltage_drop": "drop", "current_sensor_gain": "gain", "time_misalignment": "late_s",
             "loaded_teeth": "teeth", "tightening_hose": "hose", "lagging_angle": "lag", "deflating_tyre": "flat", "late_brake": "brake",
             "weak_phase": "phase", "regeneration_error": "eta", "supply_sag": "R_b"}
    scaled = {"winding_resistance_error": "R", "torque_constant_error": "K", "yaw_inertia_error": "I_c", "wheel_radius_error": "r",
              "track_width_error": "l", "payload_mass_error": "load_factor"}
    if name in plain:
        m[plain[name]] = size
    elif name in scaled:
        scale(m, scaled[name], 1 + size)
    else:
        added(name, size, k, m)
    m["box"] = tuple(p.get(key, 0.0) for key in ("x_min_m", "x_max_m", "y_min_m", "y_max_m")) if name == "floor_patch" else m["box"]
    m["uphill"] = p.get("uphill_direction_rad", m["uphill"])
    m["stribeck_w"], m["heat_s"] = p.get("speed_rad_s", m["stribeck_w"]), p.get("time_constant_s", m["heat_s"])


def added(name, size, k, m):
    """Causes that add to a constant."""
    if name == "coulomb_friction":
        m["T"] = [value + size for value in m["T"]]
    elif name == "viscous_friction":
        m["nu"] = [value + size for value in m["nu"]]
    elif name == "dragging_wheel":
        m["T"][k] += size
    elif name == "center_of_mass_offset":
        m["d"], m["d_p"] = m["d"] + size, m["d_p"] + size
    elif name == "wheel_radius_mismatch":
        m["r"] = [m["r"][0] * (1 + size / 2), m["r"][1] * (1 - size / 2)]
    elif name == "standby_power_error":
        m["standby"] += size
    elif name == "current_sensor_offset":
        m["offset_A"] = list(m["offset_A"])
        m["offset_A"][k] += size
