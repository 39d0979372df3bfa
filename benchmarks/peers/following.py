"""Section on the profile follower in an independent simulator: commands at 20 Hz from poses that are 50 ms old."""

import math
import tempfile
from pathlib import Path as File

import numpy as np

import floors
import plans
from common import package, spread, table
from mujoco_peer import PERIOD_S, RESPONSE_PERIODS, execute, last_motion, wheels_alone

ROBOTS = ("nomad_super_scout", "amr_150kg")
COMMAND_PERIODS, LATENCY_S = 5, 0.05
EFFECT_S = LATENCY_S + RESPONSE_PERIODS * PERIOD_S  # until the wheels turn as told
OVERTIME_S = 12.0
PUSH_N_KG, SLIPPERY, OBSTACLE_AHEAD_M = -1.0, 0.03, 1.0
TOLD_LATE_S = 1.0  # until a payload is known


class Following:
    """Guide of mujoco_peer.execute: the follower of each piece of a plan, one after the other."""

    def __init__(self, pieces, late_start_s=0.0, payload_factor=1.0, obstacle_s=None):
        self.pieces, self.late_start_s, self.payload_factor, self.obstacle_s = list(pieces), late_start_s, payload_factor, obstacle_s
        self.follower, self.active, self.pending, self.blocked = None, None, [], {}
        self.off_path, self.lateral_m, self.finished_s, self.replans, self.place = False, 0.0, None, 0, 0.0

    def __call__(self, i, pose, twist):
        t = i * PERIOD_S
        if i % COMMAND_PERIODS == 0 and self.pieces and not self.off_path and t >= max(self.late_start_s, self.pieces[0].start_s):
            self.command(t, pose, twist)
        while self.pending and self.pending[0][0] <= t + 1e-9:
            self.active = self.pending.pop(0)
        if self.active is None:
            return 0.0, 0.0
        since, command = self.active
        held = lambda value, slope: value + (t - since) * slope if value * (value + (t - since) * slope) > 0 else (value if slope == 0 else 0.0)
        return held(command.speed_m_s, command.acceleration_m_s2), held(command.yaw_rate_rad_s, command.yaw_acceleration_rad_s2)

    def command(self, t, pose, twist):
        piece = self.pieces[0]
        if self.follower is None:
            self.follower, self.place = package("joulepath").Follower(piece, period_s=COMMAND_PERIODS * PERIOD_S, latency_s=EFFECT_S), 0.0
        known = self.payload_factor if t >= TOLD_LATE_S else 1.0
        command = self.follower.command(t - EFFECT_S - piece.start_s, pose, *twist, payload_kg=known * piece.payload_kg, stop_at_m=self.stop_at(t, piece))
        self.pending.append((t + LATENCY_S, command))
        self.place, self.lateral_m, self.replans = command.s, max(self.lateral_m, abs(command.lateral_m)), self.replans + command.replanned
        self.off_path = command.state == "off_path"
        if command.state == "finished":
            self.pieces.pop(0)
            self.follower, self.finished_s = None, t

    def stop_at(self, t, piece):
        """Where the path is blocked, for four seconds from obstacle_s on."""
        if self.obstacle_s is None or not self.obstacle_s <= t < self.obstacle_s + 4 or piece.is_turn:
            return None
        place = self.blocked.setdefault(id(piece), self.place + OBSTACLE_AHEAD_M)
        return place if place < piece.length else None


def push(begin_s, force_N):
    """A force along the heading for a second."""

    def disturb(i, model, data):
        chassis = package("mujoco").mj_name2id(model, package("mujoco").mjtObj.mjOBJ_BODY, "chassis")
        active = begin_s <= i * PERIOD_S < begin_s + 1
        data.xfrc_applied[chassis, :3] = force_N * data.xmat[chassis].reshape(3, 3)[:, 0] if active else 0

    return disturb


def slippery(begin_s):
    """A floor almost without friction under the wheels for half a second."""
    usual = []

    def disturb(i, model, data):
        wheels = model.geom_priority == 2
        usual.append(model.geom_friction[wheels].copy()) if not usual else None
        active = begin_s <= i * PERIOD_S < begin_s + 0.5
        model.geom_friction[wheels] = [SLIPPERY, 1e-5, 1e-5] if active else usual[0]

    return disturb


def cases(robot, payload_kg, begin_s):
    """Disturbances by name: arguments of the guide, and those of the world."""
    mass_kg = robot["chassis_mass_kg"] + 2 * robot["wheel_mass_kg"] + payload_kg
    return {
        "none": ({}, {}),
        "push back, 1 N per kg for 1 s": ({}, {"disturb": push(begin_s, PUSH_N_KG * mass_kg)}),
        "almost no friction for 0.5 s": ({}, {"disturb": slippery(begin_s)}),
        "2 s late": ({"late_start_s": 2.0}, {}),
        "payload +30 %": ({"payload_factor": 1.3}, {"payload_factor": 1.3}),
        "obstacle for 4 s": ({"obstacle_s": begin_s}, {}),
    }


