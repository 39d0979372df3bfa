"""Your MuJoCo model drives the motions of logs [Todorov2012]: logs for ``predicted:`` of a dataset file. Needs ``mujoco``.

A model is a robot on a free joint with two driven hinges. Their actuators are voltages (``gaintype="fixed"``,
``biastype="affine"``, as ``joulepath export --to mjcf`` writes them), torques (``motor``) or speeds (``velocity``).

    python -m joulepath.simulators.mujoco robot.xml robot.yaml runs/run_*.csv --out sim
"""

from __future__ import annotations

import argparse
import csv
import math
import os
from pathlib import Path as FilePath
from typing import Any, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .._errors import refused
from ..robots import Robot, robot_of

PERIOD_S = 0.01  # of the wheels' controller
BANDWIDTH_PER_S = 12.0
SETTLE_STEPS = 100

Columns = dict[str, NDArray[np.float64]]


class _Drive:
    """The two driven hinges of a model, left before right, and what their actuators do."""

    def __init__(self, model: Any, wheels: Sequence[str] | None) -> None:
        import mujoco

        kinds = model.jnt_type
        driven = {int(model.actuator_trnid[a][0]): a for a in range(model.nu)
                  if model.actuator_trntype[a] == mujoco.mjtTrn.mjTRN_JOINT and kinds[model.actuator_trnid[a][0]] == mujoco.mjtJoint.mjJNT_HINGE}
        joints = list(driven) if wheels is None else [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in wheels]
        names = [mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_JOINT, joint) for joint in driven]
        if len(joints) != 2 or any(joint not in driven for joint in joints):
            raise refused("wheels" if wheels else "model", ", ".join(wheels or map(str, names)) or "no driven hinge",
                          f"two driven hinges, left before right, of: {', '.join(map(str, names))}")
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        if wheels is None and data.xanchor[joints[0]][1] < data.xanchor[joints[1]][1]:
            joints.reverse()
        root = model.body_rootid[model.jnt_bodyid[joints[0]]]
        free = [i for i in range(model.njnt) if kinds[i] == mujoco.mjtJoint.mjJNT_FREE and model.jnt_bodyid[i] == root]
        if not free:
            raise refused("model", "no free joint that carries the wheels", "a robot on a free joint")
        self.pose_at, self.twist_at = int(model.jnt_qposadr[free[0]]), int(model.jnt_dofadr[free[0]])
        self.actuators = [driven[joint] for joint in joints]
        self.dofs = [int(model.jnt_dofadr[joint]) for joint in joints]
        gear = model.actuator_gear[self.actuators, 0]
        bias = model.actuator_biasprm[self.actuators]
        if np.any(bias[:, 1] != 0) or np.any(model.actuator_gainprm[self.actuators, 0] * gear == 0):
            raise refused("model", "actuators whose control is a position, or of no gain", "voltages, torques or speeds as controls")
        self.gain = gear * model.actuator_gainprm[self.actuators, 0]  # N m per control
        self.drag = gear * gear * bias[:, 2]  # N m per rad/s
        self.gear = gear
        limited = model.actuator_ctrllimited[self.actuators].astype(bool)
        self.range = np.where(limited[:, None], model.actuator_ctrlrange[self.actuators], [-np.inf, np.inf])
        self.is_speed = bool(np.all(np.isclose(-self.drag, self.gain * self.gear)))  # a velocity servo

    def control(self, torque_Nm: NDArray[np.float64], speed_rad_s: NDArray[np.float64]) -> NDArray[np.float64]:
        wanted = (torque_Nm - self.drag * speed_rad_s) / self.gain
        allowed: NDArray[np.float64] = np.clip(wanted, self.range[:, 0], self.range[:, 1])
        return allowed


