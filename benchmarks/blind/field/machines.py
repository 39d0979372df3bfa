"""Three robots of the field generator: nominal constants, the robot file, and the machine as it was really built.

ASSUMED, all constants: no robot of a maker. Each differs from its file by errors of the sizes that the file states.
"""
import copy

GRAVITY_m_s2 = 9.80665
# Constants of a robot file in SI units (K: torque constant times gear ratio, at the wheel, in Nm/A).
# T: friction left and right; v, a, w: usual speed, acceleration and yaw rate; load: greatest payload; slow_s, lidar_s, log_s:
# periods of the battery's monitor, the localizer and the log.
ROBOTS = {
    "courier": dict(r=0.075, l=0.15, d=0.01, m_c=8.6, m_w=0.7, I_c=0.16, k_p=0.02, d_p=0.0, I_a=0.0125, I_w=0.0022, I_d=0.0011, n=10.0,
                    K=0.5, R=1.6, nu=0.004, T=(0.085, 0.092), U_max=24.0, i_max=6.0, standby=6.0, eta=0.0, U=25.6, R_b=0.06, Wh=150.0,
                    load=5.0, v=0.9, a=0.6, w=1.6, counts=163840, lsb_A=0.002, lsb_V=0.01, slow_s=0.02, lidar_s=0.06, log_s=0.02),
    "porter": dict(r=0.1, l=0.25, d=0.03, m_c=74.0, m_w=3.0, I_c=6.5, k_p=0.06, d_p=0.05, I_a=0.06, I_w=0.016, I_d=0.009, n=15.0,
                   K=1.8, R=1.2, nu=0.03, T=(0.95, 0.88), U_max=48.0, i_max=12.0, standby=28.0, eta=0.0, U=51.0, R_b=0.08, Wh=960.0,
                   load=40.0, v=1.2, a=0.5, w=1.0, counts=245760, lsb_A=0.005, lsb_V=0.02, slow_s=0.1, lidar_s=0.08, log_s=0.02),
    "hauler": dict(r=0.125, l=0.32, d=0.06, m_c=280.0, m_w=10.0, I_c=36.0, k_p=0.1, d_p=0.02, I_a=0.52, I_w=0.1, I_d=0.06, n=20.0,
                   K=3.2, R=0.9, nu=0.12, T=(3.3, 3.1), U_max=80.0, i_max=25.0, standby=60.0, eta=0.5, U=76.0, R_b=0.05, Wh=3000.0,
                   load=200.0, v=1.3, a=0.4, w=0.7, counts=327680, lsb_A=0.01, lsb_V=0.04, slow_s=0.2, lidar_s=0.1, log_s=0.04),
}
UNCERTAINTY = {"T": 0.015, "nu": 0.05, "R": 0.01, "I_c": 0.04, "I_a": 0.02, "m_c": 0.005, "K": 0.005, "r": 0.003, "l": 0.006,
               "load_factor": 0.01, "standby": 0.01}
KEYS = {"T": "friction_torque_Nm", "nu": "viscous_friction_Nm_s_rad", "R": "resistance_ohm", "I_c": "chassis_yaw_inertia_kg_m2",
        "I_a": "wheel_axle_inertia_kg_m2", "m_c": "chassis_mass_kg", "K": "torque_constant_Nm_A", "r": "wheel_radius_m",
        "l": "half_track_m", "load_factor": "payload_kg", "standby": "standby_W"}
SIDED = ("K", "R", "nu", "T", "r")  # a value for each wheel


def nominal(name):
    """The constants of a robot's file, sided ones as [left, right]."""
    machine = {**copy.deepcopy(ROBOTS[name]), "name": name, "load_factor": 1.0}
    for key in SIDED:
        value = machine[key]
        machine[key] = list(value) if isinstance(value, tuple) else [value, value]
    return machine


def clipped_normal(rng):
    """A standard normal number within 2.5."""
    return max(-2.5, min(2.5, rng.normal()))


def built(name, rng):
    """The machine as built: each constant off by its stated relative uncertainty; friction by one error per side."""
    machine = nominal(name)
    for key, sigma in UNCERTAINTY.items():
        if key == "T":
            machine[key] = [value * (1 + sigma * clipped_normal(rng)) for value in machine[key]]
        else:
            scale(machine, key, 1 + sigma * clipped_normal(rng))
    return machine


def scale(machine, key, factor):
    """Multiply a constant, both sides of a sided one."""
    machine[key] = [value * factor for value in machine[key]] if key in SIDED else machine[key] * factor


def mass(machine, payload_kg=0.0):
    """Total mass in kg."""
    return machine["m_c"] + 2 * machine["m_w"] + payload_kg


def robot_yaml(name):
    """Text of the nominal robot file."""
    m = nominal(name)
    uncertainty = ", ".join(f"{KEYS[key]}: {sigma:g}" for key, sigma in UNCERTAINTY.items())
    constant = m["K"][0] / m["n"]
    return (f"schema: joulepath/robot/1\nname: {name}\n"
            f"geometry: {{wheel_radius_m: {m['r'][0]:g}, half_track_m: {m['l']:g}, center_of_mass_offset_m: {m['d']:g}}}\n"
            f"inertia: {{chassis_mass_kg: {m['m_c']:g}, wheel_mass_kg: {m['m_w']:g}, chassis_yaw_inertia_kg_m2: {m['I_c']:g}, "
            f"payload_yaw_inertia_m2: {m['k_p']:g}, wheel_axle_inertia_kg_m2: {m['I_a']:g}, "
            f"wheel_diameter_inertia_kg_m2: {m['I_d']:g}}}\npayload_offset_m: {m['d_p']:g}\n"
            f"motor: {{gear_ratio: {m['n']:g}, resistance_ohm: {m['R'][0]:g}, torque_constant_Nm_A: {constant:g}, "
            f"voltage_constant_V_s_rad: {constant:g}, viscous_friction_Nm_s_rad: {m['nu'][0]:g}, "
            f"friction_torque_Nm: {{left: {m['T'][0]:g}, right: {m['T'][1]:g}}}, max_voltage_V: {m['U_max']:g}, "
            f"max_current_A: {m['i_max']:g}}}\n"
            f"limits: {{speed_m_s: {1.3 * m['v']:g}, acceleration_m_s2: {1.5 * m['a']:g}, deceleration_m_s2: {1.5 * m['a']:g}, "
            f"lateral_acceleration_m_s2: 1.5, yaw_rate_rad_s: {1.3 * m['w']:g}, yaw_acceleration_rad_s2: {3 * m['w']:g}, "
            f"max_payload_kg: {m['load']:g}}}\n"
            f"power: {{standby_W: {m['standby']:g}, regeneration_efficiency: {m['eta']:g}}}\n"
            f"battery: {{capacity_Wh: {m['Wh']:g}, open_circuit_voltage_V: {m['U']:g}, internal_resistance_ohm: {m['R_b']:g}}}\n"
            f"uncertainty: {{{uncertainty}}}\n")


def truth_text(machine):
    """The built machine's constants in one line of YAML, in the units of a robot file."""
    parts = []
    for key in UNCERTAINTY:
        value, per = machine[key], machine["n"] if key == "K" else 1.0
        name = "payload_factor" if key == "load_factor" else KEYS[key]
        parts.append(f"{name}: {{left: {value[0] / per:.6g}, right: {value[1] / per:.6g}}}" if key in SIDED else f"{name}: {value:.6g}")
    return "parameters: {" + ", ".join(parts) + "}"
