"""Profiles driven by a wheel-speed controller in MuJoCo: rigid bodies, contacts, casters, motors as actuators.

The controller has no knowledge of the program's model beyond the reference speeds of the wheels: PI at 100 Hz, encoder
steps, 20 ms of latency, voltage held between its steps. There is no pose controller: what the floor does to the heading
shows up as distance from the path. With a fourth of the physics step the energies change by less than 0.05 %.
"""

import math

import numpy as np

from common import Path, package

PERIOD_S, LATENCY_PERIODS, SUBSTEPS = 0.01, 2, 5
ENCODER_STEPS = 4096 * 8  # per turn of the wheel
BANDWIDTH_PER_S = 12.0
TIRE_FRICTION, CASTER_GAP_M = 0.9, 3e-4
SETTLE_S = 1.5
WORLDS = {"calm": {}, "payload error": {"payload_factor": 1.3}, "slope": {"grade": 0.01}}


def model_text(problem, payload_factor=1.0, grade=0.0):
    robot, pay = problem["robot_values"], problem["payload_kg"] * payload_factor
    motor, r, l = robot["motor"], robot["wheel_radius_m"], robot["half_track_m"]
    across, spin = robot["wheel_diameter_inertia_kg_m2"], robot["wheel_axle_inertia_kg_m2"]
    body, d = min(spin, 1.9 * across), robot["center_of_mass_offset_m"]  # a body's inertias obey A + B > C
    wheels, motors = "", ""
    for side, (name, sign) in enumerate((("left", 1), ("right", -1))):
        K = motor["torque_constant_Nm_A"][side] * motor["gear_ratio"][side]
        Kv = motor["voltage_constant_V_s_rad"][side] * motor["gear_ratio"][side]
        ohm = motor["resistance_ohm"][side]
        wheels += (
            f'<body name="{name}" pos="0 {sign * l} 0"><joint name="{name}" type="hinge" axis="0 1 0" '
            f'damping="{motor["viscous_friction_Nm_s_rad"][side]}" frictionloss="{motor["friction_torque_Nm"][side]}" '
            f'armature="{spin - body}" solreffriction="0.005 1"/>'
            f'<inertial pos="0 0 0" mass="{robot["wheel_mass_kg"]}" diaginertia="{across} {body} {across}"/>'
            f'<geom type="ellipsoid" size="{r} {0.3 * r} {r}" contype="0" conaffinity="1" priority="2" '
            f'solref="0.006 1" friction="{TIRE_FRICTION} 1e-5 1e-5"/></body>\n'
        )
        motors += (
            f'<general joint="{name}" gaintype="fixed" gainprm="{K / ohm}" biastype="affine" '
            f'biasprm="0 0 {-K * Kv / ohm}"/>\n'
        )
    yaw, load = robot["chassis_yaw_inertia_kg_m2"], robot["payload_yaw_inertia_m2"] * pay
    casters = "".join(
        f'<geom type="sphere" size="{0.3 * r}" pos="{x} 0 {0.3 * r + CASTER_GAP_M - r}" contype="0" '
        'conaffinity="1" priority="1" condim="1" solref="0.006 1"/>'
        for x in (l, -l)
    )
    payload = (
        f'<body pos="{d} 0 0"><inertial pos="0 0 0" mass="{pay}" diaginertia="{load} {load} {load}"/></body>' if pay > 0 else ""
    )
    g = 9.80665
    return f"""<mujoco><compiler angle="radian" inertiafromgeom="false"/>
<option timestep="{PERIOD_S / SUBSTEPS}" integrator="implicitfast" cone="elliptic" impratio="100" gravity="{-g * grade} 0 {-g}"/>
<worldbody><geom name="floor" type="plane" size="500 500 1" contype="1" conaffinity="0"/>
<body name="chassis" pos="0 0 {r}"><freejoint/>
<inertial pos="{d} 0 0" mass="{robot['chassis_mass_kg']}" diaginertia="{yaw} {yaw} {yaw}"/>
{casters}{payload}{wheels}</body></worldbody><actuator>{motors}</actuator></mujoco>"""


class Reference:
    """Speed and place of a profile at a time."""

    def __init__(self, solution):
        self.s, self.v = np.array(solution["s_m"]), np.array(solution["speed_m_s"])
        dt = 2 * np.diff(self.s) / (self.v[1:] + self.v[:-1])
        self.t = np.concatenate([[0], np.cumsum(dt)])
        self.duration = self.t[-1] + solution.get("wait_s", 0.0)

    def at(self, t):
        v = np.interp(t, self.t, self.v)
        k = np.clip(np.searchsorted(self.t, t, side="right") - 1, 0, len(self.s) - 2)
        a = (self.v[k + 1] - self.v[k]) / (self.t[k + 1] - self.t[k])
        tau = np.clip(t - self.t[k], 0, self.t[k + 1] - self.t[k])
        return self.s[k] + self.v[k] * tau + a * tau**2 / 2, v


