"""The package and the program give the same bytes for the same input."""
import json
import subprocess

import joulepath as jp

WAYPOINTS = "x_m,y_m\n0,0\n2,0\n4,1\n6,1\n"


def run(program, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def test_plan_of_a_mission(program, scenarios, tmp_path):
    mission = scenarios / "missions" / "depot_round.yaml"
    run(program, "plan", mission, "--solver", "fast", "--out", tmp_path / "program")
    jp.plan(mission, solver="fast").save(tmp_path / "package")
    for name in ("plan.json", "trajectory.csv", "profile.csv", "report.html"):
        assert (tmp_path / "program" / name).read_bytes() == (tmp_path / "package" / name).read_bytes(), name


def test_plan_of_a_path_and_profile(program, scenarios, robot, tmp_path):
    (tmp_path / "path.csv").write_text(WAYPOINTS)
    file = scenarios / "robots" / "nomad_super_scout.yaml"
    run(program, "plan", tmp_path / "path.csv", "--robot", file, "--payload", 5, "--time", 30, "--out", tmp_path / "cli")
    planned = jp.plan(tmp_path / "path.csv", robot=robot, payload_kg=5, time_s=30)
    planned.save(tmp_path / "package")
    for name in ("plan.json", "trajectory.csv", "profile.csv", "report.html"):
        assert (tmp_path / "cli" / name).read_bytes() == (tmp_path / "package" / name).read_bytes(), name
    alone = jp.profile(robot, [[0, 0], [2, 0], [4, 1], [6, 1]], payload_kg=5, time_s=30)
    assert alone.energy_J == planned.energy_J
    assert alone.trajectory.text() == planned.trajectory.text()


def test_plan_of_a_dict(scenarios, monkeypatch):
    monkeypatch.chdir(scenarios / "missions")
    mission = {"robot": "../robots/nomad_super_scout.yaml", "start": {"x_m": 0, "y_m": 0, "heading_rad": 0},
               "legs": [{"motion": {"profile": "trapezoid", "distance_m": 2, "speed_m_s": 0.4, "acceleration_m_s2": 0.3}}]}
    from_file = jp.plan(mission)
    robot = jp.Robot.load("../robots/nomad_super_scout.yaml")
    assert jp.plan({**mission, "robot": robot}).json.energy_J == from_file.json.energy_J
    assert jp.plan(mission, robot=robot).json == from_file.json


def test_simulation_and_diagnosis(program, scenarios, robot, tmp_path):
    file = scenarios / "robots" / "nomad_super_scout.yaml"
    plans = []
    for k, end_m in enumerate((3, 4, 5, 6)):
        (tmp_path / f"path_{k}.csv").write_text(f"x_m,y_m\n0,0\n2,0\n{end_m},1\n")
        plans.append(jp.plan(tmp_path / f"path_{k}.csv", robot=robot))
        plans[-1].save(tmp_path / f"plan_{k}")
    run(program, "simulate", *(tmp_path / f"plan_{k}" for k in range(4)), "--robot", file, "--effect",
        "rolling_resistance:coefficient=0.02", "--seed", 3, "--out", tmp_path / "logs")
    simulated = json.loads((tmp_path / "logs" / "simulation.json").read_text())["runs"]
    logs = []
    hour_s = 0.0
    for plan, from_cli in zip(plans, simulated):
        logs.append(jp.simulate(plan, robot, effects={"rolling_resistance": {"coefficient": 0.02}}, seed=from_cli["seed"],
                                time_of_day_s=hour_s))
        hour_s += logs[-1].duration_s
    for k, log in enumerate(logs):
        assert log.text() == (tmp_path / "logs" / f"run_0{k + 1}.csv").read_text()

    run(program, "diagnose", tmp_path / "logs" / "dataset.yaml", "--out", tmp_path / "cli")
    from_file = jp.diagnose(None, tmp_path / "logs" / "dataset.yaml")
    from_file.save(tmp_path / "package")
    assert sorted(p.name for p in (tmp_path / "cli").iterdir()) == sorted(p.name for p in (tmp_path / "package").iterdir())
    for made in (tmp_path / "cli").iterdir():
        if made.name != "dataset_corrected.yaml":
            assert made.read_bytes() == (tmp_path / "package" / made.name).read_bytes(), made.name

    runs = jp.Robot.load(tmp_path / "logs" / "robot.yaml")
    starts_s = [0.0]
    for log in logs:
        starts_s.append(starts_s[-1] + log.duration_s)
    as_frames = jp.diagnose(runs, [jp.Run(log.to_frame(), start_time_s=float(f"{start_s:.12g}"), name=f"run_0{k + 1}.csv")
                                   for k, (log, start_s) in enumerate(zip(logs, starts_s))])
    assert as_frames.json == from_file.json
    assert as_frames.robot == from_file.robot
