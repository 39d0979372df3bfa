"""The package in one piece of code, run as it is written."""
import subprocess

import numpy as np
import pytest

import joulepath as jp

TOUR = """\
import joulepath as jp
robot = jp.Robot.load("robot.yaml"); geared = robot.replace(motor={"gear_ratio": 32})   # frozen value, every key of the schema
p = jp.profile(robot, xy, payload_kg=5, time_s=None)        # xy: (N, 2) waypoints or jp.Path; releases the GIL
p.t, p.s, p.v, p.a, p.power_W                               # numpy views without copies
p.energy_J, p.interval_95_J, p.lower_bound_J; p.at(t); p.to_frame(); p.plot()
plan = jp.plan("mission.yaml")                              # or a dict; plan.legs, plan.save(dir), _repr_html_ is the report
e = jp.energy(robot, t, v, w, payload_kg=0)                 # joules by cause of ANY motion
log = jp.simulate(plan, robot, effects={"rolling_resistance": {"coefficient": 0.01}}, seed=3)
d = jp.diagnose(robot, [frame_1, frame_2, "run.mcap"])      # d.verdict, d.causes, d.where, d.robot (corrected)
jp.map(jp.profile, jobs, threads=2)                         # order kept, failures are values
"""
MISSION = """\
schema: joulepath/mission/1
robot: robot.yaml
legs:
  - {path: {bezier_m: [[[0, 0], [2.7, 0], [2.7, 0], [2.7, 2.7]]]}, payload_kg: 5}
"""


def test_the_tour_runs_as_it_is_written(robot, program, tmp_path, monkeypatch):
    pytest.importorskip("pandas")
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    robot.save("robot.yaml")
    (tmp_path / "mission.yaml").write_text(MISSION)
    xy = [[0, 0], [2, 0], [4, 1], [6, 1]]
    drives = [jp.simulate(jp.profile(robot, xy, time_s=time_s), effects={"rolling_resistance": {"coefficient": 0.02}}, seed=k)
              for k, time_s in enumerate((10.0, 12.0, 15.0))]
    drives[2].save("run.csv")
    subprocess.run([program, "export", "run.csv", "--robot", "robot.yaml", "--to", "bag", "--out", "run.mcap", "-q"], check=True)
    t = np.linspace(0, 5, 200)
    names = {"xy": xy, "t": t, "v": 0.4 * np.sin(np.pi * t / 5) ** 2, "w": 0 * t, "frame_1": drives[0].to_frame(), "frame_2": drives[1].to_frame(),
             "jobs": [{"robot": robot, "xy": xy, "solver": "fast"}, {"robot": robot, "xy": [[0, 0]]}, {"robot": robot, "xy": xy, "payload_kg": 5.0, "solver": "fast"}]}
    exec(TOUR, names)
    assert names["geared"].motor.gear_ratio == 32 != names["robot"].motor.gear_ratio and names["robot"] == robot
    p = names["p"]
    assert len({len(column) for column in (p.t, p.s, p.v, p.a, p.power_W)}) == 1 and np.shares_memory(p.v, p.trajectory["linear_speed_m_s"])
    assert p.lower_bound_J <= p.energy_J <= p.interval_95_J[1] and len(p.to_frame()) == len(p.t)
    plan = names["plan"]
    assert len(plan.legs) == 1 and "<iframe" in plan._repr_html_() and (plan.save("out") / "plan.json").exists()
    e, log, d = names["e"], names["log"], names["d"]
    assert e.total_J == pytest.approx(sum(e.causes_J.values()), rel=1e-9) and log.energy_J > plan.energy_J
    assert list(d.json.validation.runs) == ["logs[0]", "logs[1]", "run.mcap"]
    assert d.verdict in ("explained", "partly_explained", "ambiguous", "too_little_data"), d
    first, failed, loaded = jp.map(jp.profile, names["jobs"], threads=2)
    assert first.energy_J < loaded.energy_J and isinstance(failed, jp.ConfigError)
