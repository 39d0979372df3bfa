"""Arguments that nobody means. Each is refused with its name, or converted; none ends the process."""
import copy
import os
import pickle
import time
import warnings

import numpy as np
import pytest

import joulepath as jp

XY = [[0, 0], [2, 0]]
MOTION = {"time_s": [0.0, 1, 2], "linear_speed_m_s": [0.0, 1, 0], "angular_speed_rad_s": [0.0, 0, 0]}
holds_itself: dict = {}
holds_itself["a"] = holds_itself
deep: list = []
for _ in range(100_000):
    deep = [deep]


@pytest.mark.parametrize(("call", "message"), [
    (lambda r: jp.profile(r, XY, payload_kg=10**400), "payload_kg: found a number beyond"),
    (lambda r: jp.profile(r, XY, time_s=10**400), "time_s: found a number beyond"),
    (lambda r: jp.profile(r, XY, payload_kg=3 + 0j), "payload_kg"),
    (lambda r: jp.profile(r, XY, payload_kg=np.array([3.0, 4.0])), "payload_kg"),
    (lambda r: jp.profile(r, XY, solver=np.array(["fast", "ipopt"])), "solver"),
    (lambda r: jp.profile(r, XY, solver=["fast"]), "solver"),
    (lambda r: jp.profile(r, XY, nodes=10**30), "nodes"),
    (lambda r: jp.profile(r, XY, nodes=True), "nodes"),
    (lambda r: jp.profile(None, XY), "robot: found a value of type NoneType"),
    (lambda r: jp.profile("a\0b", XY), "robot: found 'a"),
    (lambda r: jp.profile("a\udcffb", XY), "robot: found 'a"),
    (lambda r: jp.Robot.load(b"none.yaml"), "none.yaml: found no readable file"),
    (lambda r: jp.profile(r, np.array([[0, 0], [np.longdouble("1e4000"), 0]], dtype=np.longdouble)), r"xy\[1\]\[0\]: found inf"),
    (lambda r: jp.Path([[0, 0], [1e300, 0]]), r"xy\[1\]\[0\]: found 1e\+300, accepted: a number from -1e\+06"),
    (lambda r: jp.Path([[0, 0], [10**400, 0]]), "xy"),
    (lambda r: jp.Path(XY).poses(1e-300), "step_m"),
    (lambda r: jp.Path.load("none\0.csv"), "file: found"),
    (lambda r: jp.energy(r, [0, 1], [0, 1], payload_kg=-5), r"payload_kg\[0\]: found -5"),
    (lambda r: jp.energy(r, [0, 1, 2], [0, 1e300, 0]), r"v\[1\]: found 1e\+300"),
    (lambda r: jp.energy(r, [0, 1, 2], 0, w=1e5), "w"),
    (lambda r: jp.energy(r, 1.0, 0), "t: found shape"),
    (lambda r: jp.simulate(r), "plan: found Robot"),
    (lambda r: jp.simulate(PLAN(r), effects="rolling_resistance"), "effects"),
    (lambda r: jp.simulate(PLAN(r), effects=None), "effects"),
    (lambda r: jp.simulate(PLAN(r), effects={"rolling_resistance": {"coefficient": {1, 2}}}), "a value of type set"),
    (lambda r: jp.simulate(PLAN(r), sample_rate_Hz=1e-9), "sample_rate_Hz: found 1e-09, accepted: a number >= 1 and <= 1000"),
    (lambda r: jp.simulate(PLAN(r), sample_rate_Hz=1e300), "sample_rate_Hz"),
    (lambda r: jp.simulate(PLAN(r), seed=2**64), "seed"),
    (lambda r: jp.Robot(holds_itself), "contains itself"),
    (lambda r: jp.Robot({"a": deep}), "great depth"),
    (lambda r: jp.Robot({(1, 2): 3}), "a key that is not a string"),
    (lambda r: jp.Robot([1]), "robot: found a value of type list"),
    (lambda r: jp.Robot.parse(b"name: a"), "text: found a value of type bytes"),
    (lambda r: jp.Robot.parse(r.text(), name=3), "name: found a value of type int"),
    (lambda r: jp.Robot.parse(""), "robot.yaml"),
    (lambda r: jp.profile(r, []), r"xy: found shape \(0,\)"),
    (lambda r: jp.profile(r, np.empty((0, 2))), "xy: found 0 points"),
    (lambda r: jp.profile(r, [(0, 0)]), "xy: found 1 points"),
    (lambda r: jp.profile(r, [(0, 0), (0, 0)]), r"xy\[1\]"),
    (lambda r: jp.profile(r, {"x": [0, 1], "y": [0, 1]}), "xy: found values of type object"),
    (lambda r: jp.profile(r, [(0, 0), (1, None)]), "xy: found values of type object"),
    (lambda r: jp.plan("path.csv"), "path.csv: found no readable file"),
    (lambda r: r.replace(name="a\udcffb"), "text that UTF-8 can encode"),
    (lambda r: r.replace(name="a\0b"), "control character"),
    (lambda r: jp.plan(None), "mission: found a value of type NoneType"),
    (lambda r: jp.plan({"robot": r, "legs": []}, map=3), "map: found a value of type int"),
    (lambda r: jp.plan("none.yaml", robot=3), "robot: found a value of type int"),
    (lambda r: jp.diagnose(r, None), "logs: found a value of type NoneType"),
    (lambda r: jp.diagnose(r, [3]), "type int"),
    (lambda r: jp.diagnose(r, ["none.mcap"]), "no readable file"),
    (lambda r: jp.diagnose(r, [MOTION], without=["roling_resistance"]), "did you mean rolling_resistance"),
    (lambda r: jp.diagnose(r, [MOTION], without="roling_resistance"), "did you mean rolling_resistance"),
    (lambda r: jp.map(int, ["1"], threads=0), "threads"),
], ids=lambda value: None)
def test_what_nobody_means_is_refused(robot, call, message):
    with pytest.raises(jp.ConfigError, match=message):
        call(robot)


