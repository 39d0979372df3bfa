#!/usr/bin/env python3
"""Plans of a robot without dry friction and with next to no mass against the closed form of its curves.

usage: elliptic_curves.py PROGRAM FOLDER

Such a robot takes c (v^2 + l^2 w^2) + P watts: v its speed (m/s), w its yaw rate (rad/s), l half its track
(m), P its standby. A curve of length L (m) in d tau^2 = ds^2 + l^2 d heading^2 costs at least 2 L sqrt(c
P), at the rate sqrt(P / c). The shortest curves in tau are sub-Riemannian geodesics of the motions of the
plane: a pendulum in twice the direction of motion phi, tan phi = l w / v, with elliptic functions for its
poses [MoiseevSachkov2010]. They stand here over the amplitude psi = pi/2 - phi (rad) with the modulus k, k
= P where the pendulum swings back and k = 1/P where it turns over. Limits only remove motions, so that the
closed form is a lower bound. A plan's ramps at both ends come on top.
"""

import csv
import json
import math
import pathlib
import subprocess
import sys

HALF_TRACK_M, RADIUS_M, STANDBY_W, VISCOUS_NM_S, ACCELERATION_M_S2, LEAST_KG = 0.2, 0.1, 10.0, 1.0, 4.0, 1e-3
WATTS_PER_SPEED = (
    2 * VISCOUS_NM_S * (1 + 1e-6 * VISCOUS_NM_S) / RADIUS_M**2
)  # c: friction and 1e-6 ohm, both wheels
ROBOT = {
    "schema": "joulepath/robot/1",
    "name": "viscous",
    "geometry": {"wheel_radius_m": RADIUS_M, "half_track_m": HALF_TRACK_M},
    "inertia": {
        "chassis_mass_kg": LEAST_KG,
        "wheel_mass_kg": 0,
        "chassis_yaw_inertia_kg_m2": 0,
        "payload_yaw_inertia_m2": 0,
        "wheel_axle_inertia_kg_m2": 0,
        "wheel_diameter_inertia_kg_m2": 0,
    },
    "motor": {
        "gear_ratio": 1,
        "resistance_ohm": 1e-6,
        "torque_constant_Nm_A": 1,
        "voltage_constant_V_s_rad": 1,
        "viscous_friction_Nm_s_rad": VISCOUS_NM_S,
        "friction_torque_Nm": 0,
    },
    "limits": {
        "speed_m_s": 10,
        "acceleration_m_s2": ACCELERATION_M_S2,
        "deceleration_m_s2": ACCELERATION_M_S2,
        "yaw_acceleration_rad_s2": ACCELERATION_M_S2 / HALF_TRACK_M,
    },
    "power": {"standby_W": STANDBY_W, "regeneration_efficiency": 0},
    "footprint": {"radius_m": 0.25},
}
CURVES = (
    (0.8, 0.5, 2.2),
    (0.5, 0.7, 2.2),
    (0.95, 0.4, 1.5),
    (0.99, 0.3, 2.8),
    (1.3, 0.5, 2.5),
    (1.05, 0.3, 2.8),
)  # P, psi, psi
LEAST_PERCENT, MOST_PERCENT, MOST_M = -0.05, 0.25, 0.006  # above the closed form with ramps, beside its curve
FLOOR = """image: floor.pgm
mode: trinary
resolution: 0.1
origin: [-5, -5, 0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.25
"""


def integral(function, end, parts=200):
    """From 0, by Simpson's rule; the functions are smooth, so that 12 digits are right."""
    h = end / parts
    weight = lambda i: 1 if i in (0, parts) else 4 if i % 2 else 2
    return h / 3 * sum(weight(i) * function(i * h) for i in range(parts + 1))


def pose(pendulum, psi, l=HALF_TRACK_M):
    """x, y (m), heading (rad) and tau (m) of a geodesic at an amplitude: elliptic integrals of both kinds."""
    k = min(pendulum, 1 / pendulum)
    root = lambda angle: math.sqrt(1 - (k * math.sin(angle)) ** 2)
    first, second = integral(lambda angle: 1 / root(angle), psi), integral(root, psi)
    if pendulum < 1:
        return l / k * (first - second), l / k * root(psi), psi - math.pi / 2, l * first
    return l * (first - second), l * k * math.cos(psi), -math.acos(k * math.sin(psi)), l * k * first


def plan(program, folder, start, goal):
    place = lambda pose: dict(zip(("x_m", "y_m", "heading_rad"), pose))
    mission = {
        "schema": "joulepath/mission/1",
        "robot": "robot.json",
        "map": "floor.yaml",
        "start": place(start),
        "stations": {"goal": place(goal)},
        "legs": [{"to": "goal"}],
    }
    (folder / "mission.json").write_text(json.dumps(mission))
    subprocess.run(
        [
            program,
            "plan",
            folder / "mission.json",
            "--out",
            folder / "out",
            "--force",
            "-q",
            "--without",
            "baselines,path_bound",
        ],
        check=True,
    )
    with open(folder / "out/trajectory.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    energy_J = json.loads((folder / "out/plan.json").read_text())["energy_J"]
    return energy_J, [(float(row["position_x_m"]), float(row["position_y_m"])) for row in rows]


def ramp_J(psi):
    """What reaching the rate takes more than having it, to first order: P/3 times the seconds of the ramp."""
    along, across = abs(math.sin(psi)), abs(math.cos(psi))
    return STANDBY_W / 3 * math.sqrt(STANDBY_W / WATTS_PER_SPEED) * max(along, across) / ACCELERATION_M_S2


def compared(program, folder, pendulum, begin, end):
    """What the plan takes above the closed form, without and with ramps (%); how far it is away (m)."""
    *start, before_m = pose(pendulum, begin)
    *goal, behind_m = pose(pendulum, end)
    least_J = 2 * (behind_m - before_m) * math.sqrt(WATTS_PER_SPEED * STANDBY_W)
    energy_J, places = plan(program, folder, start, goal)
    curve = [pose(pendulum, begin + (end - begin) * i / 400)[:2] for i in range(401)]
    beside_m = max(min(math.dist(place, at) for at in curve) for place in places)
    with_ramps_J = least_J + ramp_J(begin) + ramp_J(end)
    return 100 * (energy_J / least_J - 1), 100 * (energy_J / with_ramps_J - 1), beside_m


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "robot.json").write_text(json.dumps(ROBOT))
    (folder / "floor.pgm").write_bytes(b"P5\n100 100\n255\n" + b"\xfe" * 10000)
    (folder / "floor.yaml").write_text(FLOOR)
    failed = False
    for curve in CURVES:
        above, over, beside_m = compared(program, folder, *curve)
        bad = above < 0 or not (LEAST_PERCENT <= over <= MOST_PERCENT and beside_m <= MOST_M)
        failed = failed or bad
        print(
            f"P {curve[0]}, psi {curve[1]} to {curve[2]}: {above:.3f} % above the closed form, "
            f"{over:+.3f} % with ramps, {1000 * beside_m:.2f} mm beside it" + (" FAILED" if bad else "")
        )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
