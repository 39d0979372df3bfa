"""Wheel speeds driven in MuJoCo [Todorov2012]: rigid bodies, contacts, casters, motors as actuators.

The controller knows nothing of the program's model but the reference: PI on the wheels at 100 Hz, encoder steps, 20 ms of
latency, voltage held between its steps. A pose controller may correct the wheels' references; without it, what the floor
does to the heading shows up as distance from the path. With a fourth of the physics step the energies change by less
than 0.05 %.
"""

import math

import numpy as np

from common import Path, Reference, package

PERIOD_S, LATENCY_PERIODS, SUBSTEPS = 0.01, 2, 5
ENCODER_STEPS = 4096 * 8  # per turn of the wheel
BANDWIDTH_PER_S = 12.0
TIRE_FRICTION, CASTER_GAP_M = 0.9, 3e-4
SETTLE_S = 1.5
TRACKING_PER_S, ACROSS_PER_M2 = 2.0, 4.0  # of the pose controller
RESPONSE_PERIODS = 8  # of the wheels' loop: so late the robot is where the reference was
WORLDS = {"calm": {}, "payload error": {"payload_factor": 1.3}, "slope": {"grade": 0.01}}


def model_text(robot, pay, grade):
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


def followed(pose, wanted, speeds):
    """Speeds that lead back to a reference in motion: Kanayama's tracking law, with a turn towards its heading at rest."""
    away, (v, omega) = wanted - pose, speeds
    c, sine, turn = math.cos(pose[2]), math.sin(pose[2]), math.remainder(away[2], 2 * math.pi)
    ahead, aside = c * away[0] + sine * away[1], -sine * away[0] + c * away[1]
    return v * math.cos(turn) + TRACKING_PER_S * ahead, omega + ACROSS_PER_M2 * v * aside + TRACKING_PER_S * math.sin(turn)


def wheels_alone(_, speeds):
    """A guide that knows the reference speeds only."""
    return lambda i, pose, twist: speeds[i]


def pose_controller(poses, speeds):
    """A guide that corrects the reference speeds by the pose."""
    return lambda i, pose, twist: followed(pose, poses[max(0, i - RESPONSE_PERIODS)], speeds[i])


def pose_of(data):
    q = data.qpos[3:7]
    return (*data.qpos[:2], math.atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] ** 2 + q[3] ** 2)))


def execute(robot, payload_kg, most_V, start, count, guide, payload_factor=1.0, grade=0.0, disturb=None, most_A=math.inf, text=None):
    """Watts of each motor and poses at the ends of `count` periods, from the pose `start` at rest.

    guide(i, pose, (v, omega)): the reference (v, omega) of period i. disturb(i, model, data): changes the world before it.
    `text`: a model with joints left and right and voltages as controls, instead of model_text().
    """
    mujoco = package("mujoco")
    model = mujoco.MjModel.from_xml_string(text or model_text(robot, payload_kg * payload_factor, grade))
    data = mujoco.MjData(model)
    motor, r, l = robot["motor"], robot["wheel_radius_m"], robot["half_track_m"]
    K = np.array(motor["torque_constant_Nm_A"]) * motor["gear_ratio"]
    Kv = np.array(motor["voltage_constant_V_s_rad"]) * motor["gear_ratio"]
    ohm = np.array(motor["resistance_ohm"])
    mass = robot["chassis_mass_kg"] + 2 * robot["wheel_mass_kg"] + payload_kg
    inertia = mass * r * r / 2 + robot["wheel_axle_inertia_kg_m2"]
    gain = BANDWIDTH_PER_S * inertia * ohm / K  # PI that cancels the motor's own pole
    integral_gain = gain * (K * Kv / ohm + np.array(motor["viscous_friction_Nm_s_rad"])) / inertia
    x, y, heading = start
    turned_by = [math.cos(heading / 2), 0, 0, math.sin(heading / 2)]
    data.qpos[:2], data.qpos[3:7] = (x, y), turned_by
    mujoco.mj_step(model, data, 100)  # the casters settle
    data.qpos[:2], data.qpos[3:7], data.qvel[:] = (x, y), turned_by, 0
    wheel_at = [model.jnt_qposadr[mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, n)] for n in ("left", "right")]
    step_rad, arms, wheels = 2 * math.pi / ENCODER_STEPS, np.array([-l, l]), data.qpos[wheel_at].copy()
    seen, integral, pending = np.floor(wheels / step_rad) * step_rad, np.zeros(2), [np.zeros(2)] * LATENCY_PERIODS
    watts, driven = np.empty((count, 2)), np.empty((count, 3))
    pose, rates = start, np.zeros(2)
    for i in range(count):
        v, omega = guide(i, pose, (r * rates.mean(), r * (rates[1] - rates[0]) / (2 * l)))
        now = np.floor(data.qpos[wheel_at] / step_rad) * step_rad
        rates = (now - seen) / PERIOD_S
        error = (v + arms * omega) / r - rates
        seen, asked = now, gain * error + integral_gain * (integral + error * PERIOD_S)
        back, drop = Kv * rates, ohm * most_A
        given = np.clip(asked, np.maximum(-most_V, back - drop), np.minimum(most_V, back + drop))
        integral = np.where(given == asked, integral + error * PERIOD_S, integral)  # no windup at a limit
        pending.append(given)
        data.ctrl[:] = volts = pending.pop(0)
        if disturb:
            disturb(i, model, data)
        mujoco.mj_step(model, data, SUBSTEPS)
        turned, wheels = data.qpos[wheel_at] - wheels, data.qpos[wheel_at].copy()
        watts[i] = volts * (volts - Kv * turned / PERIOD_S) / ohm  # mean of V i at constant V, exact
        driven[i] = pose = pose_of(data)
    return watts, driven


def drawn_W(watts, regeneration_efficiency, sharing):
    """What the motors take from the supply."""
    kept = lambda p: np.where(p < 0, regeneration_efficiency * p, p)
    return kept(watts.sum(1)) if sharing == "bus" else kept(watts).sum(1)


def drive(problem, solution, **world):
    """Energy at the supply, time of arrival, distance from the path and from the goal as driven."""
    robot, path, reference = problem["robot_values"], Path(problem), Reference(problem, solution)
    times = (np.arange(math.ceil((reference.duration + SETTLE_S) / PERIOD_S)) + 1) * PERIOD_S
    s, v = reference.at(times)
    speeds = np.stack([v, path.curvature(s) * v], 1)
    guide = wheels_alone(None, speeds)
    most_V = problem["limits"].get("max_voltage_V", math.inf)
    watts, driven = execute(robot, problem["payload_kg"], most_V, (0, 0, 0), len(times), guide, **world)
    return judge_drive(problem, path, reference, watts, driven[:, :2], times)


def last_motion(places, times):
    """When the last centimetre of the way begins."""
    far = np.linalg.norm(places - places[-1], axis=1) > 0.01
    return float(times[np.nonzero(far)[0][-1]])


def judge_drive(problem, path, reference, watts, places, times):
    drawn = drawn_W(watts, problem["regeneration_efficiency"], problem["sharing"])
    _, line, _ = path.places(count=400)
    arrival, planned = last_motion(places, times), last_motion(reference.at(times)[0][:, None], times)
    ended = reference.duration + max(0.0, arrival - planned)
    until = times <= ended
    distance = np.array([np.min(np.hypot(*(line - p).T)) for p in places[::10]])
    return {
        "energy_J": float(drawn[until].sum() * PERIOD_S + problem["standby_W"] * ended),
        "late_s": arrival - planned,
        "off_path_m": float(distance.max()),
    }