def predict(model: str | os.PathLike[str], robot: Robot | str | os.PathLike[str], log: Mapping[str, Any], *,
            wheels: Sequence[str] | None = None) -> Columns:
    """What a MuJoCo model gives for the motion of a log: columns of a run log at the log's times.

    ``model``: an MJCF file, or its text. ``robot``: its wheels turn body speeds into wheel speeds, its motors turn torques
    into currents; of a model with voltages as controls only the ratio of torque to voltage constant is the robot's, the
    constants are the model's. ``log``: ``time_s`` (N,) with commands (``command_linear_speed_m_s``, ``command_angular_speed_rad_s``), else
    wheel speeds, which a PI controller of 12 rad/s follows in the model. ``wheels``: the joints of the left and the right wheel,
    where more than two are driven. A payload is the model's business: what the log says of one is not read. Raises
    ConfigError for a model or a log without these.
    """
    import mujoco

    known = robot_of(robot)
    text = os.fspath(model)
    built = mujoco.MjModel.from_xml_string(text) if text.lstrip().startswith("<") else mujoco.MjModel.from_xml_path(text)
    drive, data = _Drive(built, wheels), mujoco.MjData(built)
    time_s = _column(log, "time_s")
    if len(time_s) < 2 or not np.all(np.diff(time_s) > 0):
        raise refused("log", "times that do not rise", "two times or more, each later than the one before")
    wanted = _wheel_speeds(known, log)
    _place(built, data, drive, log)
    motor = known.motor
    per_ampere = _sides(motor["torque_constant_Nm_A"]) * _sides(motor["gear_ratio"])
    volts = _sides(motor["voltage_constant_V_s_rad"]) * _sides(motor["gear_ratio"])
    ohm = _sides(motor["resistance_ohm"])
    radius = _sides(known.geometry["wheel_radius_m"])
    if np.allclose(drive.gain, per_ampere / ohm, rtol=1e-3):
        drive.is_speed = False  # a motor whose control is a voltage, with 1 V s/rad at the wheel
    electrical = not drive.is_speed and bool(np.all(drive.drag < 0))
    if electrical:  # K/R per volt and -K Kv/R per rad/s: the model's own Kv, and K with the robot's K/Kv
        per_ampere = per_ampere / volts * -drive.drag / drive.gain
    inertia = 0.5 * float(np.sum(built.body_mass)) * radius**2 + known.inertia["wheel_axle_inertia_kg_m2"]
    rows = np.empty((len(time_s), 10))
    integral, control = np.zeros(2), np.zeros(2)
    at = next_control = float(time_s[0])
    for k, end in enumerate(time_s):
        while at < end - 1e-9:
            if at >= next_control - 1e-9:
                speed = data.qvel[drive.dofs].copy()
                reference = np.array([np.interp(at, time_s, wanted[side]) for side in (0, 1)])
                error = reference - speed
                torque = BANDWIDTH_PER_S * inertia * (2 * error + BANDWIDTH_PER_S * (integral + error * PERIOD_S))
                asked = reference * drive.gear if drive.is_speed else drive.control(torque, speed)
                reached = drive.gain * asked + drive.drag * speed
                if drive.is_speed or np.allclose(reached, torque):
                    integral += error * PERIOD_S  # no windup at a limit
                control = asked
                next_control += PERIOD_S
            data.ctrl[drive.actuators] = control
            mujoco.mj_step(built, data)
            at += built.opt.timestep
        speed = data.qvel[drive.dofs]
        current = data.actuator_force[drive.actuators] * drive.gear / per_ampere
        voltage = control if electrical else ohm * current + volts * speed
        rows[k] = [*speed, *voltage, *current, *_pose(data, drive), data.qvel[drive.twist_at + 5]]
    rows[:, 8] = np.unwrap(rows[:, 8])
    names = ("wheel_speed_left_rad_s", "wheel_speed_right_rad_s", "motor_voltage_left_V", "motor_voltage_right_V",
             "motor_current_left_A", "motor_current_right_A", "position_x_m", "position_y_m", "heading_rad", "gyro_yaw_rate_rad_s")
    return {"time_s": time_s, **{name: rows[:, i].copy() for i, name in enumerate(names)}}


def _column(log: Mapping[str, Any], name: str) -> NDArray[np.float64]:
    if name not in log:
        raise refused("log", f"no column {name}", "time_s with commands or wheel speeds")
    return np.asarray(log[name], dtype=np.float64)