def followed(folder, robot, file, pieces, duration_s, guided, world):
    """One drive: joules until arrival with standby, seconds after the plan's end, as the simulator sees them."""
    times, columns, payload_kg = next(plans.legs_of(folder))
    guide = Following(pieces, **guided)
    count = math.ceil((duration_s + OVERTIME_S) / PERIOD_S)
    watts, driven = execute(robot, payload_kg, file["motor"]["max_voltage_V"], columns[0, :3], count, guide, most_A=file["motor"]["max_current_A"], **world)
    at = (np.arange(count) + 1) * PERIOD_S
    late_s = last_motion(driven[:, :2], at) - EFFECT_S - last_motion(columns[:, :2], times)
    ended_s = duration_s + max(0.0, late_s)
    return {
        "energy_J": plans.drawn_J(file, watts, EFFECT_S + ended_s) + file["power"]["standby_W"] * ended_s,
        "late_s": late_s,
        "end_m": float(np.hypot(*(driven[-1, :2] - columns[-1, :2]))),
        "arrived": not guide.pieces,
        "off_path": guide.off_path,
        "lateral_m": guide.lateral_m,
        "replans": guide.replans,
    }


def ideal(folder, robot, file):
    """The same plan with ideal tracking of the wheels' speeds: the reference speeds without period or latency."""
    drive = plans.drive(folder, robot, file, wheels_alone)
    return {key: drive[key] for key in ("energy_J", "late_s", "planned_J")}


def run(size):
    package("mujoco")
    jp = package("joulepath")
    rows, calm = [], {}
    with tempfile.TemporaryDirectory() as scratch:
        for name in ROBOTS:
            file, robot = plans.robot_file(name), plans.robot_values(name)
            payload_kg = 0.5 * file["limits"]["max_payload_kg"]
            missions = floors.planned(name, payload_kg, size(20, 2), File(scratch))
            stated = jp.Robot.load(plans.SCENARIOS / f"robots/{name}.yaml")
            drives, best = {}, [ideal(folder, robot, file) for _, folder in missions]
            for _, folder in missions:
                pieces = jp.drives(folder, stated)
                duration_s = pieces[-1].end_s
                for case, (guided, world) in cases(robot, payload_kg, 0.3 * duration_s).items():
                    drives.setdefault(case, []).append(followed(folder, robot, file, pieces, duration_s, guided, world))
            calm[name] = [100 * (one["energy_J"] / other["energy_J"] - 1) for one, other in zip(drives["none"], best)]
            rows += [cells(name, case, own, best) for case, own in drives.items()]
    worst = max(abs(x) for values in calm.values() for x in values)
    short = (
        f"**The follower in MuJoCo**, 20 Hz and {1000 * LATENCY_S:.0f} ms of latency, undisturbed: joules within {worst:.2g} % of ideal "
        f"tracking of the wheels' speeds (" + "; ".join(f"{name} {spread(values, 2)} %" for name, values in calm.items()) + ")."
    )
    text = (
        "Missions between poses of the public set on two maps, planned for half of the greatest payload, driven by `joulepath.Follower` "
        "with the simulator's pose and the encoders' speeds. Ideal tracking: the same wheel loops get the plan's own wheel speeds, without "
        "pose, period or latency. The follower is told the time until a command has an effect: the latency and the 80 ms of the wheels' "
        "loops; its first command comes so long before the plan begins. The drives limit the current as the robot file says (without "
        "that, the wheels' loops swing from limit to limit on a floor without friction). Joules are those of the motors until arrival, and standby. Late: the last centimetre, against the "
        "plan's. The payload is known one second after the start. Disturbances begin at 30 % of the plan; an obstacle stands 1 m ahead.\n\n"
    )
    return {"text": text + table(HEADER, rows) + f"\n{short}\n", "summary": {}, "short": short}


HEADER = ["robot", "disturbance", "missions", "arrived", "handed over", "joules over ideal tracking, %", "late, s", "aside at most, mm", "end off, mm", "new plans"]


def cells(name, case, drives, best):
    over = [100 * (one["energy_J"] / other["energy_J"] - 1) for one, other in zip(drives, best) if one["arrived"]]
    return [
        name,
        case,
        len(drives),
        sum(d["arrived"] for d in drives),
        sum(d["off_path"] for d in drives),
        spread(over, 2),
        spread([d["late_s"] for d in drives if d["arrived"]], 2),
        f"{1000 * max(d['lateral_m'] for d in drives):.0f}",
        f"{1000 * max((d['end_m'] for d in drives if d['arrived']), default=math.nan):.0f}",
        spread([d["replans"] for d in drives], 2),
    ]
