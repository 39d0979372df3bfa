"""The commands as functions: the bytes of the program, its errors, and a row of the page for each command."""
import json
import pathlib
import re
import subprocess

import numpy as np
import pytest

import joulepath as jp

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/python.md"


def printed(program, *words):
    return subprocess.run([program, *map(str, words), "--json"], check=True, capture_output=True, text=True).stdout


@pytest.fixture
def mission(robot, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    robot.save("robot.yaml")
    keys = {"robot": "robot.yaml", "legs": [{"path": {"bezier_m": [[[0, 0], [2, 0], [2, 1], [4, 1]]]}}]}
    pathlib.Path("mission.yaml").write_text(json.dumps(keys))
    return keys


def test_check_compare_and_front_print_the_program_s_bytes(program, mission):
    assert jp.check("mission.yaml").text == printed(program, "check", "mission.yaml")
    for function, name in ((jp.compare, "compare.json"), (jp.front, "front.json")):
        options = {"nodes": 40, **({"points": 3, "baselines": 0} if function is jp.front else {})}
        words = [word for key, value in options.items() for word in (f"--{key}", value)]
        command = function.__name__
        answer = function("mission.yaml", **options)
        assert answer.text == printed(program, command, "mission.yaml", *words, "--out", command)
        assert answer.files[name] == pathlib.Path(command, name).read_bytes()
        shown = answer.plot()
        if function is jp.front:
            points = [[p.duration_s, p.energy_J] for p in answer.json.points]
            assert shown.lines[0].get_xydata().tolist() == points and len(points) == 3
        else:
            driven = [p.energy_J for p in answer.json.profiles if p.feasible]
            assert all(p.energy_J is None and p.optimum_J is None for p in answer.json.profiles if not p.feasible)
            assert [bar.get_width() for bar in shown.patches] == driven and len(driven) > 5
    with pytest.raises(jp.ConfigError, match="one of compare, front, sweep, batch, calibrate .it says whether files are valid"):
        jp.check("mission.yaml", brief=True).plot()


def test_estimate_of_a_frame_is_that_of_its_file(program, robot, mission):
    log = jp.simulate(jp.plan("mission.yaml", solver="fast"), robot, seed=1)
    log.save("log.csv")
    answer = jp.estimate("log.csv", robot=robot)
    assert answer.text == printed(program, "estimate", "log.csv", "--robot", "robot.yaml", "--out", "estimate")
    assert jp.estimate(log, robot=robot).text == answer.text


def test_export_of_a_robot_and_save(program, robot, mission):
    printed(program, "export", "robot.yaml", "--to", "mjcf", "--out", "one.xml")
    answer = jp.export(robot, "mjcf", "robot.xml")
    assert answer.files["robot.xml"] == pathlib.Path("one.xml").read_bytes()
    answer.save("made")
    assert pathlib.Path("made/robot.xml").read_bytes() == answer.files["robot.xml"]
    with pytest.raises(jp.ConfigError, match="a file that exists"):
        answer.save("made")


@pytest.fixture
def starter(program, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    subprocess.run([program, "init", ".", "-q"], check=True)


def test_batch_and_sweep(program, mission):
    pathlib.Path("missions.jsonl").write_text(json.dumps(mission) + "\n")
    text = printed(program, "batch", "missions.jsonl", "--nodes", 40, "--out", "batch")
    answer = jp.batch([mission], nodes=40)
    assert answer.text == text == jp.batch("missions.jsonl", nodes=40).text
    assert answer.files["results.jsonl"] == pathlib.Path("batch/results.jsonl").read_bytes()
    study = {"schema": "joulepath/study/1", "missions": "mission.yaml",
             "parameters": {"gear": {"key": "robot.motor.gear_ratio", "from": 20, "to": 30, "count": 2}}}
    pathlib.Path("study.yaml").write_text(json.dumps(study))
    text = printed(program, "sweep", "study.yaml", "--nodes", 40, "--out", "sweep")
    answer = jp.sweep("study.yaml", nodes=40)
    assert answer.text == text
    assert answer.files["sweep.csv"] == pathlib.Path("sweep/sweep.csv").read_bytes()
    assert any(column.dtype == float and len(column) == 2 for column in answer.table("sweep.csv").values())
    dots, = answer.plot().collections
    table = answer.table("sweep.csv")
    assert np.array_equal(dots.get_offsets(), np.transpose([table["duration_s"], table["energy_J"]]))
    assert np.array_equal(dots.get_array(), table["gear"]) and dots.colorbar.ax.get_ylabel() == "gear (robot.motor.gear_ratio)"
    answer = jp.batch([mission, {**mission, "robot": "none.yaml"}], nodes=40)
    assert answer.code == 1 and b"joulepath-" not in answer.files["results.jsonl"]
    axes = answer.plot()
    assert [[bar.get_width() for bar in axis.patches] for axis in axes] == [[answer.json[0][key], 0] for key in ("energy_J", "duration_s")]
    assert [label.get_text() for label in axes[0].get_yticklabels()] == ["line_1", "line_2: bad_input"]
    assert len(jp.batch([mission], nodes=40).plot()[0].patches) == 1


def test_a_sweep_s_plot_sums_missions_and_marks_what_does_not_count(mission):
    pathlib.Path("missions.jsonl").write_text(2 * (json.dumps(mission) + "\n"))
    study = {"schema": "joulepath/study/1", "missions": "missions.jsonl", "constraints": {"duration_s": {"max": 6.3}},
             "parameters": {"goal": {"key": "mission.objective.minimize", "values": ["energy", "time"]}}}
    answer = jp.sweep(study, nodes=40)
    table, shown = answer.table("sweep.csv"), answer.plot()
    assert table["meets_constraints"].tolist() == ["no", "no", "yes", "yes"]
    dots = {dot.get_label(): dot.get_offsets().tolist() for dot in shown.collections if len(dot.get_offsets())}
    assert dots == {f"{goal}, {kind}": [[table[key][k] + table[key][k + 1] for key in ("duration_s", "energy_J")]]
                    for k, goal, kind in ((0, "energy", "outside of a constraint"), (2, "time", "keeps the constraints"))}
    with pytest.raises(jp.ConfigError, match="a whole sweep"):
        jp.sweep(study, nodes=40, shard="1/2").plot()


def test_calibrate_drift_and_experiment(program, starter):
    answer = jp.calibrate("dataset.yaml")
    assert answer.text == printed(program, "calibrate", "dataset.yaml", "--out", "fitted.yaml")
    assert answer.files["robot.yaml"] == pathlib.Path("fitted.yaml").read_bytes()
    lines = answer.plot().lines
    seen = [p for p in answer.json.parameters if p.visibility != "unseen"]
    assert lines[0].get_xdata() == pytest.approx([100 * (p.value / p.nominal - 1) for p in seen]) and len(seen) > 5
    assert jp.drift("dataset.yaml", "dataset.yaml").text == printed(program, "drift", "dataset.yaml", "dataset.yaml")
    answer = jp.experiment("dataset.yaml")
    assert not answer.files and answer.json is None and "no candidates to separate" in answer.text
    with pytest.raises(jp.ConfigError, match="one run to drive"):
        answer.plot()


def test_check_names_the_repairs_of_a_dataset(program, starter):
    log = pathlib.Path("run_01.csv")
    header, *rows = log.read_text().splitlines()
    in_ms = (f"{1000 * float(time_s):g},{rest}" for time_s, rest in (row.split(",", 1) for row in rows))
    log.write_text("\n".join([header, *in_ms]) + "\n")
    answer = jp.check("dataset.yaml")
    assert (answer.code, answer.json[0].ok) == (1, False) and answer.json[0].data_checks


def test_monitor(program, starter):
    jp.plan("mission.yaml", solver="fast").save("made")
    told = subprocess.run([program, "monitor", "made", "run_01.csv", "--robot", "robot.yaml", "--json"], capture_output=True, text=True)
    answer = jp.monitor("made", "run_01.csv", "robot.yaml")
    assert (answer.text, answer.code) == (told.stdout, told.returncode)
    assert answer.json[0].event == "status"
    plan = jp.plan("mission.yaml", solver="fast")
    assert jp.monitor(plan, "run_01.csv").text == jp.monitor(plan, "run_01.csv", robot="robot.yaml").text == answer.text
    with pytest.raises(jp.ConfigError, match="robot: found None, accepted: the robot of the plan"):
        jp.monitor("made", "run_01.csv")


def test_errors_are_those_of_the_package(robot, mission):
    assert jp.check({**mission, "legs": 3}).json[0].ok is False
    with pytest.raises(jp.ConfigError, match="unknown argument --pionts"):
        jp.front(mission, pionts=3)
    with pytest.raises(jp.ConfigError) as caught:
        jp.compare({**mission, "robot": robot, "legs": 3})
    assert caught.value.key == "legs" and caught.value.found
    mission["legs"][0]["duration_s"] = 0.1
    with pytest.raises(jp.PlanningError):
        jp.compare({**mission, "robot": robot}, nodes=40)
    with pytest.raises(jp.ConfigError, match="out"):
        jp.front("mission.yaml", out="x")


def test_the_page_has_a_row_for_each_command(program):
    rows = dict(re.findall(r"^\| `(\w+)` \| (.*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE))
    told = subprocess.run([program, "help"], check=True, capture_output=True, text=True).stdout
    assert sorted(rows) == sorted(re.findall(r"^  ([a-z]+) {3,}", told, re.MULTILINE))
    tests = "".join(file.read_text(encoding="utf-8") for file in pathlib.Path(__file__).parent.glob("test_*.py"))
    for function in re.findall(r"`jp\.([\w.]+)`", " ".join(rows.values())):
        thing = jp
        for part in function.split("."):
            thing = getattr(thing, part)
        assert callable(thing) and f"jp.{function}" in tests, function
