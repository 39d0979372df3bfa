"""Machines whose rigid-body dynamics MuJoCo computes: chassis, payload and two wheels as bodies, viscous friction as damping of
the wheels' hinges. Dry friction and motors are those of machine.py. The chassis may have its mass ahead of the axle, which a
robot file of the planner then does not say.
"""

import dataclasses
import functools

import mujoco
import numpy as np

from machine import GRAVITY, Machine

BODIES = """<mujoco><option gravity="0 0 -{gravity}"/><worldbody><body name="chassis">
<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="hinge" axis="0 0 1"/>
<inertial pos="{ahead} 0 0" mass="{chassis}" diaginertia="{inertia} {inertia} {inertia}"/>
<body pos="0 0 0"><inertial pos="0 0 0" mass="{payload}" diaginertia="{load} {load} {load}"/></body>
<body pos="0 {half_track} 0"><joint type="hinge" axis="0 1 0" damping="{viscous}" armature="{rotor}"/>{wheel}</body>
<body pos="0 -{half_track} 0"><joint type="hinge" axis="0 1 0" damping="{viscous}" armature="{rotor}"/>{wheel}</body>
</body></worldbody></mujoco>"""


@functools.lru_cache(maxsize=64)
def model_of(machine, payload_kg):
    solid = min(machine.axle_inertia, 2 * machine.diameter_inertia)  # of the wheel alone; the rest is its motor's rotor
    wheel = f'<inertial pos="0 0 0" mass="{machine.wheel_kg}" diaginertia="{machine.diameter_inertia} {solid} {machine.diameter_inertia}"/>'
    text = BODIES.format(gravity=GRAVITY, chassis=machine.chassis_kg, half_track=machine.half_track, wheel=wheel, ahead=machine.ahead_m,
                         inertia=machine.yaw_inertia - machine.chassis_kg * machine.ahead_m**2, viscous=machine.viscous,
                         payload=payload_kg + 1e-9, load=machine.payload_inertia_m2 * payload_kg + 1e-9,
                         rotor=machine.axle_inertia - solid)
    return mujoco.MjModel.from_xml_string(text)


@dataclasses.dataclass(frozen=True)
class MujocoMachine(Machine):
    ahead_m: float = 0.0  # the center of the chassis' mass; yaw_inertia stays that about the axle's middle

    def wheels(self, v, a, w, dw, payload_kg):
        """Currents (A) and voltages (V) of both wheels, an array of two rows each: the inverse dynamics of rolling."""
        model = model_of(self, float(payload_kg))
        data = mujoco.MjData(model)
        sides, torques = np.array([1.0, -1.0]), np.empty((2, len(v)))  # MuJoCo's first wheel is the left one, at +y
        for k in range(len(v)):
            data.qvel[:] = v[k], 0, w[k], *((v[k] - sides * self.half_track * w[k]) / self.radius)
            data.qacc[:] = a[k], v[k] * w[k], dw[k], *((a[k] - sides * self.half_track * dw[k]) / self.radius)
            mujoco.mj_inverse(model, data)
            push, _, turn, left, right = data.qfrc_inverse
            forces = 0.5 * push - 0.5 * sides * turn / self.half_track
            torques[:, k] = np.array([left, right]) + self.radius * forces
        speeds = np.array([v - self.half_track * w, v + self.half_track * w]) / self.radius
        dry = np.array(self.friction)[:, None] * (1 + self.stribeck * np.exp(-np.abs(speeds) / self.stribeck_rad_s)) * np.sign(speeds)
        currents = (torques + dry) / (self.torque_constant * self.gear)
        return currents, self.ohm * currents + self.torque_constant * self.gear * speeds


def in_mujoco(machine, ahead_m):
    return MujocoMachine(**dataclasses.asdict(machine), ahead_m=ahead_m)


def check_against(machine):
    """MuJoCo's dynamics of a machine without an offset are those of its own equations."""
    v, a, w, dw = np.random.default_rng(1).uniform(-1, 1, (4, 50))
    theirs, own = in_mujoco(machine, 0.0).wheels(v, a, w, dw, 5.0), machine.wheels(v, a, w, dw, 5.0)
    if max(np.abs(theirs[0] - own[0]).max(), np.abs(theirs[1] - own[1]).max()) > 1e-6:
        raise SystemExit("machine.py and MuJoCo disagree about the same machine")