def PLAN(robot):
    return jp.profile(robot, XY, solver="fast", nodes=40)


@pytest.mark.parametrize("xy", [
    np.array(XY, dtype=np.longdouble), np.array(XY, dtype=np.uint64), np.array(XY, dtype=np.float16),
    memoryview(np.array(XY, dtype=float)), tuple(map(tuple, XY))])
def test_every_kind_of_number_is_converted(robot, xy):
    assert jp.profile(robot, xy, solver="fast", nodes=40).energy_J == PLAN(robot).energy_J
    payload_kg = [kind(3) for kind in (int, float, np.float32, np.int8, np.array)]
    assert len({jp.profile(robot, XY, payload_kg=p, solver="fast", nodes=np.int32(40)).energy_J for p in payload_kg}) == 1


def test_arrays_of_every_layout_give_the_same(robot):
    t = np.linspace(0, 4, 50)
    v = 0.3 * np.sin(np.pi * t / 4) ** 2
    expected = jp.energy(robot, t, v).total_J
    frozen = v.copy()
    frozen.flags.writeable = False
    for same in (frozen, v[::-1].copy()[::-1], np.stack([v, v], 1)[:, 1], np.asfortranarray(v), v.astype(">f8"), list(v), tuple(v)):
        assert jp.energy(robot, t, same).total_J == expected
    assert jp.energy(robot, t, v.astype(np.float32)).total_J == pytest.approx(expected, rel=1e-6)
    xy = np.array([[4.0, 1], [2, 0], [0, 0]])[::-1]
    frozen = xy.copy()
    frozen.flags.writeable = False
    assert len({jp.Path(same).length_m for same in (xy, frozen, [tuple(p) for p in xy], np.flip(np.flip(xy, 0), 0))}) == 1


