"""Replanner and follower: pieces of a plan, new profiles from states on them, commands that lead a robot to the end."""
import concurrent.futures
import math

import numpy as np
import pytest

import joulepath as jp

LINE = [[0, 0], [4, 0]]


@pytest.fixture(scope="module")
def planned():
    return jp.profile(jp.Robot.example(), LINE, payload_kg=2)


@pytest.fixture(scope="module")
def piece(planned):
    piece, = jp.drives(planned)
    return piece


def test_drives_are_the_pieces_between_stops(robot, tmp_path):
    plan = jp.plan({"robot": robot, "start": {"x_m": 0, "y_m": 0, "heading_rad": 0},
                    "legs": [{"path": {"bezier_m": [[[0, 0], [1, 0], [2, 1], [3, 1]]], "frame": "map"}, "payload_kg": 2, "dwell_s": 3},
                             {"path": {"frame": "map", "bezier_m": [[[3, 1], [4, 1], [5, 0], [6, 0]]]}}]}, solver="fast")
    pieces = jp.drives(plan)
    assert [one.leg for one in pieces] == [0, 1] and not any(one.is_turn for one in pieces)
    arc_m, leg = plan.trajectory["arc_length_m"], plan.trajectory["leg"]
    assert [one.length for one in pieces] == pytest.approx([arc_m[leg == k].max() for k in (0, 1)], rel=1e-3)
    assert pieces[1].start_s - pieces[0].end_s == pytest.approx(3, abs=0.05)
    assert pieces[0].pose(0) == pytest.approx((0, 0, 0), abs=1e-3)
    assert pieces[1].pose(pieces[1].length) == pytest.approx((6, 0, 0), abs=5e-3)
    read = jp.drives(plan.save(tmp_path / "plan"), robot)
    assert [one.leg for one in read] == [0, 1]
    assert [one.length for one in read] == pytest.approx([one.length for one in pieces])


def test_the_rest_of_an_undisturbed_plan_is_the_plan(planned, piece):
    replanner, t = jp.Replanner(piece), planned.t
    for at_s in (1.0, 3.0, 6.0):
        now = planned.at(at_s)
        rest = replanner.replan(planned.at([0, at_s])["arc_length_m"][1], now["linear_speed_m_s"], time_left_s=t[-1] - at_s)
        assert rest.status == "optimal"
        assert rest.duration_s == pytest.approx(t[-1] - at_s, abs=2e-3)
        assert rest.energy_J == pytest.approx(planned.energy_J - np.interp(at_s, t, planned.trajectory["energy_J"]), rel=2e-3)


def test_what_changes_costs_and_is_kept(piece):
    replanner = jp.Replanner(piece)
    usual = replanner.replan(1.0, 0.5)
    assert usual.status == "optimal" and usual.late_s == 0 and usual.s[0] == 1 and usual.s[-1] == pytest.approx(4)
    assert replanner.replan(1.0, 0.5, time_left_s=2 * usual.duration_s).energy_J == pytest.approx(usual.energy_J)
    assert replanner.replan(1.0, 0.5, payload_kg=12).energy_J > usual.energy_J * 1.02
    late = replanner.replan(1.0, 0.5, time_left_s=0.1)
    assert late.status == "late" and late.late_s == pytest.approx(late.duration_s - 0.1)
    hurried = replanner.replan(1.0, 0.5, time_left_s=0.5 * (usual.duration_s + late.duration_s))
    assert hurried.duration_s == pytest.approx(0.5 * (usual.duration_s + late.duration_s), rel=1e-4)
    assert usual.energy_J < hurried.energy_J < late.energy_J
    slow = replanner.replan(1.0, 0.5, speed_caps=[[2.0, 3.0, 0.2]])
    inside = (slow.s > 2.0) & (slow.s < 3.0)
    assert inside.any() and slow.rate[inside].max() <= 0.2 * (1 + 1e-6)
    blocked = replanner.replan(1.0, 0.5, stop_at=2.0)
    assert blocked.s[-1] <= 2.0 + 1e-9 and blocked.rate[-1] == 0
    assert blocked.overrun == 0 and replanner.replan(1.0, 0.5, stop_at=1.05).overrun > 0


