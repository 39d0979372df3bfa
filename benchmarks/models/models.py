"""Robots as MJCF of `export --to mjcf`, driven in MuJoCo against `simulate`; drafts of `init --from` against MuJoCo's compiler."""

import argparse
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build/release/bin/joulepath"
sys.path.insert(0, str(ROOT / "benchmarks/peers"))
from mujoco_peer import PERIOD_S, SETTLE_S, drawn_W, execute, wheels_alone  # noqa: E402

ROBOTS = ["nomad_super_scout", "kobuki", "husky_a200", "amr_150kg", "tug_600kg"]
RESERVE = 1.3  # of the time of least energy: a wheel controller keeps voltage for its corrections
WAY = "x_m,y_m,corner_radius_m\n0,0,\n4,0,1\n4,4,0\n7,4,\n"  # straight, an arc, a turn in place


def joulepath(*arguments):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def sides(value):
    return [value["left"], value["right"]] if isinstance(value, dict) else [value, value]


def flat(file):
    """A robot file as benchmarks/peers/mujoco_peer.py takes it."""
    robot = yaml.safe_load(file.read_text())
    return {**robot["geometry"], **robot["inertia"], "motor": {k: sides(v) for k, v in robot["motor"].items()}, "power": robot.get("power", {})}


def driven(name, folder):
    """Motion energies of one plan: of `simulate` and of the exported model in MuJoCo, whose wheels follow the plan's speeds."""
    file = ROOT / f"scenarios/robots/{name}.yaml"
    way, plan, run, model = folder / "way.csv", folder / name, folder / f"{name}_run", folder / f"{name}.xml"
    way.write_text(WAY)
    joulepath("plan", way, "--robot", file, "--out", plan, "--quiet")
    longer_s = RESERVE * json.loads((plan / "plan.json").read_text())["duration_s"]
    joulepath("plan", way, "--robot", file, "--time", longer_s, "--out", plan, "--quiet", "--force")
    simulated = json.loads(joulepath("simulate", plan, "--robot", file, "--ideal-sensors", "--out", run, "--json"))
    simulated_J = simulated["runs"][0]["executed"]["motion_energy_J"]
    joulepath("export", file, "--to", "mjcf", "--out", model, "--quiet")
    rows = list(csv.DictReader((plan / "trajectory.csv").open()))
    column = lambda key: np.array([float(row[key]) for row in rows])
    robot, times = flat(file), column("time_s")
    r, l = robot["wheel_radius_m"], robot["half_track_m"]
    at = np.arange(math.ceil((times[-1] + SETTLE_S) / PERIOD_S)) * PERIOD_S + PERIOD_S
    left, right = (np.interp(at, times, column(f"wheel_speed_{side}_rad_s"), right=0) for side in ("left", "right"))
    speeds = np.stack([r * (left + right) / 2, r * (right - left) / (2 * l)], 1)
    most_V = min(robot["motor"].get("max_voltage_V", [math.inf]))
    watts, _ = execute(robot, 0.0, most_V, (0, 0, 0), len(at), wheels_alone(None, speeds), text=model.read_text())
    power = robot["power"]
    drawn = drawn_W(watts, power.get("regeneration_efficiency", 0.0), power.get("sharing", "wheel"))
    return simulated_J, float(drawn.sum() * PERIOD_S)


def compiled(file, wheels):
    """Chassis mass, yaw inertia and wheel values by MuJoCo's own compiler, with parallel axes by numpy."""
    import mujoco

    text = None
    if file.suffix == ".urdf":  # without the files of its meshes
        text = re.sub(r"<mesh\b[^>]*?/>|<mesh\b[^>]*?>.*?</mesh>", '<sphere radius="0.001"/>', file.read_text(), flags=re.S)
        text = re.sub(r"(<robot[^>]*>)", r'\1<mujoco><compiler fusestatic="false" discardvisual="true" inertiafromgeom="false" boundmass="1e-9" boundinertia="1e-12"/></mujoco>', text, count=1)
    model = mujoco.MjModel.from_xml_string(text) if text else mujoco.MjModel.from_xml_path(str(file))
    data = mujoco.MjData(model)
    data.qpos[:] = model.qpos0
    for i in range(model.njnt):  # all hinges and slides at zero, as in a robot file's draft
        if model.jnt_type[i] in (mujoco.mjtJoint.mjJNT_HINGE, mujoco.mjtJoint.mjJNT_SLIDE):
            data.qpos[model.jnt_qposadr[i]] = 0
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    joints = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in wheels]
    bodies = [model.jnt_bodyid[j] for j in joints]
    rest = [b for b in range(1, model.nbody) if b not in bodies and model.body_mass[b] > 0]
    mass, places = model.body_mass[rest], data.xipos[rest]
    center = (mass[:, None] * places).sum(0) / mass.sum()
    yaw = 0.0
    for b, m, place in zip(rest, mass, places):
        turn = data.ximat[b].reshape(3, 3)
        yaw += (turn @ np.diag(model.body_inertia[b]) @ turn.T)[2, 2] + m * ((place - center)[:2] ** 2).sum()
    axles = data.xanchor[joints]
    return {"chassis_mass_kg": mass.sum(), "chassis_yaw_inertia_kg_m2": yaw, "half_track_m": np.linalg.norm(axles[0] - axles[1]) / 2,
            "wheel_mass_kg": model.body_mass[bodies].mean()}


def drafted(file, wheels, folder):
    joulepath("init", folder / "draft", "--from", file, "--wheels", ",".join(wheels), "--force", "--quiet")
    robot = yaml.safe_load((folder / "draft/robot.yaml").read_text())
    return {**robot.get("geometry", {}), **robot.get("inertia", {})}


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--note", default="")
    options.add_argument("models", nargs="*")
    options = options.parse_args()
    lines = ["# Models of simulators", "", options.note, "", "## Driven", "",
             "One plan (4 m, an arc of 1 m, 3 m, a turn in place, 3 m) in 1.3 times the time of least energy. Its wheel speeds are",
             "followed in MuJoCo by the model of `export --to mjcf`, and by `simulate`: energy of the motors without standby.", "",
             "| robot | `simulate`, J | MuJoCo, J | difference |", "|---|---:|---:|---:|"]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name in ROBOTS:
            simulated_J, mujoco_J = driven(name, folder)
            lines.append(f"| {name} | {simulated_J:.4g} | {mujoco_J:.4g} | {100 * (mujoco_J / simulated_J - 1):+.2f} % |")
        if options.models:
            lines += ["", "## Read", "", "Values of `init --from` over those of MuJoCo's compiler.", "",
                      "| model | chassis mass | yaw inertia | half track | wheel mass |", "|---|---:|---:|---:|---:|"]
        for item in options.models:
            name, _, wheels = item.partition("@")
            ours, theirs = drafted(pathlib.Path(name), wheels.split(","), folder), compiled(pathlib.Path(name), wheels.split(","))
            cells = [f"{ours[k] / theirs[k]:.4f}" if k in ours else "not stated" for k in ("chassis_mass_kg", "chassis_yaw_inertia_kg_m2", "half_track_m", "wheel_mass_kg")]
            lines.append(f"| {pathlib.Path(name).name} | " + " | ".join(cells) + " |")
    text = "\n".join(lines) + "\n"
    (ROOT / "benchmarks/results/models.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