def _sides(value: Any) -> NDArray[np.float64]:
    return np.array([value["left"], value["right"]] if isinstance(value, Mapping) else [value, value], dtype=np.float64)


def _wheel_speeds(robot: Robot, log: Mapping[str, Any]) -> NDArray[np.float64]:
    """Shape (2, N): left before right."""
    if "command_linear_speed_m_s" in log and "command_angular_speed_rad_s" in log:
        v, w = _column(log, "command_linear_speed_m_s"), _column(log, "command_angular_speed_rad_s")
        if np.all(np.isfinite(v)) and np.all(np.isfinite(w)):
            half, radius = robot.geometry["half_track_m"], _sides(robot.geometry["wheel_radius_m"])
            return np.stack([(v - half * w) / radius[0], (v + half * w) / radius[1]])
    wheels = np.stack([_column(log, "wheel_speed_left_rad_s"), _column(log, "wheel_speed_right_rad_s")])
    if not np.all(np.isfinite(wheels)):
        raise refused("log", "a wheel speed that is missing", "a number in each row")
    return wheels


def _place(model: Any, data: Any, drive: _Drive, log: Mapping[str, Any]) -> None:
    """Settles the model on its wheels, at the log's first pose."""
    import mujoco

    mujoco.mj_step(model, data, SETTLE_STEPS)
    start = drive.pose_at
    pose = [float(np.asarray(log[name])[0]) if name in log else 0.0 for name in ("position_x_m", "position_y_m", "heading_rad")]
    data.qpos[start:start + 2] = pose[:2]
    data.qpos[start + 3:start + 7] = [math.cos(pose[2] / 2), 0, 0, math.sin(pose[2] / 2)]
    data.qvel[:] = 0
    data.time = 0
    mujoco.mj_forward(model, data)


def _pose(data: Any, drive: _Drive) -> tuple[float, float, float]:
    x, y, _, *q = data.qpos[drive.pose_at:drive.pose_at + 7]
    return float(x), float(y), math.atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] ** 2 + q[3] ** 2))


def read_log(file: str | os.PathLike[str]) -> Columns:
    """The columns of a run log (CSV with the format's own names); empty cells are NaN, texts are left out."""
    with open(file, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    columns: Columns = {}
    for name in rows[0] if rows else ():
        try:
            columns[name] = np.array([float(row[name]) if row[name] else math.nan for row in rows])
        except ValueError:
            continue
    return columns


def predict_files(model: str | os.PathLike[str], robot: Robot | str | os.PathLike[str], logs: Iterable[str | os.PathLike[str]],
                  out: str | os.PathLike[str], *, wheels: Sequence[str] | None = None) -> list[FilePath]:
    """``predict`` for files: writes a log of the same name into ``out`` for each. Returns the new files."""
    folder = FilePath(out)
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for log in logs:
        columns = predict(model, robot, read_log(log), wheels=wheels)
        file = folder / (FilePath(log).stem + ".csv")
        if file.exists():
            raise refused("out", str(file), "a folder without a log of that name: nothing is overwritten")
        with open(file, "w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream)
            writer.writerow(columns)
            writer.writerows(zip(*(column.tolist() for column in columns.values())))
        written.append(file)
    return written


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line of this module."""
    parser = argparse.ArgumentParser(prog="python -m joulepath.simulators.mujoco", description="Drive the motions of logs in a MuJoCo model.")
    parser.add_argument("model", help="MJCF file")
    parser.add_argument("robot", help="robot file")
    parser.add_argument("logs", nargs="+", help="run logs (CSV)")
    parser.add_argument("--out", required=True, help="folder for the model's logs")
    parser.add_argument("--wheels", metavar="LEFT,RIGHT", help="driven joints, where the model has more than two")
    given = parser.parse_args(arguments)
    for file in predict_files(given.model, given.robot, given.logs, given.out, wheels=given.wheels.split(",") if given.wheels else None):
        print(file)


if __name__ == "__main__":
    main()