def test_a_motion_whose_times_are_in_ms_is_doubted(robot):
    with pytest.warns(UserWarning, match="are the times in ms"):
        jp.energy(robot, [0, 1000, 5000, 6000], [0, 0.5, 0.5, 0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        jp.energy(robot, [0, 1, 5, 6], [0, 0.5, 0.5, 0])
        jp.energy(robot, [0, 600], 0.5)


def test_waypoints_in_mm_are_doubted_at_the_caller(robot):
    for call in (jp.Path, lambda xy: jp.profile(robot, xy, solver="fast", nodes=40)):
        with pytest.warns(UserWarning, match=r"xy: points of the path are 2000 m apart .median.: are the coordinates in cm, or in mm") as told:
            call(np.multiply(XY, 1000))
        assert [warning.filename for warning in told] == [__file__]
    with pytest.warns(UserWarning, match="xy: the path has 6000 m: are the coordinates"):
        jp.Path(np.stack([np.linspace(0, 6000, 101), np.zeros(101)], 1))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        jp.Path(XY)
        jp.Path([[0, 0], [180, 0], [180, 10], [1000, 10], [1000, 20]])


def test_results_are_values(robot):
    plan, path = PLAN(robot), jp.Path(XY)
    for value in (plan, path, plan.trajectory, jp.energy(robot, plan.t, plan.v), jp.drives(plan)[0], jp.simulate(plan)):
        assert copy.copy(value) is value and copy.deepcopy({"of": [value]})["of"][0] is value
        with pytest.raises(TypeError, match=f"a {type(value).__name__} cannot be pickled"):
            pickle.dumps(value)
    assert plan == plan and hash(plan) == hash(plan) and plan != PLAN(robot) and plan != 3
    assert plan.trajectory == PLAN(robot).trajectory and not plan.trajectory != PLAN(robot).trajectory
    assert plan.trajectory != jp.profile(robot, XY, payload_kg=3, solver="fast", nodes=40).trajectory and plan.trajectory != {}
    assert pickle.loads(pickle.dumps(plan.json)) == plan.json == copy.deepcopy(plan.json)
    assert robot == robot.replace() and robot != robot.replace(name="other") and robot != robot.text() and robot in {robot.replace()}
    error = pickle.loads(pickle.dumps(refusal(lambda: jp.profile(robot, XY, payload_kg=50))))
    assert error.key == "payload_kg" and error.file is None and error.found == "50" and str(error).startswith("payload_kg: found 50")


def refusal(call):
    with pytest.raises(jp.ConfigError) as raised:
        call()
    return raised.value


def test_errors_of_files_name_arguments_not_options(robot, tmp_path):
    (tmp_path / "path.csv").write_text("x_m,y_m\n0,0\n2,0\n")
    (tmp_path / "mission.yaml").write_text("robot: none.yaml\nlegs: [{path: {bezier_m: [[[0, 0], [1, 0], [1, 0], [1, 1]]]}}]\n")
    told = refusal(lambda: jp.plan(tmp_path / "path.csv", robot=robot, payload_kg=50))
    assert told.file is None and str(told) == "payload_kg: found 50, accepted: at most 12, limits.max_payload_kg of the robot"
    told = refusal(lambda: jp.plan(tmp_path / "mission.yaml", robot=robot, time_s=5))
    assert told.file is None and told.key == "time_s" and "--" not in str(told)
    assert "robot=" in str(refusal(lambda: jp.plan(tmp_path / "path.csv")))


def test_the_end_of_a_new_profile_is_on_its_piece(robot):
    piece, = jp.drives(jp.profile(robot, [[0, 0], [2, 0.3], [4, 1], [7, -2]], solver="fast"))
    for start in (0.0, 0.1, 1.7, piece.length):
        rest = jp.Replanner(piece).replan(start, 0.0)
        for s in (rest.s[0], rest.s[-1]):
            assert all(np.isfinite(piece.pose(s)))


def test_a_plan_that_was_not_found_has_no_trajectory(robot, tmp_path):
    with pytest.raises(jp.Infeasible) as raised:
        jp.profile(robot, XY, time_s=0.1)
    plan = raised.value.plan
    for read in (lambda: plan.t, lambda: plan.at(0.0), lambda: plan.at([]), lambda: plan.trajectory, lambda: plan.to_frame(),
                 lambda: plan.plot()):
        with pytest.raises(AttributeError, match="no trajectory: the plan is infeasible"):
            read()
    assert not hasattr(plan, "energy_J") and not hasattr(plan, "duration_s")
    assert plan._value.at(np.array([0.0])).columns() == []  # the compiled part, too, has nothing to sample
    plan.save(tmp_path)
    assert sorted(os.listdir(tmp_path)) == ["plan.json", "report.html"]
    with pytest.raises(jp.ConfigError, match="samples"):
        jp.simulate(plan)
    again = pickle.loads(pickle.dumps(raised.value))
    assert (str(again), again.limit, again.place, again.relaxation) == (str(raised.value), raised.value.limit, raised.value.place,
                                                                        raised.value.relaxation)
    assert again.plan is None


def test_the_ends_of_a_plan_are_within_it(robot):
    plan = PLAN(robot)
    assert len(plan.at([])) == 0
    assert plan.at([0.0, plan.duration_s])["energy_J"][-1] == pytest.approx(plan.energy_J, rel=1e-9)
    for outside in (-1e-9, np.nextafter(plan.duration_s, 1e9), float("nan"), None, "1", [[0.0, 1.0]], [1.0, 0.5]):
        with pytest.raises(jp.ConfigError):
            plan.at(outside)


def test_the_robot_of_an_argument_is_used_whatever_its_form(robot, tmp_path):
    (tmp_path / "path.csv").write_text("x_m,y_m\n0,0\n2,0\n")
    robot.save(tmp_path / "robot.yaml")
    forms = [robot, robot.to_dict(), tmp_path / "robot.yaml", str(tmp_path / "robot.yaml")]
    assert len({jp.plan(tmp_path / "path.csv", robot=form, solver="fast", nodes=40).energy_J for form in forms}) == 1


@pytest.mark.parametrize("name", ["007", "1e3", "null", "~", "true", "yes", "a: b", "# a", "Ünïcode ☃", "a'b\"c", " ", "- a"])
def test_every_name_reads_back(robot, name):
    named = robot.replace(name=name)
    assert named.name == name and jp.Robot.parse(named.text()) == named == copy.deepcopy(named)


def test_map_ends_with_what_ends_it():
    """What is no failure of a job is raised, at once: of the list of jobs, an interrupt, an exit."""
    started = []

    def jobs():
        yield 0.01
        raise RuntimeError("no more jobs")

    with pytest.raises(RuntimeError, match="no more jobs"):
        jp.map(started.append, jobs(), threads=1)
    for end in (KeyboardInterrupt, SystemExit):
        def call(k):
            started.append(k)
            if k == 3:
                raise end
            time.sleep(0.01)
            return k

        started.clear()
        with pytest.raises(end):
            jp.map(call, range(1000), threads=2)
        assert len(started) < 100
    assert jp.map(int, [], threads=3) == []


def test_map_in_a_map_and_in_threads(robot):
    def inner(k):
        return [p.energy_J for p in jp.map(jp.profile, [(robot, [[0, 0], [1 + k, 0]])] * 2, threads=2)]

    pairs = jp.map(inner, range(3), threads=3)
    assert all(first == second for first, second in pairs) and pairs[0] < pairs[1] < pairs[2]


def test_map_tells_every_failure_as_a_value(robot):
    jobs = [{"robot": robot, "xy": XY, "nope": 1}, {"robot": robot, "xy": [[0, 0], [0, 0]]}, {"robot": None, "xy": XY},
            {"robot": robot, "xy": XY, "time_s": 0.1}, {"robot": robot, "xy": XY, "solver": "fast"}]
    kinds = [type(result).__name__ for result in jp.map(jp.profile, jobs, threads=3)]
    assert kinds == ["TypeError", "ConfigError", "ConfigError", "Infeasible", "Profile"]
    assert jp.map(int, (str(k) for k in range(50)), threads=7) == list(range(50))
