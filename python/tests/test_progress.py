"""Progress: done climbs to total, the answer is the same, and an error of the callback ends the call."""
import json
import pathlib
import subprocess
import threading
import time

import pytest

import joulepath as jp


class Told:
    """A callback that keeps its calls; it raises `error` at the call `at`."""

    def __init__(self, error=None, at=3):
        self.calls, self.error, self.at, self.threads = [], error, at, set()

    def __call__(self, done, total):
        self.calls.append((done, total))
        self.threads.add(threading.get_ident())
        if self.error and len(self.calls) == self.at:
            raise self.error

    def check(self, least):
        done = [call[0] for call in self.calls]
        assert done == sorted(done) and all(d <= total for d, total in self.calls)
        assert done[-1] == self.calls[-1][1] >= least, self.calls
        assert len(set(done)) >= least, self.calls
        assert self.threads == {threading.get_ident()}


@pytest.fixture(scope="module")
def starter(tmp_path_factory, program):
    """The files of `joulepath init`: robot, mission on a map, dataset with its logs."""
    folder = tmp_path_factory.mktemp("starter")
    subprocess.run([program, "init", folder, "-q"], check=True)
    return folder


@pytest.fixture
def inside(starter, monkeypatch):
    monkeypatch.chdir(starter)


CALLS = {
    "plan": (lambda p: jp.plan("mission.yaml", solver="fast", nodes=40, progress=p), 4),
    "diagnose": (lambda p: jp.diagnose(None, "dataset.yaml", progress=p), 12),
    "check": (lambda p: jp.check("robot.yaml", "dataset.yaml", brief=True, progress=p), 2),
    "compare": (lambda p: jp.compare("mission.yaml", nodes=40, progress=p), 10),
    "front": (lambda p: jp.front("mission.yaml", nodes=40, points=3, baselines=2, progress=p), 8),
    "calibrate": (lambda p: jp.calibrate("dataset.yaml", progress=p), 12),
    "drift": (lambda p: jp.drift("dataset.yaml", "dataset.yaml", progress=p), 24),
    "experiment": (lambda p: jp.experiment("dataset.yaml", progress=p), 12),
}


@pytest.mark.parametrize("name", CALLS)
def test_done_climbs_to_total(name, inside):
    call, least = CALLS[name]
    told = Told()
    call(told)
    told.check(least)


def study(count):
    pathlib.Path("study.yaml").write_text(json.dumps({
        "schema": "joulepath/study/1", "missions": "mission.yaml",
        "parameters": {"gear": {"key": "robot.motor.gear_ratio", "from": 20, "to": 30, "count": count}}}))
    return "study.yaml"


def test_batch_and_sweep_tell_jobs_alone(inside):
    """The steps of the plans within a job stay out of its count."""
    told = Told()
    jp.batch("mission.yaml", nodes=40, progress=told)
    assert told.calls[-1] == (1, 1)
    told = Told()
    jp.sweep(study(3), nodes=40, jobs=2, progress=told)
    assert sorted(set(told.calls)) == [(0, 3), (1, 3), (2, 3), (3, 3)]


def test_map_tells_jobs(robot):
    told = Told()
    assert jp.map(int, ["1", "2", "x"], progress=told)[:2] == [1, 2]
    assert told.calls == [(1, 3), (2, 3), (3, 3)] and told.threads == {threading.get_ident()}


def test_the_answer_does_not_depend_on_progress(inside):
    found = jp.diagnose(None, "dataset.yaml", progress=Told())
    assert found.json == jp.diagnose(None, "dataset.yaml").json
    assert [bar.get_width() for bar in found.plot().patches] == [cell.energy_J for cell in found.where]
    plan = {"solver": "fast", "nodes": 40}
    assert jp.plan("mission.yaml", **plan, progress=Told()).json == jp.plan("mission.yaml", **plan).json
    assert jp.calibrate("dataset.yaml", progress=Told()).text == jp.calibrate("dataset.yaml").text


def children():
    return {pid for task in pathlib.Path("/proc/self/task").iterdir() for pid in (task / "children").read_text().split()}


@pytest.mark.parametrize("name", ["plan", "diagnose", "front", "calibrate"])
def test_an_error_of_the_callback_ends_the_call(name, inside):
    error, before = LookupError("enough"), children()
    told = Told(error)
    with pytest.raises(LookupError) as caught:
        CALLS[name][0](told)
    assert caught.value is error and len(told.calls) == told.at
    assert children() <= before, "a process is left"


def test_an_error_ends_the_jobs_of_a_map(robot):
    begun = []

    def job(k):
        begun.append(k)
        time.sleep(0.02)

    with pytest.raises(KeyboardInterrupt):
        jp.map(job, range(200), threads=2, progress=Told(KeyboardInterrupt(), 2))
    assert len(begun) < 100


def test_a_call_within_a_callback_has_its_own_steps(robot, inside):
    inner = Told()

    def progress(done, total):
        if done and not inner.calls:
            jp.plan({"robot": robot, "legs": [{"path": {"bezier_m": [[[0, 0], [1, 0], [1, 0], [1, 1]]]}}]}, nodes=40, progress=inner)

    jp.plan("mission.yaml", solver="fast", nodes=40, progress=progress)
    inner.check(3)


def test_what_is_no_function_is_refused(robot, inside):
    for call in (lambda: jp.plan("mission.yaml", progress=1), lambda: jp.diagnose(None, "dataset.yaml", progress="x"),
                 lambda: jp.front("mission.yaml", progress=1), lambda: jp.map(int, [], progress=1)):
        with pytest.raises(jp.ConfigError, match="progress: found .*, accepted: a function of two numbers, or None"):
            call()
    with pytest.raises(TypeError):
        jp.plan("mission.yaml", solver="fast", nodes=40, progress=lambda: None)
