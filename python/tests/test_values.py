"""Robots, results and their views."""
import copy
import pickle

import numpy as np
import pytest

import joulepath as jp


def test_robot_reads_back_from_all_its_forms(robot, tmp_path):
    robot.save(tmp_path / "robot.yaml")
    assert jp.Robot.load(tmp_path / "robot.yaml") == robot
    assert jp.Robot(robot.to_dict()) == robot
    assert pickle.loads(pickle.dumps(robot)) == robot == copy.deepcopy(robot)
    assert hash(jp.Robot.parse(robot.text())) == hash(robot)


def test_robot_is_frozen_and_replaces_keys_alone(robot):
    with pytest.raises(AttributeError):
        robot.motor = {}
    with pytest.raises(AttributeError):
        robot.motor.gear_ratio = 3
    geared = robot.replace(motor={"gear_ratio": 32}, effects=[{"rolling_resistance": {"coefficient": 0.01}}])
    assert geared.motor.gear_ratio == 32
    assert geared.motor.resistance_ohm == robot.motor.resistance_ohm
    assert geared.replace(motor={"gear_ratio": robot.motor.gear_ratio}, effects=None) == robot


def test_every_section_of_the_schema_can_be_replaced(robot):
    for section, values in robot.to_dict().items():
        assert robot.replace(**{section: values}) == robot, section


def test_paths_warn_of_what_the_reader_decided(tmp_path):
    file = tmp_path / "path.yaml"
    file.write_text("bezier_m: [[[0, 0], [1, 0], [2, 0], [3, 0]], [[3, 0], [4, 0], [5, 1], [5, 2]]]\n")
    with pytest.warns(UserWarning, match="curvature jumps"):
        jp.Path.load(file)


def test_views_do_not_copy_and_outlive_their_plan(robot):
    p = jp.profile(robot, [[0, 0], [2, 0]])
    assert p.t.base is not None and not p.t.flags.writeable and not p.t.flags.owndata
    assert np.shares_memory(p.v, p.trajectory["linear_speed_m_s"])
    t, kept = p.t, p.t.copy()
    del p
    np.testing.assert_array_equal(t, kept)
    with pytest.raises(ValueError):
        t[0] = 1


def test_profile_adds_up(curve):
    assert curve.lower_bound_J <= curve.energy_J <= curve.interval_95_J[1]
    assert curve.t[-1] == pytest.approx(curve.duration_s)
    assert curve.v[0] == curve.v[-1] == 0
    assert np.trapezoid(curve.v, curve.t) == pytest.approx(curve.s[-1], rel=1e-4)
    assert curve.trajectory["energy_J"][-1] == pytest.approx(curve.energy_J, rel=1e-9)


def test_at_is_exact_at_the_samples(curve):
    some = curve.t[::7]
    np.testing.assert_array_equal(curve.at(some)["linear_speed_m_s"], curve.v[::7])
    for one in (1.0, 1, np.float32(1), np.array(1.0)):
        now = curve.at(one)
        assert type(now["linear_speed_m_s"]) is float and now.linear_speed_m_s == curve.at([1.0])["linear_speed_m_s"][0]
    assert curve.at([1.0])["time_s"].shape == (1,)
    with pytest.raises(jp.ConfigError, match="t: found"):
        curve.at(curve.duration_s + 1)


def test_energy_of_a_plan_is_that_of_its_motion(robot, curve):
    e = jp.energy(robot, curve.t, curve.v, curve.w, payload_kg=5)
    assert e.total_J == pytest.approx(curve.energy_J, rel=1e-3)
    assert sum(e.causes_J.values()) == pytest.approx(e.total_J, rel=1e-12)


def test_an_effect_of_the_robot_costs_what_it_says(robot, curve):
    rough = robot.replace(effects=[{"rolling_resistance": {"coefficient": 0.02}}])
    e = jp.energy(rough, curve.t, curve.v, curve.w, payload_kg=5)
    weight_N = 9.80665 * (robot.inertia.chassis_mass_kg + 2 * robot.inertia.wheel_mass_kg + 5)
    assert e.causes_J["rolling_resistance"] == pytest.approx(0.02 * weight_N * curve.s[-1], rel=0.01)