def drive(problem, solution, payload_factor=1.0, grade=0.0):
    """Energy at the supply, time of arrival, distance from the path and from the goal as driven."""
    mujoco = package("mujoco")
    model = mujoco.MjModel.from_xml_string(model_text(problem, payload_factor, grade))
    data = mujoco.MjData(model)
    robot, path, reference = problem["robot_values"], Path(problem), Reference(solution)
    motor, r, l = robot["motor"], robot["wheel_radius_m"], robot["half_track_m"]
    K = np.array(motor["torque_constant_Nm_A"]) * motor["gear_ratio"]
    Kv = np.array(motor["voltage_constant_V_s_rad"]) * motor["gear_ratio"]
    ohm, most_V = np.array(motor["resistance_ohm"]), problem["limits"].get("max_voltage_V", math.inf)
    mass = robot["chassis_mass_kg"] + 2 * robot["wheel_mass_kg"] + problem["payload_kg"]
    inertia = mass * r * r / 2 + robot["wheel_axle_inertia_kg_m2"]
    gain = BANDWIDTH_PER_S * inertia * ohm / K  # PI that cancels the motor's own pole
    integral_gain = gain * (K * Kv / ohm + np.array(motor["viscous_friction_Nm_s_rad"])) / inertia
    data.qpos[3:7] = [1, 0, 0, 0]
    mujoco.mj_step(model, data, 100)  # the casters settle
    data.qvel[:] = 0
    wheel_at = [model.jnt_qposadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, n)] for n in ("left", "right")]
    origin, step_rad = data.qpos[:2].copy(), 2 * math.pi / ENCODER_STEPS
    wheels = data.qpos[wheel_at].copy()
    seen, integral = np.floor(wheels / step_rad) * step_rad, np.zeros(2)
    pending = [np.zeros(2)] * LATENCY_PERIODS
    periods = int(math.ceil((reference.duration + SETTLE_S) / PERIOD_S))
    watts, places = np.empty((periods, 2)), np.empty((periods, 2))
    times = (np.arange(periods) + 1) * PERIOD_S
    s, v = reference.at(times)
    wanted = np.stack([(1 + sign * l * path.curvature(s)) / r * v for sign in (-1, 1)], 1)
    for i in range(periods):
        now = np.floor(data.qpos[wheel_at] / step_rad) * step_rad
        error = wanted[i] - (now - seen) / PERIOD_S
        seen, integral = now, integral + error * PERIOD_S
        pending.append(np.clip(gain * error + integral_gain * integral, -most_V, most_V))
        volts = pending.pop(0)
        data.ctrl[:] = volts
        mujoco.mj_step(model, data, SUBSTEPS)
        turned, wheels = data.qpos[wheel_at] - wheels, data.qpos[wheel_at].copy()
        watts[i] = volts * (volts - Kv * turned / PERIOD_S) / ohm  # mean of V i at constant V, exact
        places[i] = data.qpos[:2] - origin
    return judge_drive(problem, path, reference, watts, places, times)


def last_motion(places, times):
    """When the last centimetre of the way begins."""
    far = np.linalg.norm(places - places[-1], axis=1) > 0.01
    return float(times[np.nonzero(far)[0][-1]])


def judge_drive(problem, path, reference, watts, places, times):
    eta = problem["regeneration_efficiency"]
    kept = lambda p: np.where(p < 0, eta * p, p)
    drawn = kept(watts.sum(1)) if problem["sharing"] == "bus" else kept(watts).sum(1)
    _, line, _ = path.places(count=400)
    arrival, planned = last_motion(places, times), last_motion(reference.at(times)[0][:, None], times)
    ended = reference.duration + max(0.0, arrival - planned)
    until = times <= ended
    distance = np.array([np.min(np.hypot(*(line - p).T)) for p in places[::10]])
    return {
        "energy_J": float(drawn[until].sum() * PERIOD_S + problem["standby_W"] * ended),
        "motion_J": float(drawn[until].sum() * PERIOD_S),
        "late_s": arrival - planned,
        "off_path_m": float(distance.max()),
        "off_goal_m": float(np.linalg.norm(places[-1] - line[-1])),
    }
