"""A MuJoCo model drives the motions of logs; skipped without the package mujoco."""

import re
import subprocess
import sys

import numpy as np
import pytest

import joulepath as jp

pytest.importorskip("mujoco")
from joulepath.simulators import mujoco as driven  # noqa: E402

CRATE = '<body name="crate" pos="5 5 0.2"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/><geom type="box" size="0.1 0.1 0.1"/></body>'


@pytest.fixture(scope="module")
def model(tmp_path_factory):
    folder = tmp_path_factory.mktemp("model")
    jp.Robot.example().save(folder / "robot.yaml")
    subprocess.run([sys.executable, "-m", "joulepath", "export", folder / "robot.yaml", "--to", "mjcf", "--out", folder / "robot.xml"], check=True)
    return (folder / "robot.xml").read_text()


def ramp(speed=0.5):
    time = 0.02 * np.arange(300)
    v = speed * np.clip(np.minimum(time, 6 - time) / 2, 0, 1)
    return {"time_s": time, "command_linear_speed_m_s": v, "command_angular_speed_rad_s": 0 * v}


def test_a_straight_drive_takes_the_steady_current_of_the_robot_file(model):
    robot, log = jp.Robot.example(), ramp()
    seen = driven.predict(model, robot, log)
    middle = slice(140, 160)
    motor, speed = robot.motor, 0.5 / robot.geometry.wheel_radius_m
    per_ampere = motor.torque_constant_Nm_A * motor.gear_ratio
    for side in ("left", "right"):
        expected = (motor.friction_torque_Nm[side] + motor.viscous_friction_Nm_s_rad * speed) / per_ampere
        assert np.mean(seen[f"motor_current_{side}_A"][middle]) == pytest.approx(expected, rel=0.02)
        assert np.mean(seen[f"wheel_speed_{side}_rad_s"][middle]) == pytest.approx(speed, rel=0.01)
    assert seen["position_x_m"][-1] == pytest.approx(2.0, abs=0.06)


def test_another_free_body_is_not_the_robot(model):
    start = model.index("<body")
    beside = driven.predict(model[:start] + CRATE + model[start:], jp.Robot.example(), ramp())
    alone = driven.predict(model, jp.Robot.example(), ramp())
    assert beside["position_x_m"][-1] == pytest.approx(alone["position_x_m"][-1], abs=1e-3)


def test_a_mirrored_bend_gives_the_mirrored_log(model):
    left, right = ({**ramp(), "command_angular_speed_rad_s": sign * 0.6 * ramp()["command_linear_speed_m_s"]} for sign in (1, -1))
    symmetric = jp.Robot.example().replace(motor={"friction_torque_Nm": 0.36})
    a, b = driven.predict(model.replace('frictionloss="0.373"', 'frictionloss="0.346"'), symmetric, left), \
        driven.predict(model.replace('frictionloss="0.373"', 'frictionloss="0.346"'), symmetric, right)
    assert a["heading_rad"][-1] == pytest.approx(-b["heading_rad"][-1], abs=2e-3)
    assert a["motor_current_left_A"] == pytest.approx(b["motor_current_right_A"], abs=0.02)


@pytest.mark.parametrize("change, told", [
    ({"time_s": np.zeros(300)}, "rise"), ({"command_linear_speed_m_s": np.full(300, np.nan)}, "wheel_speed_left_rad_s")])
def test_a_log_that_says_no_motion_is_refused(model, change, told):
    with pytest.raises(jp.ConfigError, match=told):
        driven.predict(model, jp.Robot.example(), {**ramp(), **change})


def test_a_log_is_not_overwritten(model, tmp_path):
    (tmp_path / "robot.xml").write_text(model)
    columns = ramp()
    (tmp_path / "run.csv").write_text(",".join(columns) + "\n" + "\n".join(",".join(map(repr, map(float, row))) for row in zip(*columns.values())))
    before = (tmp_path / "run.csv").read_text()
    with pytest.raises(jp.ConfigError, match="overwritten"):
        driven.predict_files(tmp_path / "robot.xml", jp.Robot.example(), [tmp_path / "run.csv"], tmp_path)
    assert (tmp_path / "run.csv").read_text() == before
    assert driven.predict_files(tmp_path / "robot.xml", jp.Robot.example(), [tmp_path / "run.csv"], tmp_path / "sim")


def test_currents_follow_the_constants_of_the_model(model):
    """Another Kt and Kv, by hand in the actuators: less current for the same torque, the volts of that motor."""
    robot, log, factor = jp.Robot.example(), ramp(), 1.08
    motor = robot.motor
    per_ampere, ohm = motor.torque_constant_Nm_A * motor.gear_ratio, motor.resistance_ohm
    volts = motor.voltage_constant_V_s_rad * motor.gear_ratio
    other = re.sub(r'gainprm="[^"]*"', f'gainprm="{factor * per_ampere / ohm!r}"', model)
    other = re.sub(r'biasprm="[^"]*"', f'biasprm="0 0 {-factor**2 * per_ampere * volts / ohm!r}"', other)
    own, seen = driven.predict(model, robot, log), driven.predict(other, robot, log)
    for side in ("left", "right"):
        current, speed = seen[f"motor_current_{side}_A"][140:160], seen[f"wheel_speed_{side}_rad_s"][140:160]
        assert np.mean(current) == pytest.approx(np.mean(own[f"motor_current_{side}_A"][140:160]) / factor, rel=1e-3)
        assert np.mean(seen[f"motor_voltage_{side}_V"][140:160]) == pytest.approx(np.mean(ohm * current + factor * volts * speed), rel=1e-3)