def test_replans_stay_as_they_are_and_threads_agree(piece):
    states = [(0.2 * k, 0.05 * k) for k in range(1, 9)]
    alone = [jp.Replanner(piece).replan(s, rate, time_left_s=9) for s, rate in states]
    kept = [one.rate.copy() for one in alone]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        together = list(pool.map(lambda state: jp.Replanner(piece).replan(*state, time_left_s=9), states))
    for one, other, copy in zip(alone, together, kept):
        assert one.energy_J == other.energy_J and np.array_equal(one.rate, copy) and np.array_equal(other.rate, copy)
        assert not one.rate.flags.writeable


@pytest.mark.parametrize("aside_m", [0.0, 0.05])
def test_a_robot_that_does_as_told_arrives_in_time(piece, aside_m):
    follower = jp.Follower(piece)
    x, y, heading, v, w, pending = 0.0, aside_m, 0.0, 0.0, 0.0, (0.0, 0.0)
    for step in range(400):
        command = follower.command(0.05 * step, (x, y, heading), v, w)
        if command.state != "driving":
            break
        (v, w), pending = pending, (command.speed_m_s, command.yaw_rate_rad_s)
        heading += 0.05 * w
        x, y = x + 0.05 * v * math.cos(heading), y + 0.05 * v * math.sin(heading)
    assert command.state == "finished"
    assert abs(x - 4) < 0.03 and abs(y) < 0.01 + 0.2 * aside_m
    assert 0.05 * step < piece.end_s + 0.5


def test_a_pose_far_off_is_handed_over(piece):
    command = jp.Follower(piece).command(1.0, (0.5, 1.0, 0.0), 0.3, 0.0)
    assert command.state == "off_path" and command.speed_m_s < 0.3


@pytest.mark.parametrize("call, key", [
    (lambda one: jp.Replanner(one).replan(-0.1, 0.2), "s"),
    (lambda one: jp.Replanner(one).replan(4.5, 0.2), "s"),
    (lambda one: jp.Replanner(one).replan(1.0, math.nan), "rate"),
    (lambda one: jp.Replanner(one).replan(1.0, 0.2, speed_caps=[1, 2, 3]), "speed_caps"),
    (lambda one: jp.Replanner(one).replan(1.0, 0.2, speed_caps=[[1, 2, 0]]), "speed_caps"),
    (lambda one: jp.Replanner(one, nodes=1), "nodes"),
    (lambda one: jp.Replanner(one).replan(1.0, 0.2, payload_kg=12.5), "payload_kg"),
    (lambda one: jp.Follower(one).command(0, (0, 0, 0), 0, 0, payload_kg=12.5), "payload_kg"),
    (lambda one: jp.Replanner(jp.Robot.example()), "drive"),
    (lambda one: jp.Follower(None), "drive"),
    (lambda one: jp.Follower(one, period_s=0), "period_s"),
    (lambda one: jp.Follower(one).command(0, (0, 0), 0, 0), "pose"),
    (lambda one: jp.Follower(one).command(0, (0, math.inf, 0), 0, 0), "pose[1]"),
])
def test_what_makes_no_sense_is_refused(piece, call, key):
    with pytest.raises(jp.ConfigError) as told:
        call(piece)
    assert told.value.key == key


def test_the_greatest_payload_is_accepted_and_more_is_told(piece):
    most_kg = jp.Robot.example().limits.max_payload_kg
    assert jp.Replanner(piece).replan(1.0, 0.5, payload_kg=most_kg).status == "optimal"
    with pytest.raises(jp.ConfigError, match=f"payload_kg: found 50, accepted: at most {most_kg:g}, limits.max_payload_kg of the robot"):
        jp.Replanner(piece).replan(1.0, 0.5, payload_kg=50)


def test_a_directory_needs_its_robot(tmp_path, robot):
    with pytest.raises(jp.ConfigError):
        jp.drives(tmp_path)
    with pytest.raises(jp.ConfigError, match="trajectory.csv"):
        jp.drives(tmp_path, robot)