def test_limits_along_the_path_hold_there_alone(robot):
    xy, caps = [[0, 0], [5, 0]], np.array([[1.0, 2.0, 0.2], [3.0, 3.5, 0.3]])
    free, capped = jp.profile(robot, xy), jp.profile(robot, xy, speed_caps=caps)
    for begin_m, end_m, speed_m_s in caps:
        inside = (capped.s > begin_m) & (capped.s < end_m)
        assert capped.v[inside].max() <= speed_m_s * (1 + 1e-6) < free.v[(free.s > begin_m) & (free.s < end_m)].max()
    assert capped.v.max() > 0.3 * (1 + 1e-6) and capped.energy_J > free.energy_J
    zones = [{"leg": 0, "from_m": a, "to_m": b, "speed_m_s": v} for a, b, v in caps.tolist()]
    mission = {"robot": robot, "legs": [{"path": {"bezier_m": [[[0, 0], [5 / 3, 0], [10 / 3, 0], [5, 0]]]}}], "speed_zones": zones}
    plan = jp.plan(mission)
    assert abs(plan.energy_J / capped.energy_J - 1) < 1e-4 and np.array_equal(plan.v, plan.trajectory["linear_speed_m_s"])
    for wrong in ([[1, 2]], [[2, 1, 0.3]], [[1, 2, 0]], [[1, 2, np.nan]], [1, 2, 0.3]):
        with pytest.raises(jp.ConfigError, match="speed_caps"):
            jp.profile(robot, xy, speed_caps=wrong)


def test_frames_plots_and_reports(curve):
    frame = curve.to_frame()
    assert list(frame.columns) == list(curve.trajectory) and len(frame) == len(curve.t)
    assert len(curve.plot()) == 2
    energy = jp.energy(curve.robot, curve.t, curve.v, curve.w)
    assert abs(sum(bar.get_width() for bar in energy.plot().patches) - energy.total_J) < 1e-8 * energy.total_J
    assert curve._repr_html_().startswith("<iframe srcdoc=")
    assert "Profile(optimal" in repr(curve)


def test_a_simulation_has_the_names_of_a_plan(robot, curve):
    log = jp.simulate(curve, seed=3)
    assert log.t.shape == log.v.shape == log.w.shape == log.power_W.shape and np.array_equal(log.t[1:], log["time_s"])
    assert np.trapezoid(log.v, log.t) == pytest.approx(curve.s[-1], rel=1e-2) and not log.v.flags.owndata
    assert np.trapezoid(log.power_W, log.t) == pytest.approx(log.energy_J, rel=2e-2)
    assert jp.energy(robot, log.t, log.v, log.w, payload_kg=5).total_J == pytest.approx(log.energy_J, rel=1e-2)
    speed, power = log.plot()
    assert np.array_equal(speed.lines[0].get_ydata(), log.v) and np.array_equal(power.lines[0].get_ydata(), log.power_W)


def test_saving_never_overwrites_unasked(curve, tmp_path):
    curve.save(tmp_path)
    with pytest.raises(jp.ConfigError, match="a file that exists"):
        curve.save(tmp_path)
    curve.save(tmp_path, force=True)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["plan.json", "profile.csv", "report.html", "trajectory.csv"]


def test_map_keeps_the_order_and_failures_are_values(robot):
    jobs = [{"robot": robot, "xy": [[0, 0], [length_m, 0]], "time_s": time_s, "solver": "fast"}
            for length_m, time_s in ((2, None), (3, 0.1), (1, None))]
    first, second, third = jp.map(jp.profile, jobs, threads=2)
    assert first.s[-1] == pytest.approx(2) and third.s[-1] == pytest.approx(1)
    assert isinstance(second, jp.Infeasible)
    alone = jp.profile(**jobs[0])
    assert first.json.energy_J == alone.json.energy_J
